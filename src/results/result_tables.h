#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/break_records.h"
#include "record/record_fields.h"
#include "results/element_table.h"
#include "results/hdf5_file.h"
#include "results/row_table.h"
#include "results/run_data.h"

/// The tables of a result file: one struct per group, written row by row and read back whole. In each, `time` is
/// written last, so that every row it holds is complete; see docs/result-file.md.
namespace keyblock::results {

inline constexpr const char* result_format = "keyblock result";
inline constexpr int result_format_version = 2;

void write_model(hid_t file, const record::ModelRecord& model);
record::ModelRecord read_model(hid_t file);

/// Gives every dataset of a new file its attributes: what it is, its unit, the names of its columns and of its values where these are numbers
/// that stand for words; and its dimensions, by which netCDF knows them.
void describe_datasets(hid_t file, const record::ModelRecord& model);
/// The names of columns and values, by dataset: {"frames/status": {"values": […]}}.
nlohmann::ordered_json dataset_names(const record::ModelRecord& model);

class FrameTable {
 public:
  FrameTable(hid_t file, const record::ModelRecord& model);
  void append(const record::Frame& frame);
  void flush();
  static std::vector<record::Frame> read(hid_t file, const record::ModelRecord& model);

 private:
  std::size_t vertices_, blocks_;
  ElementTable elements_;
  hdf5::Handle group_;
  hdf5::Column<float> displacement_, stress_, velocity_;
  hdf5::Column<std::uint8_t> status_;
  hdf5::Column<std::int16_t> order_;
  hdf5::Column<std::int32_t> stage_;
  hdf5::Column<std::int64_t> step_;
  hdf5::Column<double> time_;
};

class ContactTable {
 public:
  explicit ContactTable(hid_t file);
  void append(const record::ContactFrame& frame);
  void flush();
  static std::vector<record::ContactFrame> read(hid_t file);

 private:
  hdf5::Handle group_;
  hdf5::Column<std::int32_t> block_a_, block_b_;
  hdf5::Column<std::uint8_t> state_, edge_kind_;
  hdf5::Column<std::int16_t> edge_index_;
  hdf5::Column<double> position_, normal_;
  std::vector<hdf5::Column<double>> numbers_;  ///< as in record::contact_fields
  hdf5::Column<std::int32_t> stage_;
  hdf5::Column<std::int64_t> step_, end_, contact_;
  hdf5::Column<double> time_;
};

class HistoryTable {
 public:
  HistoryTable(hid_t file, const record::ModelRecord& model);
  void append(const record::HistoryRow& row);
  void flush();
  static std::vector<record::HistoryRow> read(hid_t file);

 private:
  std::size_t points_, elements_;
  hdf5::Handle group_;
  hdf5::Column<double> values_, element_values_;
  hdf5::Column<std::int64_t> step_;
  hdf5::Column<double> time_;
};

class StepTable {
 public:
  explicit StepTable(hid_t file);
  void append(const record::StepRow& row);
  void flush();
  static std::vector<record::StepRow> read(hid_t file);

 private:
  TableOf<decltype(record::step_fields)> rows_;
  hdf5::Column<double> energy_;
};

/// Of runs in which something may break.
class BreakTable {
 public:
  BreakTable(hid_t file, const record::ModelRecord& model);
  void append(const record::BreakRecord& row);
  void flush();
  /// None where the file has no such table.
  static std::vector<record::BreakRecord> read(hid_t file);

 private:
  std::optional<TableOf<decltype(record::break_fields)>> rows_;
};

/// Text that grows by lines.
class TextColumn {
 public:
  TextColumn() = default;
  TextColumn(hid_t file, const std::string& name) : bytes_(file, name, {}) {}
  void append(std::string_view text);
  void append_line(const std::string& line);
  void flush() { bytes_.flush(); }
  static std::string read(hid_t file, const std::string& name);
  /// Complete lines only.
  static std::vector<std::string> read_lines(hid_t file, const std::string& name);

 private:
  hdf5::Column<std::uint8_t> bytes_;
};

}  // namespace keyblock::results
