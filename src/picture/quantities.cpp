#include "picture/quantities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "core/index.h"
#include "results/block_shape.h"

namespace keyblock::picture {
namespace {

using record::BlockStatus;
using record::Frame;

constexpr BlockQuantity all_quantities[] = {
    {"displacement", "Displacement of the blocks", Quantity::length},
    {"velocity", "Velocity of the blocks", Quantity::velocity},
    {"slip", "Largest slip of the joints of each block", Quantity::length},
    {"mean", "Mean stress (σxx + σyy)/2", Quantity::stress, ColorMap::mako, true},
    {"major", "Most compressive principal stress", Quantity::stress, ColorMap::mako, true},
    {"minor", "Least compressive principal stress", Quantity::stress, ColorMap::mako, true},
    {"shear", "Largest shear stress", Quantity::stress, ColorMap::mako},
    {"sxx", "Stress σxx", Quantity::stress, ColorMap::mako, true},
    {"syy", "Stress σyy", Quantity::stress, ColorMap::mako, true},
    {"sxy", "Stress σxy", Quantity::stress, ColorMap::mako, true},
    {"density", "Density", Quantity::density, ColorMap::mako},
    {"status", "Status of the blocks", Quantity::none, ColorMap::magma, false, true},
    {"order", "Order of the displacement polynomial", Quantity::none, ColorMap::magma, false, true},
    {"plain", "", Quantity::none, ColorMap::magma, false, true},
};

constexpr std::array<std::string_view, 3> status_colors{rock_color, "#e69f00", "#d55e00"};
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double stress_value(std::string_view name, const std::array<float, 3>& s) {
  if (name == "mean") return 0.5 * (double{s[0]} + s[1]);
  if (name == "sxx") return s[0];
  if (name == "syy") return s[1];
  if (name == "sxy") return s[2];
  const Principal p = principal_of(s);
  if (name == "major") return p.smaller;
  return name == "minor" ? p.larger : 0.5 * (p.larger - p.smaller);
}

// What all fixed blocks have moved by; zero where they move differently, or where there are none.
Vec2 base_motion(const record::ModelRecord& model, const Frame& frame) {
  constexpr double alike = 1e-6;
  std::optional<Vec2> base;
  for (const auto& block : model.blocks) {
    if (!block.fixed) continue;
    for (int v = block.ring_start.front(); v < block.ring_start.back(); ++v) {
      const auto [x, y] = frame.displacement[at(v)];
      const Vec2 u{x, y};
      if (!base) base = u;
      if (norm(u - *base) > alike) return {};
    }
  }
  return base.value_or(Vec2{});
}

}  // namespace

std::span<const BlockQuantity> block_quantities() {
  return all_quantities;
}

const BlockQuantity* find_quantity(std::string_view name) {
  const auto found =
      std::ranges::find(all_quantities, name, [](const auto& q) { return std::string_view(q.name); });
  return found == std::end(all_quantities) ? nullptr : &*found;
}

Principal principal_of(const std::array<float, 3>& s) {
  const double mean = 0.5 * (double{s[0]} + s[1]), difference = 0.5 * (double{s[0]} - s[1]);
  const double radius = std::hypot(difference, double{s[2]});
  return {mean + radius, mean - radius, 0.5 * std::atan2(double{s[2]}, difference)};
}

std::vector<std::size_t> stage_end_frames(const results::RunData& run) {
  std::vector<std::size_t> ends;
  for (std::size_t f = 0; f < run.frames.size(); ++f)
    if (f + 1 == run.frames.size() || run.frames[f + 1].stage != run.frames[f].stage) ends.push_back(f);
  return ends;
}

std::optional<std::size_t> reference_frame(const results::RunData& run) {
  const auto stage = std::ranges::find_if(
      run.run.stages, [](const record::StageRecord& s) { return !s.stage.excavate.empty(); });
  if (stage == run.run.stages.end()) return std::nullopt;
  const auto first =
      std::ranges::find(run.frames, static_cast<int>(stage - run.run.stages.begin()), &Frame::stage);
  if (first == run.frames.end()) return std::nullopt;
  return static_cast<std::size_t>(first - run.frames.begin());
}

std::vector<Vec2> block_displacements(const results::RunData& run, std::size_t frame) {
  const auto since = reference_frame(run);
  std::vector<Vec2> found(run.model.blocks.size());
  if (since && frame < *since) return found;
  const Frame& now = run.frames[frame];
  const Frame* before = since ? &run.frames[*since] : nullptr;
  const Vec2 base = base_motion(run.model, now) - (before ? base_motion(run.model, *before) : Vec2{});
  for (std::size_t b = 0; b < found.size(); ++b) {
    const Vec2 u = results::block_displacement(run.model, now, b);
    found[b] = u - (before ? results::block_displacement(run.model, *before, b) : Vec2{}) - base;
  }
  return found;
}

const record::ContactFrame* contacts_at(const results::RunData& run, std::size_t frame) {
  const Frame& now = run.frames[frame];
  const auto later = std::upper_bound(run.contacts.begin(), run.contacts.end(), now,
                                      [](const Frame& f, const record::ContactFrame& c) {
                                        return std::pair(f.stage, f.step) < std::pair(c.stage, c.step);
                                      });
  return later == run.contacts.begin() ? nullptr : &*std::prev(later);
}

BlockValues::BlockValues(const results::RunData& run, const BlockQuantity& quantity)
    : run_(run), quantity_(quantity) {
  std::set<int> orders;
  for (const Frame& frame : run.frames) orders.insert(frame.order.begin(), frame.order.end());
  orders_.assign(orders.begin(), orders.end());
  if (quantity.is_class) return;
  std::vector<std::size_t> frames = stage_end_frames(run);
  // At the ends of stages nothing moves any more.
  if (quantity.quantity == Quantity::velocity) {
    constexpr std::size_t samples = 30;
    for (std::size_t k = 0; k < samples && !run.frames.empty(); ++k)
      frames.push_back(k * (run.frames.size() - 1) / (samples - 1));
  }
  std::vector<double> values;
  for (const std::size_t f : frames) {
    const std::vector<double> now = at(f);
    for (std::size_t b = 0; b < now.size(); ++b)
      if (!run.model.blocks[b].fixed && run.frames[f].status[b] != BlockStatus::excavated)
        values.push_back(now[b]);
  }
  const bool is_size = quantity.quantity == Quantity::length || quantity.quantity == Quantity::velocity;
  scale_ = is_size                                 ? scale_of_sizes(std::move(values))
           : quantity.quantity == Quantity::stress ? scale_of_stresses(std::move(values))
                                                   : scale_between(std::move(values));
}

std::vector<double> BlockValues::at(std::size_t frame) const {
  const std::string_view name = quantity_.name;
  if (name == "slip") return largest_slips(frame);
  std::vector<double> values(run_.model.blocks.size());
  if (name == "displacement") {
    const std::vector<Vec2> ways = block_displacements(run_, frame);
    std::ranges::transform(ways, values.begin(), [](Vec2 way) { return norm(way); });
    return values;
  }
  for (std::size_t b = 0; b < values.size(); ++b) values[b] = value(run_.frames[frame], b);
  return values;
}

double BlockValues::value(const Frame& frame, std::size_t b) const {
  const std::string_view name = quantity_.name;
  if (name == "velocity")
    return frame.velocity.empty() ? nothing : std::hypot(frame.velocity[b][0], frame.velocity[b][1]);
  if (name == "density") return run_.model.blocks[b].density;
  if (name == "status") return static_cast<double>(frame.status[b]);
  if (name == "order")
    return static_cast<double>(std::ranges::find(orders_, int{frame.order[b]}) - orders_.begin());
  return name == "plain" ? 0.0 : stress_value(name, frame.stress[b]);
}

std::vector<double> BlockValues::largest_slips(std::size_t frame) const {
  std::vector<double> values(run_.model.blocks.size());
  const record::ContactFrame* contacts = contacts_at(run_, frame);
  if (contacts == nullptr) return values;
  for (const record::ContactRecord& c : contacts->contacts) {
    if (c.label.kind == cutting::EdgeKind::domain) continue;
    for (const int b : {c.block_a, c.block_b})
      values[keyblock::at(b)] = std::max(values[keyblock::at(b)], c.slip());
  }
  return values;
}

std::vector<NamedColor> BlockValues::classes() const {
  std::vector<NamedColor> named;
  const std::string_view name = quantity_.name;
  if (name == "status") {
    for (std::size_t k = 0; k < status_colors.size(); ++k)
      named.push_back({results::status_name(static_cast<BlockStatus>(k)), std::string(status_colors[k])});
  } else if (name == "order") {
    for (const int order : orders_)
      named.push_back({"order " + std::to_string(order),
                       std::string(order == 1 ? rock_color : class_color(keyblock::at(order) - 2))});
  } else if (name == "plain") {
    named.push_back({"", std::string(rock_color)});
  }
  return named;
}

std::string BlockValues::color(double value) const {
  if (std::isnan(value)) return std::string(rock_color);
  if (quantity_.is_class) {
    const auto named = classes();
    const auto k = static_cast<std::size_t>(value);
    return k < named.size() ? named[k].color : std::string(rock_color);
  }
  const double place = scale_.place(value);
  return shade(quantity_.map, shade_at(quantity_.much_is_low ? 1.0 - place : place));
}

}  // namespace keyblock::picture
