#include "keyblock/results.h"

#include <cmath>
#include <utility>

#include "api/contact_columns.h"
#include "job/result_folder.h"
#include "keyblock/keyblock.h"
#include "record/record_fields.h"
#include "results/export.h"
#include "results/run_data.h"
#include "results/summary.h"

namespace keyblock {

struct Results::Parts {
  results::RunData data;
};

namespace {
std::array<double, 2> xy(Vec2 p) {
  return {p.x, p.y};
}
}  // namespace

Results::Results(const std::filesystem::path& folder)
    : parts_(std::make_unique<Parts>(Parts{results::read_run(folder)})) {}
Results::~Results() = default;
Results::Results(Results&&) noexcept = default;
Results& Results::operator=(Results&&) noexcept = default;

std::string Results::summary() const {
  return results::summary_json(parts_->data.model, parts_->data.run);
}

std::size_t Results::blocks() const {
  return parts_->data.model.blocks.size();
}

std::size_t Results::frames() const {
  return parts_->data.frames.size();
}

Frame Results::frame(std::size_t k) const {
  const record::Frame& of = parts_->data.frames.at(k);
  Frame frame{of.time, of.stage, of.step, of.displacement, of.stress, {}, of.velocity, {}};
  for (const record::ElementState& e : of.elements)
    frame.elements.push_back({xy(e.from), xy(e.to), e.force, e.elongation, e.yielded, e.present});
  if (frame.velocity.empty()) frame.velocity.assign(blocks(), {std::nanf(""), std::nanf("")});
  for (const record::BlockStatus status : of.status)
    frame.status.push_back(static_cast<unsigned char>(status));
  return frame;
}

std::size_t Results::contact_snapshots() const {
  return parts_->data.contacts.size();
}

ContactSnapshot Results::contacts(std::size_t k) const {
  const record::ContactFrame& of = parts_->data.contacts.at(k);
  api::ContactColumns columns(parts_->data.model, of.contacts.size(), api::kept_contact_columns());
  columns.add(of.contacts);
  return {of.time, of.stage, of.step, columns.take()};
}

std::vector<double> Results::history_times() const {
  std::vector<double> times;
  for (const record::HistoryRow& row : parts_->data.histories) times.push_back(row.time);
  return times;
}

std::vector<HistoryOfPoint> Results::histories() const {
  std::vector<HistoryOfPoint> histories;
  const std::vector<std::string>& names = parts_->data.model.history_names;
  for (std::size_t k = 0; k < names.size(); ++k) {
    HistoryOfPoint& of = histories.emplace_back(HistoryOfPoint{names[k], {}, {}, {}, {}});
    for (const record::HistoryRow& row : parts_->data.histories) {
      const record::HistoryRow::Point& p = row.points.at(k);
      of.displacement.push_back({p.ux, p.uy});
      of.velocity.push_back({p.vx, p.vy});
      of.stress.push_back({p.sxx, p.syy, p.sxy});
      of.acceleration.push_back({p.ax, p.ay});
    }
  }
  return histories;
}

std::vector<HistoryOfElement> Results::element_histories() const {
  std::vector<HistoryOfElement> histories;
  const auto& followed = parts_->data.model.element_histories;
  for (std::size_t k = 0; k < followed.size(); ++k) {
    HistoryOfElement& of = histories.emplace_back(
        HistoryOfElement{followed[k].name, static_cast<std::size_t>(followed[k].element), {}, {}});
    for (const record::HistoryRow& row : parts_->data.histories) {
      of.force.push_back(row.elements.at(k).force);
      of.elongation.push_back(row.elements.at(k).elongation);
    }
  }
  return histories;
}

std::vector<Element> Results::elements() const {
  std::vector<Element> elements;
  for (const record::ElementDescription& e : parts_->data.model.elements)
    elements.push_back({e.name, e.kind, e.limit, xy(e.from), xy(e.to), e.from_block, e.to_block});
  return elements;
}

std::vector<StepEnergies> Results::energies() const {
  std::vector<StepEnergies> steps;
  for (const record::StepRow& row : parts_->data.steps) {
    StepEnergies& of = steps.emplace_back(StepEnergies{row.time, row.step, {}});
    for (const record::EnergyField& field : record::energy_fields)
      of.energy.emplace_back(field.name, row.energy.*field.number);
  }
  return steps;
}

std::vector<std::filesystem::path> Results::export_to(const std::filesystem::path& folder,
                                                      const std::string& format, bool replace) const {
  const auto known = results::export_format(format);
  if (!known) {
    Diagnostic diagnostic;
    diagnostic.key = "format";
    diagnostic.found = "\"" + format + "\"";
    diagnostic.expected = "\"vtk\", \"csv\" or \"geojson\"";
    throw InputError(std::move(diagnostic));
  }
  job::check_holds_no_run(folder);
  return results::export_run(parts_->data, folder, *known, replace);
}

std::vector<std::array<double, 2>> Results::vertices() const {
  std::vector<std::array<double, 2>> points;
  for (const Vec2 p : parts_->data.model.vertices) points.push_back({p.x, p.y});
  return points;
}

std::vector<std::vector<std::array<int, 2>>> Results::rings() const {
  std::vector<std::vector<std::array<int, 2>>> blocks;
  for (const record::ModelRecord::Block& block : parts_->data.model.blocks) {
    auto& rings = blocks.emplace_back();
    for (std::size_t r = 0; r + 1 < block.ring_start.size(); ++r)
      rings.push_back({block.ring_start[r], block.ring_start[r + 1]});
  }
  return blocks;
}

std::array<double, 2> Results::origin() const {
  return {parts_->data.model.origin.x, parts_->data.model.origin.y};
}

}  // namespace keyblock
