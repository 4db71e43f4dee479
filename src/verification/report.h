#pragma once
#include <string>
#include <vector>

#include "verification/verify.h"

/// The table that verify() computed, for people and programs. Cases without rows are left out.
namespace keyblock::verification {

/// How the terminal is written to.
struct TextStyle {
  bool color = false;
  bool unicode = true;
};

std::string table_text(const std::vector<CaseResult>& results, const TextStyle& style);
/// {"version", "passed", "failed", "wall_time_s", "cases": […], "rows": […]}, see docs/verification.md. Every number can be
/// read back to its last bit; what is not a number is null.
std::string table_json(const std::vector<CaseResult>& results, const std::string& version);
/// A page of its own that needs nothing else.
std::string table_html(const std::vector<CaseResult>& results, const std::string& version);
/// A page of the documentation. It has no times of computing, which would differ from run to run.
std::string table_markdown(const std::vector<CaseResult>& results, const std::string& version);

/// The cells of one row as text, shared by all but JSON.
struct RowText {
  std::string run, quantity, order, parameters, computed, expected, error, published, tolerance, note;
};
RowText row_text(const Row& row);
/// "187 of 190 rows hold; 3 do not".
std::string verdict_text(const std::vector<CaseResult>& results);

}  // namespace keyblock::verification
