#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/folder.h"
#include "record/damage_fields.h"
#include "record/record_fields.h"
#include "record/stage_checks.h"
#include "results/record_json.h"
#include "results/result_tables.h"
#include "results/run_data.h"

namespace keyblock::results {
namespace {

constexpr unsigned read_attempts = 24;  // some 20 ms in all

[[noreturn]] void fail(const std::filesystem::path& path, std::string found, std::string expected,
                       std::string hint = {}) {
  Diagnostic diagnostic;
  diagnostic.where.file = path.string();
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  diagnostic.hint = std::move(hint);
  throw InputError(std::move(diagnostic));
}

// A file whose writer was killed, or still runs, opens in the mode for concurrent readers alone.
hdf5::Handle open_file(const std::filesystem::path& path) {
  if (!file_exists(path)) fail(path, "no such file", "the results of a run");
  for (const unsigned mode : {H5F_ACC_RDONLY, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ}) {
    try {
      return hdf5::open_with_or_without_locks([&](hid_t access) {
        // Each attempt at a page that is being written waits twice as long as the last, from 1 ns.
        hdf5::check(H5Pset_metadata_read_attempts(access, read_attempts), "file access");
        return H5Fopen(path.c_str(), mode, access);
      });
    } catch (const RunError&) {  // the next mode may do, or the last words are below
    }
  }
  fail(path, H5Fis_hdf5(path.c_str()) > 0 ? "an HDF5 file that cannot be opened" : "no HDF5 file",
       "the results of a run", "it may have been cut short");
}

void check_format(const std::filesystem::path& path, hid_t file) {
  const auto of_another_kind = [&] {
    fail(path, "an HDF5 file of another kind", fmt::format("the attribute format = \"{}\"", result_format));
  };
  if (H5Aexists(file, "format") <= 0 || H5Aexists(file, "format_version") <= 0) of_another_kind();
  const auto version = hdf5::read_attribute<std::int32_t>(file, "format_version");
  if (version != result_format_version) {
    fail(path, fmt::format("format version {}", version),
         fmt::format("format version {}", result_format_version),
         "read it with the version of keyblock that wrote it");
  }
  if (hdf5::read_text_attribute(file, "format") != result_format) of_another_kind();
}

// Calls read(file) and turns whatever HDF5 finds wrong into an error of the input.
template <class Read>
auto with_file(const std::filesystem::path& directory, const Read& read) {
  const hdf5::QuietErrors quiet;
  const std::filesystem::path path = directory / "result.h5";
  try {
    const hdf5::Handle file = open_file(path);
    check_format(path, file);
    return read(file);
  } catch (const RunError& error) {
    fail(path, error.what(), "a complete result file", "it may have been cut short");
  } catch (const InputError& error) {
    Diagnostic diagnostic = error.diagnostics().front();
    if (diagnostic.where.file.empty()) diagnostic.where.file = path.string();
    throw InputError(std::move(diagnostic));
  }
}

record::Damage unknown_damage() {
  record::Damage damage;
  for (const auto& field : record::damage_fields) damage.*field.number = std::nan("");
  return damage;
}

// What of the measures the statuses of blocks tell.
record::Damage damage_of(const record::ModelRecord& model, const record::Frame& frame) {
  record::Damage damage = unknown_damage();
  damage.fallen_area = damage.loosened_area = 0.0;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (model.blocks[b].fixed) continue;
    if (frame.status[b] == record::BlockStatus::fallen) {
      ++damage.fallen_blocks;
      damage.fallen_area += model.blocks[b].area;
    }
    if (frame.status[b] == record::BlockStatus::loosened) damage.loosened_area += model.blocks[b].area;
  }
  return damage;
}

// The stage a run was killed in, as far as its rows tell.
void complete_killed_stage(const RunData& data, int index, record::StageRecord& stage) {
  double time = stage.start_time;
  long first = 0, last = 0;
  const auto see = [&](const auto& rows) {
    for (const auto& row : rows) {
      if (row.stage < index) first = std::max(first, row.step);
      if (row.stage != index) continue;
      time = std::max(time, row.time);
      last = std::max(last, row.step);
    }
  };
  see(data.frames);
  see(data.steps);
  stage.interrupted = true;
  stage.duration = time - stage.start_time;
  stage.steps = std::max(stage.steps, last - first);
  stage.wall_time = stage.worst_residual_ratio = stage.largest_speed = std::nan("");
  // Files of version 0.1 tell of the motion at the end alone.
  if (stage.motion_time.empty() && stage.stage.kind == record::StageKind::shake)
    stage.pga = stage.pgv = stage.arias = std::nan("");
  stage.damage = unknown_damage();
  for (const record::Frame& frame : data.frames)
    if (frame.stage == index) stage.damage = damage_of(data.model, frame);
}

// Degrees of freedom: two for each term of the polynomials.
int unknowns(const RunData& data) {
  const std::vector<int> orders = last_orders(data);
  int sum = 0;
  for (std::size_t b = 0; b < orders.size(); ++b)
    if (!data.model.blocks[b].fixed) sum += (orders[b] + 1) * (orders[b] + 2);
  return sum;
}

constexpr long most_steps = 1'000'000'000'000'000;

void check_steps(long steps, const char* what) {
  if (steps < 0 || steps > most_steps)
    throw RunError(fmt::format("{} has a number of steps that cannot be", what));
}

template <class Row>
void check_places(const std::vector<Row>& rows, const char* what) {
  for (const Row& row : rows) {
    check_steps(row.step, what);
    if (row.stage < 0) throw RunError(fmt::format("{} has a stage that cannot be", what));
  }
}

// Whether the stages and the end of a run are those of the model.
void check_record(const RunData& data) {
  const auto is_block = [&](int b) {
    return b >= 0 && static_cast<std::size_t>(b) < data.model.blocks.size();
  };
  const record::OverlapRecord& overlap = data.run.max_overlap;
  bool fits = (overlap.block_a < 0 && overlap.block_b < 0) ||
              (is_block(overlap.block_a) && is_block(overlap.block_b));
  check_steps(data.run.steps, "run");
  for (const record::StageRecord& stage : data.run.stages) {
    check_steps(stage.steps, "stages");
    fits = fits && stage.motion_time.size() == stage.motion.size() &&
           has_known_blocks(stage, data.model.blocks.size());
  }
  if (!fits) throw RunError("stages or run name blocks that the model does not have");
}

void read_run_record(hid_t file, RunData& data) {
  std::map<int, StageLine> stages;
  for (const std::string& text : TextColumn::read_lines(file, "stages")) {
    StageLine line = read_stage_json(text);
    check_steps(line.stage.steps, "stages");
    stages[line.index] = std::move(line);
  }
  const auto run = TextColumn::read_lines(file, "run");
  if (!run.empty()) {
    data.run = read_run_json(run.back());
  } else {
    data.cut_off = data.run.interrupted = true;
    data.run.dof = unknowns(data);
    data.run.energy.residual_ratio = std::nan("");
    if (!data.steps.empty()) data.run.energy = data.steps.back().energy;
    for (const record::BreakRecord& row : data.breaks) record::count_break(row, data.run.breaks);
    data.run.wall_time = data.run.max_overlap.depth = data.run.max_area_change = std::nan("");
    data.run.open_close.mean_iterations = std::nan("");
  }
  for (auto& [index, line] : stages) {
    if (!line.ended) complete_killed_stage(data, index, line.stage);
    data.run.stages.push_back(std::move(line.stage));
    if (data.cut_off) data.run.steps += data.run.stages.back().steps;
  }
}

void check_breaks(const RunData& data) {
  const auto is_one_of = [](int number, std::size_t count) {
    return number >= -1 && number < static_cast<int>(count);
  };
  for (const record::BreakRecord& row : data.breaks) {
    if (!is_one_of(row.block_a, data.model.blocks.size()) ||
        !is_one_of(row.block_b, data.model.blocks.size()) ||
        !is_one_of(row.element, data.model.elements.size()))
      throw RunError("breaks name blocks or elements that the model does not have");
  }
}

// Whether the rows are those of the model.
void check_rows(const RunData& data) {
  const std::size_t blocks = data.model.blocks.size();
  check_places(data.frames, "frames");
  check_places(data.contacts, "contacts");
  check_places(data.breaks, "breaks");
  check_places(data.steps, "steps");
  for (const record::HistoryRow& row : data.histories) check_steps(row.step, "histories");
  for (const record::Frame& frame : data.frames) {
    if (frame.displacement.size() != data.model.vertices.size() || frame.status.size() != blocks)
      throw RunError("frames and model differ in size");
  }
  const auto known = [&](int block) { return block >= 0 && static_cast<std::size_t>(block) < blocks; };
  for (const record::ContactFrame& frame : data.contacts) {
    for (const record::ContactRecord& contact : frame.contacts) {
      if (!known(contact.block_a) || !known(contact.block_b))
        throw RunError("contacts/block_a or block_b is out of range");
    }
  }
  check_breaks(data);
  for (const record::HistoryRow& row : data.histories) {
    if (row.points.size() != data.model.history_names.size())
      throw RunError("histories/values does not fit histories/names");
    if (row.elements.size() != data.model.element_histories.size())
      throw RunError("histories/element_values does not fit the names of these histories");
  }
}

}  // namespace

std::vector<int> last_orders(const RunData& run) {
  if (!run.frames.empty()) return {run.frames.back().order.begin(), run.frames.back().order.end()};
  std::vector<int> orders;
  for (const auto& block : run.model.blocks) orders.push_back(block.order);
  return orders;
}

std::size_t frame_of(const record::ContactFrame& snapshot, const std::vector<record::Frame>& frames) {
  const auto later = std::upper_bound(frames.begin(), frames.end(), snapshot,
                                      [](const record::ContactFrame& c, const record::Frame& f) {
                                        return std::pair(c.stage, c.step) < std::pair(f.stage, f.step);
                                      });
  return later == frames.begin() ? 0 : static_cast<std::size_t>(later - frames.begin()) - 1;
}

RunData read_run(const std::filesystem::path& directory) {
  return with_file(directory, [](hid_t file) {
    RunData data;
    data.model = read_model(file);
    data.frames = FrameTable::read(file, data.model);
    data.contacts = ContactTable::read(file);
    data.histories = HistoryTable::read(file);
    data.breaks = BreakTable::read(file);
    data.steps = StepTable::read(file);
    check_rows(data);
    read_run_record(file, data);
    check_record(data);
    return data;
  });
}

// summary.json is the last that a run writes, after the same text in result.h5.
std::optional<record::RunRecord> ended_run(const std::filesystem::path& directory) {
  return with_file(directory, [&](hid_t file) -> std::optional<record::RunRecord> {
    const auto lines = TextColumn::read_lines(file, "run");
    const std::filesystem::path summary = directory / "summary.json";
    if (lines.empty()) return std::nullopt;
    record::RunRecord run = read_run_json(lines.back());
    const bool has_ended =
        !run.interrupted && file_exists(summary) && read_file(summary) == TextColumn::read(file, "summary");
    return has_ended ? std::optional(std::move(run)) : std::nullopt;
  });
}

std::vector<record::HistoryRow> read_histories(const std::filesystem::path& directory) {
  return with_file(directory, [](hid_t file) { return HistoryTable::read(file); });
}

}  // namespace keyblock::results
