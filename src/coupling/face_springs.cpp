#include "coupling/face_springs.h"

#include <algorithm>
#include <array>

namespace keyblock::dynamics {

namespace {

using Numbers = std::array<double, contact::JointPressure::most_points>;

std::span<double> gather(std::span<const std::size_t> rows, std::span<const double> of_rows, Numbers& into) {
  for (std::size_t i = 0; i < rows.size(); ++i) into[i] = of_rows[rows[i]];
  return std::span(into).first(rows.size());
}

std::span<double> gather(std::span<const std::size_t> rows, std::span<const double> y,
                         std::span<const double> dy, double alpha, Numbers& into) {
  for (std::size_t i = 0; i < rows.size(); ++i) into[i] = y[rows[i]] + alpha * dy[rows[i]];
  return std::span(into).first(rows.size());
}

}  // namespace

void FaceSprings::begin(std::size_t rows) {
  faces_.clear();
  rows_.clear();
  next_of_row_.clear();
  first_of_row_.assign(rows, -1);
  force_.assign(rows + lane_count, 0.0);
  bearing_.assign(rows + lane_count, 0.0);
  stiffness_.assign(rows, 0.0);
  elastic_share_.assign(rows, 1.0);
}

void FaceSprings::add(const contact::JointPressure& pressure, double dashpot,
                      std::span<const std::size_t> rows) {
  faces_.push_back({rows_.size(), pressure.stiffer(1.0 + dashpot), dashpot});
  rows_.insert(rows_.end(), rows.begin(), rows.end());
  next_of_row_.push_back(first_of_row_[rows.front()]);
  first_of_row_[rows.front()] = static_cast<int>(faces_.size()) - 1;
  for (const std::size_t row : rows) {
    stiffness_[row] += faces_.back().pressure.stiffness() / static_cast<double>(rows.size());
    elastic_share_[row] = 1.0 / (1.0 + dashpot);
  }
}

void FaceSprings::press(std::span<const double> y) {
  if (empty()) return;
  std::ranges::fill(force_, 0.0);
  std::ranges::fill(bearing_, 0.0);
  Numbers closure, pressed, borne;
  for (std::size_t f = 0; f < size(); ++f) {
    const std::span<const std::size_t> rows = rows_of(f);
    const std::span<double> force = std::span(pressed).first(rows.size());
    std::span<double> bearing = std::span(borne).first(rows.size());
    if (rows.size() > 2) {
      faces_[f].pressure.forces(gather(rows, y, closure), force, bearing);
    } else {
      faces_[f].pressure.forces(gather(rows, y, closure), force);
      bearing = force;  // between two ends they are the same
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      force_[rows[i]] += force[i];
      bearing_[rows[i]] += bearing[i];
    }
  }
}

void FaceSprings::pull_no_more(std::size_t row) {
  for (std::size_t f = 0; f < size(); ++f) {
    if (faces_[f].pressure.pulls() && std::ranges::count(rows_of(f), row) > 0)
      faces_[f].pressure.pull_no_more();
  }
}

void FaceSprings::forces_at(std::size_t f, std::span<const double> y, std::span<const double> dy,
                            double alpha, std::span<double> force) const {
  Numbers closure;
  faces_[f].pressure.forces(gather(rows_of(f), y, dy, alpha, closure), force);
}

void FaceSprings::tangent(std::size_t f, std::span<const double> y, std::span<double> h) const {
  Numbers closure;
  faces_[f].pressure.tangent(gather(rows_of(f), y, closure), h);
}

bool FaceSprings::is_linear(std::size_t f, std::span<const double> y, std::span<const double> dy,
                            double alpha) const {
  Numbers here, there;
  return faces_[f].pressure.is_linear_between(gather(rows_of(f), y, here),
                                              gather(rows_of(f), y, dy, alpha, there));
}

void FaceBend::find(const FaceSprings& faces, std::span<const double> y, std::span<const double> dy,
                    double alpha, Forces& beside) const {
  const std::span<const std::size_t> rows = faces.rows_of(face_);
  const std::size_t n = rows.size();
  Numbers before;
  std::vector<double> h(n * n);
  faces.forces_at(face_, y, dy, alpha, std::span(beside).first(n));
  faces.forces_at(face_, y, dy, 0.0, std::span(before).first(n));
  faces.tangent(face_, y, h);
  for (std::size_t i = 0; i < n; ++i) {
    double line = before[i];
    for (std::size_t j = 0; j < n; ++j) line += alpha * h[i * n + j] * dy[rows[j]];
    beside[i] -= line;
  }
}

double FaceBend::slope(const FaceSprings& faces, std::span<const double> y, std::span<const double> dy,
                       double alpha) const {
  double sum = 0.0;
  for_rows(faces, y, dy, alpha, [&](std::size_t row, double beside) { sum += beside * dy[row]; });
  return sum;
}

}  // namespace keyblock::dynamics
