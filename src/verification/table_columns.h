#pragma once
#include <array>

#include "verification/report.h"

namespace keyblock::verification {

/// A column of the table: its heading and where its cells are in RowText.
struct Column {
  const char* heading;
  std::string RowText::*cell;
  bool left;  ///< words, not numbers
};

inline constexpr std::array<Column, 9> table_columns{{{"run", &RowText::run, true},
                                                      {"quantity", &RowText::quantity, true},
                                                      {"order", &RowText::order, false},
                                                      {"parameters", &RowText::parameters, true},
                                                      {"computed", &RowText::computed, false},
                                                      {"expected", &RowText::expected, false},
                                                      {"error", &RowText::error, false},
                                                      {"published DDA", &RowText::published, false},
                                                      {"tolerance", &RowText::tolerance, false}}};

/// Those in which a case has anything, as that of published figures often has not. The run is named only where there are
/// several.
std::array<bool, table_columns.size()> used_columns(const CaseResult& result);

}  // namespace keyblock::verification
