#include <algorithm>
#include <cmath>
#include <string>

#include "picture/force_chains.h"
#include "picture/marks.h"
#include "record/record_fields.h"
#include "report/frame_codec.h"
#include "report/page_data.h"
#include "report/thinning.h"
#include "results/joint_pieces.h"

namespace keyblock::report {

namespace {

using record::ContactFrame;
using record::Frame;

constexpr std::size_t max_frames = 300;
constexpr std::size_t max_snapshots = 60;
constexpr std::size_t max_rows = 4000;
/// Numbers of displacement beyond which a large model gets fewer frames, which bounds the page at about 15
/// MB.
constexpr std::size_t max_displacements = 8'000'000;
constexpr std::size_t min_frames = 60;

void add_model(const results::RunData& run, ArrayPack& pack) {
  const record::ModelRecord& model = run.model;
  std::vector<std::uint32_t> begin, end, block;
  std::vector<std::uint8_t> order, fixed, kind;
  std::vector<std::int32_t> index;
  std::vector<float> position, area, density;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const auto& record = model.blocks[b];
    for (std::size_t r = 0; r + 1 < record.ring_start.size(); ++r) {
      begin.push_back(static_cast<std::uint32_t>(record.ring_start[r]));
      end.push_back(static_cast<std::uint32_t>(record.ring_start[r + 1]));
      block.push_back(static_cast<std::uint32_t>(b));
    }
    fixed.push_back(record.fixed ? 1 : 0);
    area.push_back(static_cast<float>(record.area));
    density.push_back(static_cast<float>(record.density));
  }
  for (const int n : results::last_orders(run)) order.push_back(static_cast<std::uint8_t>(std::min(n, 255)));
  for (const Vec2 p : model.vertices) {
    position.push_back(static_cast<float>(p.x));
    position.push_back(static_cast<float>(p.y));
  }
  for (const cutting::EdgeLabel label : model.edge_label) {
    kind.push_back(static_cast<std::uint8_t>(label.kind));
    index.push_back(label.index);
  }
  pack.add("ring.begin", begin);
  pack.add("ring.end", end);
  pack.add("ring.block", block);
  pack.add("vertex.position", position);
  pack.add("edge.kind", kind);
  pack.add("edge.index", index);
  pack.add("block.order", order);
  pack.add("block.fixed", fixed);
  pack.add("block.area", area);
  pack.add("block.density", density);
}

std::vector<std::size_t> chosen_frames(const results::RunData& run) {
  std::vector<int> stages;
  for (const Frame& frame : run.frames) stages.push_back(frame.stage);
  const std::size_t per_frame = std::max<std::size_t>(1, 2 * run.model.vertices.size());
  return thin_by_stage(stages, std::clamp(max_displacements / per_frame, min_frames, max_frames));
}

void add_frames(const results::RunData& run, const std::vector<std::size_t>& chosen, ArrayPack& pack) {
  const std::size_t vertices = run.model.vertices.size();
  const std::size_t blocks = run.model.blocks.size();
  std::vector<double> time, step;
  std::vector<std::int32_t> stage;
  std::vector<std::uint8_t> status;
  for (const std::size_t f : chosen) {
    const Frame& frame = run.frames[f];
    time.push_back(frame.time);
    step.push_back(static_cast<double>(frame.step));
    stage.push_back(frame.stage);
    for (const record::BlockStatus s : frame.status) status.push_back(static_cast<std::uint8_t>(s));
  }
  pack.add("frame.time", time);
  pack.add("frame.step", step);
  pack.add("frame.stage", stage);
  pack.add("frame.status", status);
  pack.add("frame.displacement",
           encode_frames(chosen.size(), 2 * vertices, displacement_quantum(run),
                         [&](std::size_t f, std::size_t i) {
                           return double{run.frames[chosen[f]].displacement[i % vertices][i / vertices]};
                         }));
  pack.add("frame.stress",
           encode_frames(chosen.size(), 3 * blocks, stress_quantum(run), [&](std::size_t f, std::size_t i) {
             return double{run.frames[chosen[f]].stress[i % blocks][i / blocks]};
           }));
  const bool knows_velocities =
      std::ranges::all_of(chosen, [&](std::size_t f) { return run.frames[f].velocity.size() == blocks; });
  if (!knows_velocities || chosen.empty()) return;
  const double quantum = velocity_quantum(run);
  pack.add("frame.velocity",
           encode_frames(chosen.size(), 2 * blocks, quantum, [&](std::size_t f, std::size_t i) {
             return double{run.frames[chosen[f]].velocity[i % blocks][i / blocks]};
           }));
}

void add_elements(const results::RunData& run, const std::vector<std::size_t>& chosen, ArrayPack& pack) {
  if (run.model.elements.empty()) return;
  std::vector<float> reference, ends, numbers;
  std::vector<std::uint8_t> present;
  const auto add = [](std::vector<float>& to, Vec2 p) {
    to.push_back(static_cast<float>(p.x));
    to.push_back(static_cast<float>(p.y));
  };
  for (const record::ElementDescription& e : run.model.elements) {
    add(reference, e.from);
    add(reference, e.to);
  }
  for (const std::size_t f : chosen) {
    for (const record::ElementState& e : run.frames[f].elements) {
      add(ends, e.from);
      add(ends, e.to);
      for (const auto& field :
           std::span(record::element_state_fields).first<record::first_new_element_state>())
        numbers.push_back(static_cast<float>(e.*field.number));
      present.push_back(e.present ? 1 : 0);
    }
  }
  pack.add("element.reference", reference);
  pack.add("element.ends", ends);
  pack.add("element.numbers", numbers);
  pack.add("element.present", present);
}

/// What blocks press on each other with, snapshot by snapshot.
class PackedChains {
 public:
  void add(const ContactFrame& contacts) {
    for (const picture::ForceChain& chain : picture::force_chains(contacts)) {
      for (const int b : {chain.block_a, chain.block_b}) block_.push_back(static_cast<std::uint32_t>(b));
      for (const double x : {chain.middle.x, chain.middle.y}) middle_.push_back(static_cast<float>(x));
      force_.push_back(static_cast<float>(chain.force));
      hinge_.push_back(chain.is_hinge() ? 1 : 0);
    }
    begin_.push_back(static_cast<std::uint32_t>(force_.size()));
  }
  void pack(ArrayPack& pack) const {
    pack.add("chain.begin", begin_);
    pack.add("chain.block", block_);
    pack.add("chain.middle", middle_);
    pack.add("chain.force", force_);
    pack.add("chain.hinge", hinge_);
  }

 private:
  std::vector<std::uint32_t> begin_{0}, block_;
  std::vector<float> middle_, force_;
  std::vector<std::uint8_t> hinge_;
};

void add_contacts(const results::RunData& run, const std::vector<std::size_t>& frames, ArrayPack& pack) {
  std::vector<int> stages;
  for (const ContactFrame& snapshot : run.contacts) stages.push_back(snapshot.stage);
  const results::JointLocator locator(run.model);
  std::vector<results::JointPiece> pieces;
  PackedChains chains;
  std::vector<std::uint32_t> frame_index, begin{0};
  for (const std::size_t k : thin_by_stage(stages, max_snapshots)) {
    if (run.frames.empty()) break;
    const std::size_t frame = results::frame_of(run.contacts[k], run.frames);
    locator.locate(run.contacts[k].contacts, run.frames[frame].displacement, pieces);
    const auto at = std::lower_bound(frames.begin(), frames.end(), frame);
    frame_index.push_back(static_cast<std::uint32_t>(at - frames.begin()));
    begin.push_back(static_cast<std::uint32_t>(pieces.size()));
    chains.add(run.contacts[k]);
  }
  std::vector<std::uint32_t> vertex;
  std::vector<std::uint8_t> from, to, state;
  std::vector<float> slip, gap, lost, pressure;
  const auto share = [](float s) { return static_cast<std::uint8_t>(std::lround(255.0F * s)); };
  for (const results::JointPiece& piece : pieces) {
    vertex.push_back(piece.vertex);
    from.push_back(share(piece.from));
    to.push_back(share(piece.to));
    state.push_back(static_cast<std::uint8_t>(piece.state));
    slip.push_back(piece.slip);
    gap.push_back(piece.gap);
    lost.push_back(piece.lost);
    pressure.push_back(piece.pressure);
  }
  pack.add("snapshot.frame", frame_index);
  pack.add("snapshot.begin", begin);
  chains.pack(pack);
  pack.add("piece.vertex", vertex);
  pack.add("piece.from", from);
  pack.add("piece.to", to);
  pack.add("piece.state", state);
  pack.add("piece.slip", slip);
  pack.add("piece.gap", gap);
  // What no joint has is not in the page, and nobody can ask for it there.
  const auto is_any = [](float value) { return value > 0.0F; };
  if (std::ranges::any_of(lost, is_any)) pack.add("piece.lost", lost);
  if (std::ranges::any_of(pressure, is_any)) pack.add("piece.pressure", pressure);
}

void add_curves(std::string_view x_name, std::string_view values_name, const Curves& curves,
                ArrayPack& pack) {
  const Curves thin = thin_curves(curves, max_rows);
  std::vector<float> values;
  for (const auto& column : thin.columns)
    for (const double v : column) values.push_back(static_cast<float>(v));
  pack.add(x_name, thin.x);
  pack.add(values_name, values);
}

void add_histories(const results::RunData& run, ArrayPack& pack) {
  Curves curves;
  constexpr std::size_t quantities = std::size(record::history_fields);
  constexpr std::size_t of_element = record::element_history_fields.size();
  const std::size_t first_element = 1 + quantities * run.model.history_names.size();
  curves.columns.resize(first_element + of_element * run.model.element_histories.size());
  for (const record::HistoryRow& row : run.histories) {
    curves.x.push_back(row.time);
    curves.columns[0].push_back(static_cast<double>(row.step));
    for (std::size_t p = 0; p < run.model.history_names.size(); ++p) {
      const auto& q = row.points[p];
      for (std::size_t c = 0; c < quantities; ++c)
        curves.columns[1 + quantities * p + c].push_back(q.*record::history_fields[c].member);
    }
    std::size_t column = first_element;
    for (const record::ElementState& element : row.elements) {
      for (const auto& field : record::element_history_fields)
        curves.columns[column++].push_back(element.*field.number);
    }
  }
  add_curves("history.time", "history.values", curves, pack);
}

void add_steps(const results::RunData& run, ArrayPack& pack) {
  Curves curves;
  for (const record::StepRow& row : run.steps) {
    const record::Energy& e = row.energy;
    const double residual = e.kinetic + e.strain + e.gravity + e.contact + e.friction + e.damping +
                            e.radiated + e.numerical - e.input - e.water;
    // In the order of step_columns in page_header.cpp.
    const double values[] = {double(row.stage),
                             row.time,
                             double(row.iterations),
                             row.step_size,
                             row.penetration,
                             row.max_displacement,
                             double(row.closed_contacts),
                             e.kinetic,
                             e.strain,
                             e.gravity,
                             e.contact,
                             e.friction,
                             e.damping,
                             e.radiated,
                             e.numerical,
                             e.input,
                             e.water,
                             residual};
    curves.columns.resize(std::size(values));
    curves.x.push_back(static_cast<double>(row.step));
    for (std::size_t c = 0; c < std::size(values); ++c) curves.columns[c].push_back(values[c]);
  }
  add_curves("step.step", "step.values", curves, pack);
}

void add_motions(const results::RunData& run, ArrayPack& pack) {
  for (std::size_t k = 0; k < run.run.stages.size(); ++k) {
    const record::StageRecord& stage = run.run.stages[k];
    if (stage.motion_time.empty()) continue;
    std::vector<double> time;
    std::vector<float> x, y;
    for (std::size_t i = 0; i < stage.motion_time.size() && stage.motion_time[i] <= stage.duration; ++i) {
      time.push_back(stage.start_time + stage.motion_time[i]);
      x.push_back(static_cast<float>(stage.motion[i].x));
      y.push_back(static_cast<float>(stage.motion[i].y));
    }
    const std::string name = "motion." + std::to_string(k);
    pack.add(name + ".time", time);
    pack.add(name + ".x", x);
    pack.add(name + ".y", y);
  }
}

// A thousandth of the median of what is not zero.
double share_of_typical(std::vector<float>& sizes) {
  constexpr double share_of_median = 1e-3;
  std::erase_if(sizes, [](float size) { return !std::isfinite(size) || size == 0.0F; });
  if (sizes.empty()) return 1.0;
  for (float& size : sizes) size = std::abs(size);
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return share_of_median * double{*middle};
}

}  // namespace

double displacement_quantum(const results::RunData& run) {
  constexpr double share_of_size = 1e-7, share_of_largest = 1e-4;
  Box box;
  for (const Vec2 p : run.model.vertices) box.add(p);
  double largest = 0.0;
  for (const Frame& frame : run.frames)
    for (const auto& u : frame.displacement)
      for (const float c : u)
        if (std::isfinite(c)) largest = std::max(largest, std::abs(double{c}));
  const double size = run.model.vertices.empty() ? 1.0 : std::max(box.size().x, box.size().y);
  if (largest == 0.0) return share_of_size * size;
  // What flies far must not be held on its way.
  return std::max(std::min(share_of_size * size, share_of_largest * largest), largest / most_quanta);
}

double stress_quantum(const results::RunData& run) {
  std::vector<float> sizes;
  for (const Frame& frame : run.frames)
    for (const auto& s : frame.stress) sizes.insert(sizes.end(), s.begin(), s.end());
  return share_of_typical(sizes);
}

double velocity_quantum(const results::RunData& run) {
  constexpr double share_of_arrow = 1e-2;
  return share_of_arrow * picture::typical_sizes(run).velocity;
}

ArrayPack page_arrays(const results::RunData& run) {
  ArrayPack pack;
  add_model(run, pack);
  const std::vector<std::size_t> frames = chosen_frames(run);
  add_frames(run, frames, pack);
  add_elements(run, frames, pack);
  add_contacts(run, frames, pack);
  add_histories(run, pack);
  add_steps(run, pack);
  add_motions(run, pack);
  return pack;
}

}  // namespace keyblock::report
