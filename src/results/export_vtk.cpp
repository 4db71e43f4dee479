#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "results/breaks.h"
#include "results/export.h"
#include "results/vtk_parts.h"

namespace keyblock::results {
namespace {

constexpr double smallest_time_step = 1e-6;  // s between the moments of a series

// A moment of a run: stage, step, and how many frames of the same series are of that step before it.
using Moment = std::tuple<int, long, int>;

template <class Frames>
std::vector<Moment> moments_of(const Frames& frames) {
  std::vector<Moment> moments;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const bool again =
        k > 0 && frames[k].stage == frames[k - 1].stage && frames[k].step == frames[k - 1].step;
    moments.emplace_back(frames[k].stage, frames[k].step, again ? std::get<2>(moments.back()) + 1 : 0);
  }
  return moments;
}

// Times of all moments, one and the same for blocks and contacts, that ascend where simulated time stands still.
std::map<Moment, double> series_times(const RunData& data) {
  std::map<Moment, double> times;
  const auto add = [&](const auto& frames) {
    const std::vector<Moment> moments = moments_of(frames);
    for (std::size_t k = 0; k < frames.size(); ++k) times.emplace(moments[k], frames[k].time);
  };
  add(data.frames);
  add(data.contacts);
  double next = -HUGE_VAL;
  for (auto& [moment, time] : times) {
    time = std::max(time, next);
    next = time + smallest_time_step;
  }
  return times;
}

// Writes one file per frame and the series of them; returns the series first.
template <class Frames, class Content>
std::vector<std::filesystem::path> write_series(const Frames& frames, const std::map<Moment, double>& times,
                                                FileSet& out, const std::string& name,
                                                const std::string& extension, const Content& content) {
  const std::vector<Moment> moments = moments_of(frames);
  std::vector<std::filesystem::path> files(1);
  std::vector<std::pair<double, std::string>> series;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::string file = fmt::format("{}_{:05}.{}", name, k, extension);
    files.push_back(out.write(file, content(frames[k])));
    series.emplace_back(times.at(moments[k]), file);
  }
  files.front() = out.write(name + ".pvd", vtk_series(series));
  return files;
}

}  // namespace

void add_vtk_moment(VtkFile& file, const record::ModelRecord& model, double time, int stage, long step) {
  const std::vector<double> origin{model.origin.x, model.origin.y, 0.0};
  file.open("FieldData");
  file.field<double>("TimeValue", time);
  file.field<std::int32_t>("stage", stage);
  file.field<std::int64_t>("step", step);
  file.array("origin", std::span<const double>(origin), 3);
  file.close("FieldData");
}

void add_vtk_lines(VtkFile& file, std::span<const std::int64_t> vertices, std::span<const std::int64_t> end) {
  file.open("Lines");
  file.array("connectivity", vertices);
  file.array("offsets", end);
  file.close("Lines");
}

std::vector<std::filesystem::path> export_vtk(const RunData& data, FileSet& out) {
  using record::ContactFrame;
  using record::Frame;
  const auto times = series_times(data);
  VtkBlocks blocks(data.model);
  const JointLocator locator(data.model);
  std::vector<std::filesystem::path> first, others;
  const auto add = [&](const auto& frames, const char* name, const char* extension, const auto& content) {
    const auto files = write_series(frames, times, out, name, extension, content);
    first.push_back(files.front());
    others.insert(others.end(), files.begin() + 1, files.end());
  };
  add(data.frames, "blocks", "vtu", [&](const Frame& frame) { return blocks.cells(frame); });
  add(data.contacts, "contacts", "vtp",
      [&](const ContactFrame& frame) { return vtk_contact_lines(data, locator, frame); });
  add(data.frames, "outlines", "vtp", [&](const Frame& frame) { return blocks.outlines(frame); });
  add(data.frames, "centres", "vtp", [&](const Frame& frame) { return blocks.centres(frame); });
  add(data.contacts, "forces", "vtp",
      [&](const ContactFrame& frame) { return vtk_contact_forces(data.model, frame); });
  if (!data.model.elements.empty())
    add(data.frames, "elements", "vtp", [&](const Frame& frame) { return vtk_elements(data.model, frame); });
  if (!data.breaks.empty()) first.push_back(out.write("breaks.vtp", vtk_breaks(data)));
  first.push_back(out.write("view.py", vtk_view(data)));
  first.insert(first.end(), others.begin(), others.end());
  return first;
}

}  // namespace keyblock::results
