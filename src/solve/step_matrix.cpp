#include "solve/step_matrix.h"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "core/index.h"

namespace keyblock::dynamics {

void StepMatrix::assemble(const StepSystem& system) {
  const SpringArray& springs = system.springs();
  system.problem.terms().assemble(system.solver);
  const std::size_t n = springs.size();
  normal_stiffness_.resize(n);
  shear_stiffness_.resize(n);
  places_.resize(n);
  held_.assign(system.problem.model().bodies(), 0);
  free_.clear();
  branches_ = springs.branch;
  system.team.for_range(n, contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      normal_stiffness_[c] = springs.normal_stiffness(c, branches_[c]);
      shear_stiffness_[c] = springs.shear_stiffness(c, branches_[c]);
      places_[c] = Place(system.row(c));
    }
  });
  // By one thread: rows of several threads meet at a block.
  for (std::size_t c = 0; c < n; ++c) {
    if (has_spring(c)) count_held(system, c, 1);
  }
  system.problem.add_springs(normal_stiffness_, shear_stiffness_, system.solver);
  assemble_faces(system);
  is_assembled_ = true;
}

void StepMatrix::assemble_faces(const StepSystem& system) {
  const FaceSprings& faces = system.springs().faces;
  face_rows_.assign(faces.all_rows().begin(), faces.all_rows().end());
  face_places_.clear();
  for (const std::size_t row : face_rows_) face_places_.emplace_back(system.row(row));
  first_tangents_.assign(1, 0);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::size_t n = faces.rows_of(f).size();
    first_tangents_.push_back(first_tangents_.back() + n * n);
  }
  face_tangents_.resize(first_tangents_.back());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    faces.tangent(f, system.springs().y, tangent(f));
    add_face(system, f, 1.0);
    for (const std::size_t row : faces.rows_of(f)) count_held(system, row, 1);
  }
}

/// The face as the matrix has it.
void StepMatrix::add_face(const StepSystem& system, std::size_t f, double scale) const {
  const std::span<const std::size_t> rows = system.springs().faces.rows_of(f);
  const auto first = static_cast<std::size_t>(rows.data() - system.springs().faces.all_rows().data());
  system.problem.add_face(rows, std::span(face_places_).subspan(first, rows.size()), tangent(f), scale,
                          system.solver);
}

/// Brings the faces to how they press now. Whether that changed the matrix.
bool StepMatrix::update_faces(const StepSystem& system) {
  const FaceSprings& faces = system.springs().faces;
  bool any = false;
  std::vector<double> now;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    now.resize(tangent(f).size());
    faces.tangent(f, system.springs().y, now);
    if (std::ranges::equal(now, tangent(f))) continue;
    any = true;
    // Taken away at the places that it was added at: in a matrix of an earlier step they are not those of now.
    add_face(system, f, -1.0);
    std::ranges::copy(now, tangent(f).begin());
    const std::span<const std::size_t> rows = faces.rows_of(f);
    const auto first = static_cast<std::size_t>(rows.data() - faces.all_rows().data());
    for (std::size_t i = 0; i < rows.size(); ++i) face_places_[first + i] = Place(system.row(rows[i]));
    add_face(system, f, 1.0);
    const Row& row = system.row(rows.front());
    if (row.unknown_a >= 0) system.solver.touch(row.unknown_a);
    if (row.unknown_b >= 0) system.solver.touch(row.unknown_b);
  }
  return any;
}

bool StepMatrix::has_faces_as_they_press(const SpringArray& springs) const {
  std::vector<double> now;
  for (std::size_t f = 0; f < springs.faces.size(); ++f) {
    now.resize(tangent(f).size());
    springs.faces.tangent(f, springs.y, now);
    if (!std::ranges::equal(now, tangent(f))) return false;
  }
  return true;
}

std::vector<double> StepMatrix::face_lines(const SpringArray& springs, std::span<const double> y) const {
  std::vector<double> lines;
  if (springs.faces.empty()) return lines;
  lines.assign(springs.size(), 0.0);
  for (std::size_t f = 0; f < springs.faces.size(); ++f) {
    const std::span<const std::size_t> rows = springs.faces.rows_of(f);
    const std::span<const double> h = tangent(f);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < rows.size(); ++j) lines[rows[i]] += h[i * rows.size() + j] * y[rows[j]];
    }
  }
  return lines;
}

bool StepMatrix::has_faces(const FaceSprings& faces) const {
  if (!std::ranges::equal(face_rows_, faces.all_rows()) || first_tangents_.size() != faces.size() + 1)
    return face_rows_.empty() && faces.empty();
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::size_t n = faces.rows_of(f).size();
    if (first_tangents_[f + 1] - first_tangents_[f] != n * n) return false;
  }
  return true;
}

bool StepMatrix::update(const StepSystem& system) {
  const SpringArray& springs = system.springs();
  // What nothing touches was solved for alone, as it lies now; the matrix still has it as it lay when it was assembled.
  const bool turned = !free_.empty();
  for (const std::size_t b : free_) {
    system.problem.terms().assemble_block(b, system.solver);
    system.solver.touch(system.problem.points().body(b).unknown);
  }
  free_.clear();
  changes_.clear();
  find_differing(system);
  for (const std::size_t c : differing_) {
    const Branch from = std::exchange(branches_[c], springs.branch[c]), to = branches_[c];
    if (from.same_springs(to)) continue;
    const bool had_spring = has_spring(c);
    const double normal = springs.normal_stiffness(c, to), shear = springs.shear_stiffness(c, to),
                 normal_before = std::exchange(normal_stiffness_[c], normal),
                 shear_before = std::exchange(shear_stiffness_[c], shear);
    // A spring without stiffness, as along a joint without friction, changes nothing by coming or going.
    if (normal == normal_before && shear == shear_before) continue;
    const Place now(system.row(c)), before = std::exchange(places_[c], now);
    if (now == before) {
      changes_.push_back({c, now, normal - normal_before, shear - shear_before});
    } else {
      // Of an earlier step: what it has there is taken away as it was, or the matrix would not stay positive definite.
      changes_.push_back({c, before, -normal_before, -shear_before});
      changes_.push_back({c, now, normal, shear});
    }
    count_held(system, c, static_cast<int>(has_spring(c)) - static_cast<int>(had_spring));
    const Row& row = system.row(c);
    if (row.unknown_a >= 0) system.solver.touch(row.unknown_a);
    if (row.unknown_b >= 0) system.solver.touch(row.unknown_b);
  }
  system.problem.add_springs(changes_, system.solver);
  const bool faces_changed = update_faces(system);
  return turned || faces_changed || !changes_.empty();
}

void StepMatrix::find_differing(const StepSystem& system) {
  // Most iterations change a few rows of thousands: groups that have not changed are passed over by their bytes.
  constexpr std::size_t group = 32;
  const SpringArray& springs = system.springs();
  const auto any_differs_from = [&](std::size_t c) {
    return std::memcmp(&springs.branch[c], &branches_[c],
                       std::min(group, branches_.size() - c) * sizeof(Branch)) != 0;
  };
  const auto differs = [&](std::size_t c) { return springs.branch[c] != branches_[c]; };
  find_few<group>(system.team, springs.size(), contacts_worth_threads, any_differs_from, differs, differing_);
}

std::size_t StepMatrix::count_differing(const SpringArray& springs) const {
  std::size_t count = 0;
  for (std::size_t c = 0; c < springs.size(); ++c) count += springs.branch[c] != branches_[c] ? 1 : 0;
  return count;
}

void StepMatrix::take_branches_with_the_same_springs(const StepSystem& system) {
  const SpringArray& springs = system.springs();
  system.team.for_range(springs.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      if (branches_[c].same_springs(springs.branch[c])) branches_[c] = springs.branch[c];
    }
  });
}

void StepMatrix::carry(std::span<const std::size_t> now, std::size_t gone, std::size_t rows) {
  const auto carry_one = [&](auto& of_row) {
    std::remove_reference_t<decltype(of_row)> carried(rows);
    for (std::size_t k = 0; k < now.size(); ++k) {
      if (now[k] != gone) carried[now[k]] = of_row[k];
    }
    of_row = std::move(carried);
  };
  carry_one(branches_);
  carry_one(normal_stiffness_);
  carry_one(shear_stiffness_);
  carry_one(places_);
  for (std::size_t& row : face_rows_) row = now[row];
}

void StepMatrix::find_free_blocks(const StepSystem& system, std::span<const std::size_t> updated) {
  // Rows that are added beside the factor hold their blocks as those in it do.
  for (const std::size_t c : updated) count_held(system, c, 1);
  free_.clear();
  for (std::size_t b = 0; b < held_.size(); ++b) {
    if (system.problem.model().moves(b) && held_[at(system.problem.points().body(b).unknown)] == 0)
      free_.push_back(b);
  }
  for (const std::size_t c : updated) count_held(system, c, -1);
}

void StepMatrix::take_hold(const StepProblem& problem, const Row& row) {
  std::erase_if(free_, [&](std::size_t b) {
    return problem.points().body(b).unknown == row.unknown_a ||
           problem.points().body(b).unknown == row.unknown_b;
  });
}

/// Counts what holds the blocks of a row.
void StepMatrix::count_held(const StepSystem& system, std::size_t c, int count) {
  const Row& row = system.row(c);
  if (row.unknown_a >= 0) held_[at(row.unknown_a)] += count;
  if (row.unknown_b >= 0) held_[at(row.unknown_b)] += count;
}

}  // namespace keyblock::dynamics
