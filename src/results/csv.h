#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "record/record.h"

namespace keyblock::results {

/// A field of every CSV file: as RFC 4180 has it, in quotes where it holds a comma, a semicolon, a tab, a quote or a line break. Text that a
/// spreadsheet would run as a formula (from =, +, -, @, a tab or a carriage return on) gets an apostrophe before it; numbers do not.
std::string csv_field(std::string_view text);

/// Whether there are histories: of points or of elements.
bool has_histories(const record::ModelRecord& model);
/// Names of the columns: `time`, then those of history_fields per point, then those of element_history_fields per element, as below.
std::vector<std::string> history_columns(const record::ModelRecord& model);
/// A row, in the order of these columns.
std::vector<double> history_numbers(const record::HistoryRow& row);

/// One row per recorded step: `time`, then per history `NAME.ux, NAME.uy, NAME.vx, NAME.vy, NAME.sxx, NAME.syy,
/// NAME.sxy, NAME.ax, NAME.ay` (displacement since the start, m; velocity, m/s; Cauchy stress, Pa; acceleration, m/s²); of an element
/// `NAME.force, NAME.elongation` (N/m, m). Every number can be read back to its last bit.
std::string histories_csv(const record::ModelRecord& model, const std::vector<record::HistoryRow>& rows);

/// Writes DIR/histories.csv at once. Throws RunError.
void write_histories_csv(const std::filesystem::path& directory, const record::ModelRecord& model,
                         const std::vector<record::HistoryRow>& rows);

}  // namespace keyblock::results
