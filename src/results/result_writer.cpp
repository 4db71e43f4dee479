#include "results/result_writer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/own_file.h"
#include "results/csv.h"
#include "results/record_json.h"
#include "results/result_tables.h"
#include "results/run_data.h"
#include "results/summary.h"

namespace keyblock::results {
namespace {

using Clock = std::chrono::steady_clock;

// Every flush leaves behind the room of the chunks it began to fill, which are compressed anew. So in long runs the interval
// grows with the time that has passed, in s: with one of 2 s, no more than a hundredth of a run is ever lost.
constexpr double time_to_first_stretch = 200.0;

// Metadata lie in pages as large as those of the operating system and do not straddle them. A process that is killed while
// it writes stops between pages, so that no piece of metadata is left half written.
constexpr hsize_t file_page = 4096;

hdf5::Handle create_file(const std::filesystem::path& path, const record::ModelRecord& model) {
  const char* const what = "file";
  const hdf5::Handle creation(hdf5::check_id(H5Pcreate(H5P_FILE_CREATE), what), H5Pclose);
  hdf5::check(H5Pset_file_space_strategy(creation, H5F_FSPACE_STRATEGY_PAGE, false, 1), what);
  hdf5::check(H5Pset_file_space_page_size(creation, file_page), what);
  hdf5::Handle file = hdf5::open_with_or_without_locks([&](hid_t access) {
    hdf5::check(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), what);
    return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access);
  });
  write_model(file, model);
  return file;
}

}  // namespace

struct ResultWriter::State {
  // The tables of one file. Members close in reverse order, the file last.
  struct OpenFile {
    OpenFile(const std::filesystem::path& path, const record::ModelRecord& model)
        : file(create_file(path, model)),
          frames(file, model),
          contacts(file),
          histories(file, model),
          breaks(file, model),
          steps(file),
          stages(file, "stages"),
          run(file, "run"),
          summary(file, "summary") {}
    void flush() {
      stages.flush();
      contacts.flush();
      histories.flush();
      breaks.flush();
      steps.flush();
      frames.flush();
      run.flush();
      summary.flush();
    }
    void flush_whole() {
      flush();
      hdf5::check(H5Fflush(file, H5F_SCOPE_GLOBAL), "file");
    }
    hdf5::Handle file;
    FrameTable frames;
    ContactTable contacts;
    HistoryTable histories;
    BreakTable breaks;
    StepTable steps;
    TextColumn stages, run, summary;
  };

  hdf5::QuietErrors quiet;
  std::filesystem::path directory, temporary;
  std::chrono::duration<double> flush_interval{};
  record::ModelRecord model;
  std::optional<OpenFile> file;
  Clock::time_point start, last_flush;
  std::function<void()> before_publishing;
  bool published = false;
  std::optional<record::Reported> earlier;  // by the run that is resumed
  std::vector<std::string> waiting_stages;  // lines from before the first row

  [[nodiscard]] std::filesystem::path path() const { return directory / "result.h5"; }
  [[nodiscard]] bool flush_is_due() const;
  void copy_earlier();
  void publish();
  void abandon();
  // Calls write(), and gives the file up when that fails: what closing it would still write would make it unreadable where there is
  // no room for all.
  template <class Write>
  void change_file(const Write& write) {
    try {
      write();
    } catch (const RunError& error) {
      if (file) hdf5::detach(file->file);
      abandon();
      throw RunError(fmt::format("{}: cannot write: {}", path().string(), error.what()));
    }
  }
};

void ResultWriter::State::abandon() {
  file.reset();
  std::error_code ignored;
  if (!published) std::filesystem::remove(temporary, ignored);
}

bool ResultWriter::State::flush_is_due() const {
  const Clock::time_point now = Clock::now();
  const double stretch =
      std::max(1.0, std::chrono::duration<double>(now - start).count() / time_to_first_stretch);
  return now - last_flush >= stretch * flush_interval;
}

// What the earlier run had reported by its checkpoint.
void ResultWriter::State::copy_earlier() {
  const auto refuse = [&](std::string found, std::string expected) {
    Diagnostic diagnostic;
    diagnostic.where.file = path().string();
    diagnostic.found = std::move(found);
    diagnostic.expected = std::move(expected);
    diagnostic.hint = "to begin anew, run into another folder";
    throw InputError(std::move(diagnostic));
  };
  const RunData data = read_run(directory);
  if (data.model.vertices != model.vertices || data.model.blocks.size() != model.blocks.size() ||
      data.model.history_names != model.history_names || data.model.elements != model.elements ||
      data.model.element_histories != model.element_histories) {
    refuse(fmt::format("results of another model ({} blocks)", data.model.blocks.size()),
           fmt::format("results of the run to be resumed ({} blocks)", model.blocks.size()));
  }
  const auto copy = [&](const char* what, const auto& rows, long count, const auto& append) {
    if (static_cast<long>(rows.size()) < count) {
      refuse(fmt::format("{} {}", rows.size(), what),
             fmt::format("the {} that the run to be resumed had written by its last checkpoint", count));
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) append(k, rows[k]);
  };
  const auto to = [](auto& table) { return [&](std::size_t, const auto& row) { table.append(row); }; };
  copy("frames", data.frames, earlier->frames, to(file->frames));
  copy("rows of contacts", data.contacts, earlier->contacts, to(file->contacts));
  copy("rows of histories", data.histories, earlier->histories, to(file->histories));
  copy("rows of breaks", data.breaks, earlier->breaks, to(file->breaks));
  copy("rows of steps", data.steps, earlier->steps, to(file->steps));
  copy("stages", data.run.stages, earlier->stages + (earlier->within_stage ? 1 : 0),
       [&](std::size_t k, const record::StageRecord& stage) {
         const int index = static_cast<int>(k);
         file->stages.append_line(stage_json(index, stage, index < earlier->stages));
       });
}

// Gives the file its name, when its first row is to be written. With what it takes over it is complete by then: the file whose place
// it takes held that.
void ResultWriter::State::publish() {
  change_file([&] {
    if (earlier) copy_earlier();
    for (const std::string& line : waiting_stages) file->stages.append_line(line);
    waiting_stages.clear();
    file->flush_whole();
    hdf5::check(H5Fstart_swmr_write(file->file), "file");
  });
  if (before_publishing) before_publishing();
  std::error_code error;
  std::filesystem::rename(temporary, path(), error);
  if (error) throw RunError(fmt::format("{}: cannot rename: {}", path().string(), error.message()));
  sync_folder_of(path());
  published = true;
}

ResultWriter::ResultWriter(std::filesystem::path directory, double flush_interval)
    : state_(std::make_unique<State>()) {
  state_->directory = std::move(directory);
  state_->flush_interval = std::chrono::duration<double>(flush_interval);
}

ResultWriter::~ResultWriter() {
  close();
}

void ResultWriter::close() {
  if (state_->file && !state_->published) state_->abandon();
  state_->file.reset();
}

void ResultWriter::before_publishing(std::function<void()> call) {
  state_->before_publishing = std::move(call);
}

void ResultWriter::begin(const record::ModelRecord& model) {
  std::error_code error;
  std::filesystem::create_directories(state_->directory, error);
  if (error)
    throw RunError(fmt::format("{}: cannot create: {}", state_->directory.string(), error.message()));
  state_->model = model;
  const NewFile made = create_temporary(state_->path());
  ::close(made.descriptor);
  state_->temporary = made.path;
  state_->change_file([&] {
    state_->file.emplace(state_->temporary, model);
    describe_datasets(state_->file->file, model);
    state_->file->flush_whole();
  });
  state_->start = state_->last_flush = Clock::now();
}

void ResultWriter::resume(const record::Reported& reported) {
  state_->earlier = reported;
}

// What is to be done before a row is added.
void ResultWriter::before_event() {
  if (!state_->published) state_->publish();
  if (state_->flush_is_due()) flush();
}

void ResultWriter::flush() {
  state_->change_file([&] { state_->file->flush(); });
  state_->last_flush = Clock::now();
}

void ResultWriter::stage_begin(int index, const record::StageRecord& stage) {
  const std::string line = stage_json(index, stage, false);
  if (!state_->published) {
    state_->waiting_stages.push_back(line);
  } else {
    state_->change_file([&] { state_->file->stages.append_line(line); });
  }
}

void ResultWriter::frame(const record::Frame& frame) {
  before_event();
  state_->change_file([&] { state_->file->frames.append(frame); });
}

void ResultWriter::contacts(const record::ContactFrame& frame) {
  before_event();
  state_->change_file([&] { state_->file->contacts.append(frame); });
}

void ResultWriter::history(const record::HistoryRow& row) {
  before_event();
  state_->change_file([&] { state_->file->histories.append(row); });
}

void ResultWriter::breaks(const record::BreakRecord& row) {
  before_event();
  state_->change_file([&] { state_->file->breaks.append(row); });
}

void ResultWriter::step(const record::StepRow& row) {
  before_event();
  state_->change_file([&] { state_->file->steps.append(row); });
}

// Before the first event of a resumed run, all that the checkpoint counts stands in the file of the earlier one.
void ResultWriter::checkpoint() {
  if (!state_->published) return;
  flush();
  state_->change_file([&] { hdf5::sync(state_->file->file); });
}

void ResultWriter::stage_end(int index, const record::StageRecord& stage) {
  const std::string line = stage_json(index, stage, true);
  if (!state_->published) {
    state_->waiting_stages.push_back(line);
    return;
  }
  state_->change_file([&] { state_->file->stages.append_line(line); });
  flush();
}

void ResultWriter::end(const record::RunRecord& run) {
  if (!state_->file) return;  // the run failed before it began, or the file could not be written
  if (!state_->published) state_->publish();
  state_->change_file([&] {
    state_->file->run.append_line(run_json(run));
    state_->file->summary.append(summary_json(state_->model, run));
    state_->file->flush_whole();
  });
  state_->file.reset();
  if (has_histories(state_->model))
    write_histories_csv(state_->directory, state_->model, read_histories(state_->directory));
  write_summary(state_->directory, state_->model, run);  // last: has_ended looks for it
}

}  // namespace keyblock::results
