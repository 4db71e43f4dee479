#include "coupling/step_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "core/known_size.h"
#include "core/lanes.h"

namespace keyblock::dynamics {

namespace {

/// N per thickness, at D = 0.
double largest_force(const SpringArray& springs, ThreadTeam& team) {
  return largest_of(team, springs.size(), contacts_worth_threads, [&](std::size_t c) {
    const SpringArray::Force force = springs.force(c);
    return std::hypot(force.normal, force.shear);
  });
}

}  // namespace

void StepProblem::build(const Model& model, const State& state, const Drive& drive, const Coupling& contacts,
                        ThreadTeam& team) {
  team_ = &team;
  is_static_ = drive.is_static;
  if (model_ != &model) points_.begin(model);
  model_ = &model;
  state_ = &state;
  terms_.build(model, state, drive, team);
  parts_.clear();
  std::size_t rows = 0;
  const auto add_part = [&](const Coupling& coupling) {
    parts_.push_back({&coupling, rows});
    rows += coupling.rows();
  };
  add_part(contacts);
  for (const auto& coupling : model.couplings) add_part(*coupling);
  // Rows of contacts come first: that a row is one of a contact is asked by its number.
  rows_.resize(rows);
  springs_.resize(rows);
  points_.resize(rows);
  owners_.resize(rows, team);
  facts_ = {};
  std::size_t first_point = 0;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const auto [coupling, first] = parts_[k];
    facts_ |= coupling->build(model, state, drive, memory(k),
                              {first, first_point, std::span(rows_).subspan(first, coupling->rows()),
                               springs_, points_, owners_, team});
    first_point += coupling->points().size();
  }
  owners_.find_ranges(team);
  // Balance is measured by weights; where nothing has any, by the largest force that something is pressed with.
  terms_.weigh_motion(drive, model.gravity == Vec2{} ? largest_force(springs_, team) : 0.0);
}

void StepProblem::name_rows(std::vector<Coupling::RowKey>& keys) const {
  keys.clear();
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Coupling& coupling = *parts_[k].coupling;
    for (std::size_t row = 0, rows = coupling.rows(); row < rows; ++row) {
      keys.push_back({static_cast<int>(k), coupling.key(row)});
    }
  }
}

void StepProblem::find_pairs(std::span<const std::pair<int, int>> pattern) {
  for (Row& row : rows_) row.pair = pair_in(pattern, row.unknown_a, row.unknown_b);
  facts_.lacks_room = false;
}

void StepProblem::derivative(const Row& row, Vec2 direction, std::vector<double>& a,
                             std::vector<double>& b) const {
  a.assign(2 * at(points_.body_of(row.vertex).size), 0.0);
  b.assign(2 * at(points_.body_of(row.from).size), 0.0);
  points_.add_force(row.vertex, direction, a.data());
  points_.add_force(row.from, -(1.0 - row.position) * direction, b.data());
  points_.add_force(row.to, -row.position * direction, b.data());
}

void StepProblem::add_gathered_forces(std::span<const Vec2> forces, std::span<double> out) const {
  team_->for_range(model_->bodies(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) points_.add_forces(b, forces, out);
  });
}

void StepProblem::gradient_with(std::span<const double> d, std::span<const Vec2> forces,
                                std::span<double> g) const {
  team_->for_range(model_->bodies(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = terms_.coefficients(i).first, last = terms_.coefficients(i).second;
      with_known_size(model_->moves(i) ? points_.body(i).size : 0, [&](auto size) {
        if constexpr (std::is_same_v<decltype(size), int>) {
          terms_.multiply(i, d, g);
          for (std::size_t k = first; k < last; ++k) g[k] -= terms_.right()[k];
          points_.add_forces(i, forces, g);
        } else {
          std::array<Lanes, (2 * at(size) + lane_count - 1) / lane_count> terms;
          terms_.multiply(size, i, &d[first], [&](int k, int count, Lanes rows) {
            terms[at(k / lane_count)] = rows - load_first(&terms_.right()[first + at(k)], count);
          });
          const auto start = [&](int k) {
            const Lanes& of = terms[at(2 * k / lane_count)];
            return Pair{of[2 * k % lane_count], of[2 * k % lane_count + 1]};
          };
          points_.add_forces(size, i, forces, start, &g[first]);
        }
      });
    }
  });
}

void gradient_by_rows(const StepProblem& problem, std::span<const double> d, std::span<double> g) {
  const SpringArray& springs = problem.springs();
  for (std::size_t b = 0; b < problem.model().bodies(); ++b) problem.terms().multiply(b, d, g);
  for (std::size_t k = 0; k < g.size(); ++k) g[k] -= problem.terms().right()[k];
  std::vector<double> y(springs.size());
  for (std::size_t c = 0; c < problem.rows().size(); ++c) {
    const Row& row = problem.rows()[c];
    const Vec2 r = problem.relative(row, d);
    y[c] = springs.y0[c] - dot(row.normal, r);
    const SpringArray::Force force = springs.force_at(c, y[c], springs.w0[c] + dot(row.tangent(), r));
    if (!force.is_zero()) problem.add_force(row, row.gradient(force), g);
  }
  FaceSprings faces = springs.faces;
  faces.press(y);
  for (std::size_t c = 0; c < problem.rows().size() && !faces.empty(); ++c) {
    const Row& row = problem.rows()[c];
    problem.add_force(row, row.gradient({faces.force(c), 0.0}), g);
  }
}

}  // namespace keyblock::dynamics
