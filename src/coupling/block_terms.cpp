#include "coupling/block_terms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>

#include "block/eigenvalue_floor.h"
#include "core/index.h"
#include "core/known_size.h"
#include "coupling/coupling.h"
#include "coupling/facets.h"
#include "linalg/dense_block.h"
#include "model/turn.h"
#include "model/vertex_field.h"
#include "model/worth_threads.h"

namespace keyblock::dynamics {

namespace {
/// The geometric stiffness of a dynamic step is kept above this share of its inertia. A block under extreme pressure then keeps a
/// positive definite step; and a turn w, that the step takes for a stretch of ½ w², cannot draw more energy than
/// twice this share of the rotation from a stress of impact. A trial of a static step has the same floor. Other static steps have none:
/// their inertia is small, and a floor would make the tangent of a slender block under pressure wrong. Where a block buckles, the matrix
/// is not positive definite, and the step is made shorter.
constexpr double geometric_floor = 0.05;

/// Of the largest force that makes a step, what a block is measured by at the least, in a model without gravity. With the tolerance of a
/// step, no block is wrong by more than a ten-millionth of the momentum that the fastest one has. Larger: slow blocks beside fast ones move
/// wrongly; smaller: more iterations for digits that nobody sees.
constexpr double motion_share = 1e-3;

/// Of the inertia of a step, what holds the shape of a block that strikes another one: what its strain would take up, and give back in later
/// steps or not, is no part of Drive::in_impact. Larger: digits are lost.
constexpr double rigid_share = 1e3;

/// Σ of the squares of what a turn by 1 rad changes n coefficients by.
double squared_turn(const double* position, int n) {
  double sum = 0.0;
  for (int k = 2; k < n; ++k) {
    const double turn = turn_of(1.0, position, at(k));
    sum += turn * turn;
  }
  return sum;
}

double floor_of(const Drive& drive, double inertia) {
  return drive.is_static && !drive.is_trial ? HUGE_VAL : geometric_floor * inertia;
}
}  // namespace

void BlockTerms::build(const Model& model, const State& state, const Drive& drive, ThreadTeam& team) {
  team_ = &team;
  if (model_ != &model) begin(model);
  is_static_ = drive.is_static;
  build_blocks(state, drive);
  build_lines(state, drive);
  add_loads(state, drive);
  for (std::size_t k = 0; k < model.couplings.size(); ++k)
    model.couplings[k]->add_terms(model, state, drive, state.couplings[k], *this);
}

void BlockTerms::begin(const Model& model) {
  model_ = &model;
  h_first_.clear();
  coefficients_.clear();
  body_force_.clear();
  frequency_.clear();
  largest_size_ = 0;
  std::size_t used = 0;
  for (const Block& block : model.blocks) {
    body_force_.push_back(block.body_force());
    frequency_.push_back(std::numbers::pi *
                         std::sqrt(block.material.young / (block.material.density * block.area)));
  }
  for (std::size_t b = 0; b < model.bodies(); ++b) {
    const Body& body = model.body(b);
    largest_size_ = std::max(largest_size_, body.size);
    h_first_.push_back(used);
    coefficients_.emplace_back(body.first, body.first + 2 * at(body.size));
    used += at(linalg::padded_rows(2 * body.size) * 2 * body.size);
  }
  h_.assign(used, 0.0);
  b_.assign(model.coefficients, 0.0);
  inertia_.assign(model.bodies(), 0.0);
  rigid_.assign(model.blocks.size(), 0.0);
  viscous_.assign(model.blocks.size(), 0.0);
  weight_.assign(model.bodies(), 0.0);
  stress_.assign(model.blocks.size(), 0.0);
  for (std::size_t i = 0; i < model.blocks.size() && model.gravity == Vec2{}; ++i) {
    const block::Stress s = block::in_situ_at(model.in_situ, model.blocks[i].centroid);
    stress_[i] = std::max({std::abs(s.xx), std::abs(s.yy), std::abs(s.xy)});
  }
}

/// Blocks of order 2 under so much pressure that the eigenvalues of their geometric stiffness are looked for: as many at once as there
/// are lanes.
struct BlockTerms::PressedBlocks {
  std::array<std::size_t, lane_count> block;
  std::array<block::MatrixOfOrder2, lane_count> geometric;
  std::array<double, lane_count> floor;
  std::size_t count = 0;
};

/// Material part of H, b, and the geometric stiffness (N − 1)², which H does not have yet.
template <typename Size>
void BlockTerms::linearize(Size size, std::size_t i, const State& state, const Drive& drive,
                           Vec2 acceleration, double* geometric) {
  const Block& block = model_->blocks[i];
  double *b = &b_[block.first], *h = &h_[h_first_[i]];
  block.elasticity.add_force_and_material_tangent(&state.position[block.first], viscous_[i], b, h,
                                                  linalg::padded_rows(2 * size), geometric);
  add_motion(size, i, state, drive);
  b[0] += block.body_force() * acceleration.x;
  b[1] += block.body_force() * acceleration.y;
}

/// b ← −b + M (c v/Δt + c_a a + c_F F)
template <typename Size>
void BlockTerms::add_motion(Size size, std::size_t i, const State& state, const Drive& drive) {
  const Body& body = model_->body(i);
  const int n = 2 * size;
  const double* v = &state.velocity[body.first];
  double* b = &b_[body.first];
  for (int k = 0; k < n; ++k) b[k] = -b[k] + (drive.is_static ? 0.0 : inertia_[i] * drive.step * v[k]);
  if (drive.is_static || state.acceleration.empty()) return;
  const double c_a = drive.rule[i].acceleration() * body.material.density,
               c_f = drive.rule[i].force() * body.material.density;
  for (std::size_t k = 0; k < at(n); ++k)
    b[k] += c_a * state.acceleration[body.first + k] + c_f * state.force[body.first + k];
}

/// Inertia alone; static steps do not hold it back where they hold blocks.
void BlockTerms::build_line(std::size_t i, const State& state, const Drive& drive) {
  const Body& line = model_->body(i);
  const int n = 2 * line.size, stride = linalg::padded_rows(n);
  std::fill_n(&b_[line.first], n, 0.0);
  double* h = &h_[h_first_[i]];
  std::fill_n(h, n * stride, 0.0);
  inertia_[i] = drive.rule[i].inertia() / (drive.step * drive.step) * line.material.density;
  for (int k = 0; k < n; ++k) h[k * stride + k] = inertia_[i];
  add_motion(line.size, i, state, drive);
}

template <typename Size>
void BlockTerms::build_block(Size size, std::size_t i, const State& state, const Drive& drive,
                             Vec2 acceleration, PressedBlocks& pressed) {
  const Block& block = model_->blocks[i];
  const int n = 2 * size, stride = linalg::padded_rows(n);
  double* b = &b_[block.first];
  std::fill(b, b + n, 0.0);
  inertia_[i] = 0.0;
  if (!model_->moves(i)) return;
  double* h = &h_[h_first_[i]];
  std::fill(h, h + 2 * stride, 0.0);  // translation; the rest is written below
  inertia_[i] = drive.rule[i].inertia() / (drive.step * drive.step) * block.material.density *
                (drive.is_static ? drive.inertia_scale[i] : 1.0);
  viscous_[i] = drive.is_static ? 0.0
                                : 2.0 * model_->solver.rock_damping / (frequency_[i] * drive.step) +
                                      stiffness_damping(*model_) / drive.step;
  const int m = size - 1;
  const double floor = floor_of(drive, inertia_[i]);
  if constexpr (std::is_same_v<Size, std::integral_constant<int, 6>>) {
    block::MatrixOfOrder2& geometric = pressed.geometric[pressed.count];
    linearize(size, i, state, drive, acceleration, geometric.data());
    if (!block::may_lie_below(geometric.data(), m, floor)) return finish_block(size, i, geometric.data());
    pressed.block[pressed.count] = i;
    pressed.floor[pressed.count] = floor;
    if (++pressed.count == lane_count) finish_blocks(pressed);
  } else {
    std::array<double, 4> of_order_1;
    std::vector<double> many(m > 2 ? at(m * m) : 0);
    double* geometric = m > 2 ? many.data() : of_order_1.data();
    linearize(size, i, state, drive, acceleration, geometric);
    if (m == 2 || block::may_lie_below(geometric, m, floor)) block::raise_eigenvalues(geometric, m, floor);
    finish_block(size, i, geometric);
  }
}

/// What H has beside the material part: geometric stiffness (N − 1)², inertia, and the upper triangle.
template <typename Size>
void BlockTerms::finish_block(Size size, std::size_t i, const double* geometric) {
  const int n = 2 * size, stride = linalg::padded_rows(n);
  double* h = &h_[h_first_[i]];
  model_->blocks[i].elasticity.add_geometric_tangent(geometric, h, stride);
  for (int k = 0; k < n; ++k) h[k * stride + k] += inertia_[i];
  for (int c = 1; c < n; ++c) {
    for (int r = 0; r < c; ++r) h[c * stride + r] = h[r * stride + c];
  }
}

void BlockTerms::finish_blocks(PressedBlocks& pressed) {
  block::raise_eigenvalues(std::span(pressed.geometric).first(pressed.count),
                           std::span(pressed.floor).first(pressed.count));
  for (std::size_t k = 0; k < pressed.count; ++k)
    finish_block(std::integral_constant<int, 6>{}, pressed.block[k], pressed.geometric[k].data());
  pressed.count = 0;
}

void BlockTerms::build_blocks(const State& state, const Drive& drive) {
  const Vec2 acceleration = model_->gravity - drive.ground_acceleration;
  team_->for_range(model_->blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
    PressedBlocks pressed;
    for (std::size_t i = begin; i < end; ++i) {
      const Block& block = model_->blocks[i];
      with_known_size(block.size,
                      [&](auto size) { build_block(size, i, state, drive, acceleration, pressed); });
    }
    finish_blocks(pressed);
    for (std::size_t i = begin; i < end; ++i) {
      rigid_[i] = 0.0;
      if (drive.in_impact.empty() || drive.in_impact[i] == 0 || !model_->moves(i)) continue;
      rigid_[i] = rigid_share * inertia_[i];
      make_rigid(i, state);
    }
  });
}

void BlockTerms::build_lines(const State& state, const Drive& drive) {
  team_->for_range(model_->lines.size(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) build_line(model_->blocks.size() + i, state, drive);
  });
}

/// Adds what resists all motion of a block but that of a rigid body: of coefficients beyond the mean, all but the turn.
void BlockTerms::make_rigid(std::size_t i, const State& state) {
  const Block& block = model_->blocks[i];
  const int n = 2 * block.size, stride = linalg::padded_rows(n);
  const double* position = &state.position[block.first];
  const double squared = squared_turn(position, n);
  double* h = &h_[h_first_[i]];
  for (int c = 2; c < n; ++c) {
    h[c * stride + c] += rigid_[i];
    for (int r = 2; r < n; ++r)
      h[c * stride + r] -=
          rigid_[i] * turn_of(1.0, position, at(c)) * turn_of(1.0, position, at(r)) / squared;
  }
}

/// Loads, and what residuals are measured by. A load whose time has not come, or is over, measures nothing, except in static steps without
/// gravity: there may be nothing else that says which forces are large.
void BlockTerms::add_loads(const State& state, const Drive& drive) {
  const double g = std::max(norm(model_->gravity), norm(drive.ground_acceleration));
  for (std::size_t i = 0; i < model_->blocks.size(); ++i)
    weight_[i] = std::max(body_force_[i] * g, drive.is_static ? stress_[i] : 0.0);
  const bool is_scale = drive.is_static && model_->gravity == Vec2{};
  for (std::size_t l = 0; l < model_->loads.size(); ++l) {
    const GeneralizedLoad& load = model_->loads[l];
    if (!model_->moves(at(load.block))) continue;
    const Block& block = model_->blocks[at(load.block)];
    const double f = model_->load_factor(l, drive.end_time), measured = is_scale ? 1.0 : f;
    double largest = 0.0;
    for (std::size_t k = 0; k < load.force.size(); ++k) {
      b_[block.first + k] += f * load.force[k];
      largest = std::max(largest, std::abs(measured * load.force[k]));
    }
    weight_[at(load.block)] = std::max(weight_[at(load.block)], largest);
  }
  if (model_->gravity == Vec2{}) add_weights(*model_, state, drive, weight_);
  weigh_lines();
}

/// A force that is small beside those of the block is small.
void BlockTerms::weigh_lines() {
  for (std::size_t l = 0; l < model_->lines.size(); ++l) {
    const LineBody& line = model_->lines[l];
    weight_[model_->blocks.size() + l] =
        weight_[at(line.block)] * std::sqrt(model_->blocks[at(line.block)].area / line.area);
  }
}

/// Largest |b_k| of a block.
double BlockTerms::largest_of_right(std::size_t i) const {
  double largest = 0.0;
  for (std::size_t k = coefficients_[i].first; k < coefficients_[i].second; ++k)
    largest = std::max(largest, std::abs(b_[k]));
  return largest;
}

void BlockTerms::weigh_motion(const Drive& drive, double row_force) {
  has_weights_ = true;
  if (model_->gravity != Vec2{}) return;
  double largest_weight = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < model_->blocks.size(); ++i) {
    if (!model_->moves(i)) continue;
    largest_weight = std::max(largest_weight, weight_[i]);
    largest = std::max({largest, largest_of_right(i), row_force / std::sqrt(model_->blocks[i].area)});
  }
  has_weights_ = std::max(largest, largest_weight) > 0.0;
  // Where loads measure a static step, they measure all blocks: it counts where blocks come to rest, and that is judged by itself.
  const bool by_loads = drive.is_static && largest_weight > 0.0;
  const double least = by_loads ? largest_weight : motion_share * std::max(largest, largest_weight);
  for (double& weight : weight_) weight = by_loads && weight > 0.0 ? weight : std::max(weight, least);
  weigh_lines();
}

void BlockTerms::add_spring(std::size_t b, int axis, std::span<const double> phi, double stiffness,
                            double force) {
  const Block& block = model_->blocks[b];
  const int stride = linalg::padded_rows(2 * block.size);
  double* h = &h_[h_first_[b]];
  for (int l = 0; l < block.size; ++l) {
    b_[block.first + at(2 * l + axis)] += force * phi[at(l)];
    for (int k = 0; k < block.size; ++k)
      h[(2 * l + axis) * stride + 2 * k + axis] += stiffness * phi[at(k)] * phi[at(l)];
  }
}

void BlockTerms::add_drag(std::size_t b, double stiffness, std::span<const double> force) {
  const Block& block = model_->blocks[b];
  const int n = 2 * block.size, stride = linalg::padded_rows(n);
  double* h = &h_[h_first_[b]];
  for (int k = 0; k < n; ++k) {
    h[k * stride + k] += stiffness;
    b_[block.first + at(k)] += force[at(k)];
  }
}

void BlockTerms::add_spring(std::size_t b, Vec2 along, std::span<const double> phi, double stiffness,
                            double force) {
  const Body& body = model_->body(b);
  const int n = 2 * body.size, stride = linalg::padded_rows(n);
  double* h = &h_[h_first_[b]];
  const auto gradient = [&](int k) { return phi[at(k / 2)] * (k % 2 == 0 ? along.x : along.y); };
  for (int l = 0; l < n; ++l) {
    b_[body.first + at(l)] += force * gradient(l);
    for (int k = 0; k < n; ++k) h[l * stride + k] += stiffness * gradient(k) * gradient(l);
  }
}

void BlockTerms::add_force(std::size_t b, const double* phi, Vec2 force) {
  const Body& block = model_->body(b);
  add_at(phi, block.size, force, &b_[block.first]);
}

void BlockTerms::multiply(std::size_t i, std::span<const double> x, std::span<double> y) const {
  const std::size_t first = coefficients_[i].first, end = coefficients_[i].second;
  if (!model_->moves(i)) return std::fill(&y[first], y.data() + end, 0.0);
  with_known_size(static_cast<int>(end - first) / 2, [&](auto size) {
    multiply(size, i, &x[first],
             [&](int k, int count, Lanes rows) { store_first(&y[first + at(k)], rows, count); });
  });
}

void BlockTerms::solve_alone(std::size_t i, std::span<double> d) const {
  const Body& block = model_->body(i);
  const int n = 2 * block.size;
  std::copy_n(&b_[block.first], n, &d[block.first]);
  // A block that buckles in a static step stays where it is: its residual then shows that the step has no solution.
  if (!linalg::solve_block(n, &h_[h_first_[i]], &d[block.first])) std::fill_n(&d[block.first], n, 0.0);
}

void BlockTerms::assemble(linalg::BlockSolver& solver) const {
  solver.clear();
  team_->for_range(model_->bodies(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (model_->body(i).unknown >= 0) assemble_block(i, solver);
    }
  });
}

void BlockTerms::assemble_block(std::size_t i, linalg::BlockSolver& solver) const {
  const Body& block = model_->body(i);
  const int n = 2 * block.size, stride = linalg::padded_rows(n);
  double* diagonal = solver.diagonal(block.unknown);
  if (model_->moves(i)) {
    std::copy_n(&h_[h_first_[i]], stride * n, diagonal);
  } else {
    for (int k = 0; k < n; ++k) diagonal[k * stride + k] = 1.0;
  }
}

double BlockTerms::largest_stiffness(std::size_t i) const {
  const int n = 2 * model_->blocks[i].size, stride = linalg::padded_rows(n);
  double largest = 0.0;
  for (int k = 0; k < n; ++k) largest = std::max(largest, h_[h_first_[i] + at(k * stride + k)]);
  return largest - inertia_[i];
}

double BlockTerms::residual_ratio(std::size_t i, std::span<const double> g) const {
  if (inertia_[i] <= 0.0) return 0.0;
  double largest = 0.0;
  for (std::size_t k = coefficients_[i].first; k < coefficients_[i].second; ++k)
    largest = std::max(largest, std::abs(g[k]));
  if (largest == 0.0) return 0.0;
  return weight_[i] > 0.0 ? largest / weight_[i] : HUGE_VAL;
}

double BlockTerms::residual_ratio(std::span<const double> g) const {
  return largest_of(*team_, model_->bodies(), blocks_worth_threads,
                    [&](std::size_t i) { return residual_ratio(i, g); });
}

template <typename Size>
BlockTerms::ElasticLoss BlockTerms::block_loss(Size size, std::size_t i, const double* position,
                                               const double* d, double spin, double* turn,
                                               double* strained) const {
  const Lanes inertia = broadcast(inertia_[i]);
  double of_motion = 0.0, of_both = 0.0, of_turn = 0.0;  // dᵀ H d, dᵀ H s and sᵀ H s, without inertia
  const auto add = [](double& sum, int count, Lanes products) {
    for (int k = 0; k < count; ++k) sum += products[k];
  };
  multiply(size, i, d, [&](int first, int count, Lanes rows) {
    const Lanes x = load_first(d + first, count);
    add(of_motion, count, x * (rows - inertia * x));
  });
  in_lanes(2 * size, [&](int k, int count) { store(turn + k, turn_of(spin, position, k, count)); });
  multiply(size, i, turn, [&](int first, int count, Lanes rows) {
    const Lanes x = load_first(d + first, count), s = load_first(turn + first, count),
                force = rows - inertia * s;
    add(of_both, count, x * force);
    add(of_turn, count, s * force);
  });
  ElasticLoss loss;
  loss.damping = viscous_[i] * model_->blocks[i].elasticity.material_work(position, d);
  loss.numerical = 0.5 * (of_motion - loss.damping);
  loss.numerical += of_both - 0.5 * of_turn;
  if (rigid_[i] > 0.0) {
    // What holds the shape stores nothing.
    double held = 0.0, along = 0.0;
    for (int k = 2; k < 2 * size; ++k) {
      held += d[k] * d[k];
      along += d[k] * turn_of(1.0, position, at(k));
    }
    loss.numerical += 0.5 * rigid_[i] * (held - along * along / squared_turn(position, 2 * size));
  }
  if (is_static_) {
    for (int k = 0; k < 2 * size; ++k) strained[k] = d[k] - turn[k];
    loss.numerical -= model_->blocks[i].elasticity.beyond_second_order(position, strained);
  }
  return loss;
}

BlockTerms::ElasticLoss BlockTerms::elastic_loss(const State& state, std::span<const double> d,
                                                 std::span<const double> spin) const {
  std::vector<ElasticLoss> losses(model_->blocks.size());
  team_->for_range(losses.size(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<double> turn(at(linalg::padded_rows(2 * largest_size_))), strained(turn.size());
    for (std::size_t i = begin; i < end; ++i) {
      if (!model_->moves(i)) continue;
      const Block& block = model_->blocks[i];
      losses[i] = with_known_size(block.size, [&](auto size) {
        return block_loss(size, i, &state.position[block.first], &d[block.first], spin[i], turn.data(),
                          strained.data());
      });
    }
  });
  ElasticLoss loss;
  for (const ElasticLoss& of_block : losses) {
    loss.numerical += of_block.numerical;
    loss.damping += of_block.damping;
  }
  return loss;
}

}  // namespace keyblock::dynamics
