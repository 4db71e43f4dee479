#include "block/elasticity.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/index.h"
#include "core/known_size.h"

namespace keyblock::block {

Stress in_situ_at(const std::optional<InSituStress>& in_situ, Vec2 point) {
  if (!in_situ) return {};
  const double height = point.y - in_situ->reference_y;
  return {in_situ->sxx + in_situ->sxx_gradient * height, in_situ->syy + in_situ->syy_gradient * height,
          in_situ->sxy};
}

Elasticity::Elasticity(const Polygon& region, const Basis& basis, const Material& material,
                       const std::optional<InSituStress>& in_situ)
    : size_(basis.size()), in_situ_(in_situ) {
  const double e = material.young, nu = material.poisson;
  if (material.state == PlaneState::plane_stress) {
    c11_ = e / (1.0 - nu * nu);
    c12_ = nu * c11_;
  } else {
    c11_ = e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    c12_ = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  }
  c33_ = e / (2.0 * (1.0 + nu));
  // A linear S₀ times the quadratic E has degree 2(n − 1) + 1, above 4(n − 1) only at n = 1.
  const int degree = std::max(4 * (basis.order() - 1), in_situ ? 2 * (basis.order() - 1) + 1 : 0);
  for (const WeightedPoint& w : thinned_rule(polygon_rule(region, degree), degree)) {
    points_.push_back({w.weight, in_situ_at(in_situ, w.point)});
    gradient_.resize(gradient_.size() + static_cast<std::size_t>(size_));
    basis.gradients(w.point, gradient_.data() + gradient_.size() - size_);
  }
}

template <typename Do>
void Elasticity::at_points(const Do& what) const {
  with_known_size(size_, [&](auto size) {
    for (std::size_t q = 0; q < points_.size(); ++q) what(size, points_[q], &gradient_[q * at(size)]);
  });
}

template <typename Size>
Elasticity::Gradient2 Elasticity::deformation(Size size, const double* a, const Vec2* gradients) {
  Gradient2 f{0.0, 0.0, 0.0, 0.0};
  for (int k = 1; k < size; ++k) {
    f.xx += a[2 * k] * gradients[k].x;
    f.xy += a[2 * k] * gradients[k].y;
    f.yx += a[2 * k + 1] * gradients[k].x;
    f.yy += a[2 * k + 1] * gradients[k].y;
  }
  return f;
}

Stress Elasticity::second_piola(const Gradient2& f, const Stress& initial) const {
  const double exx = 0.5 * (f.xx * f.xx + f.yx * f.yx - 1.0);
  const double eyy = 0.5 * (f.xy * f.xy + f.yy * f.yy - 1.0);
  const double two_exy = f.xx * f.xy + f.yx * f.yy;
  return {initial.xx + c11_ * exx + c12_ * eyy, initial.yy + c12_ * exx + c11_ * eyy,
          initial.xy + c33_ * two_exy};
}

double Elasticity::density(const Gradient2& f, const Stress& initial) const {
  const Stress s = second_piola(f, initial);
  const double exx = 0.5 * (f.xx * f.xx + f.yx * f.yx - 1.0);
  const double eyy = 0.5 * (f.xy * f.xy + f.yy * f.yy - 1.0);
  const double two_exy = f.xx * f.xy + f.yx * f.yy;
  return 0.5 * ((s.xx + initial.xx) * exx + (s.yy + initial.yy) * eyy + (s.xy + initial.xy) * two_exy);
}

double Elasticity::energy(const double* a) const {
  double sum = 0.0;
  at_points([&](auto size, const Point& point, const Vec2* g) {
    sum += point.weight * density(deformation(size, a, g), point.initial);
  });
  return sum;
}

void Elasticity::add_force(const double* a, double* force) const {
  at_points([&](auto size, const Point& point, const Vec2* g) {
    const Gradient2 f = deformation(size, a, g);
    const Stress s = second_piola(f, point.initial);
    // P = F S
    const double w = point.weight;
    const double pxx = w * (f.xx * s.xx + f.xy * s.xy), pxy = w * (f.xx * s.xy + f.xy * s.yy);
    const double pyx = w * (f.yx * s.xx + f.yy * s.xy), pyy = w * (f.yx * s.xy + f.yy * s.yy);
    for (int k = 1; k < size; ++k) {
      force[2 * k] += pxx * g[k].x + pxy * g[k].y;
      force[2 * k + 1] += pyx * g[k].x + pyy * g[k].y;
    }
  });
}

namespace {

/// Whether g + shift · 1 has a Cholesky factor.
bool is_positive_definite(const double* g, int n, double shift) {
  std::vector<double> a(g, g + n * n);
  for (int j = 0; j < n; ++j) {
    double* column = &a[static_cast<std::size_t>(j * n)];
    const double pivot = column[j] + shift;
    if (!(pivot > 0.0)) return false;
    for (int q = j + 1; q < n; ++q) {
      const double factor = column[q] / pivot;
      for (int r = q; r < n; ++r) a[static_cast<std::size_t>(q * n + r)] -= factor * column[r];
    }
  }
  return true;
}

/// Raises the eigenvalues of a symmetric 2 × 2 matrix (lower triangle, by columns) to at least −floor.
void floor_eigenvalues(double* g, double floor) {
  const double mean = 0.5 * (g[0] + g[3]), half = 0.5 * (g[0] - g[3]);
  const double radius = std::sqrt(half * half + g[1] * g[1]);
  if (mean - radius >= -floor) return;
  const double high = std::max(mean + radius, -floor);
  // What differs from a multiple of 1 keeps its directions.
  const double scale = radius > 0.0 ? 0.5 * (high + floor) / radius : 0.0, middle = 0.5 * (high - floor);
  g[0] = middle + scale * half;
  g[3] = middle - scale * half;
  g[1] *= scale;
}

/// Raises the eigenvalues of a symmetric n × n matrix (lower triangle, by columns) to at least −floor; does nothing when a
/// bound shows that none is below.
void floor_eigenvalues(double* g, int n, double floor) {
  const auto entry = [&](int r, int c) -> double& { return g[r >= c ? c * n + r : r * n + c]; };
  double bound = 0.0;
  for (int i = 0; i < n; ++i) {
    double others = 0.0;
    for (int k = 0; k < n; ++k) others += k == i ? 0.0 : std::abs(entry(i, k));
    bound = std::max(bound, others - entry(i, i));
  }
  if (bound <= floor || is_positive_definite(g, n, floor)) return;
  Eigen::MatrixXd whole(n, n);
  for (int c = 0; c < n; ++c) {
    for (int r = 0; r < n; ++r) whole(r, c) = entry(r, c);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(whole);
  if (solver.eigenvalues().minCoeff() >= -floor) return;
  const Eigen::VectorXd raised = solver.eigenvalues().cwiseMax(-floor);
  whole = solver.eigenvectors() * raised.asDiagonal() * solver.eigenvectors().transpose();
  for (int c = 0; c < n; ++c) {
    for (int r = c; r < n; ++r) entry(r, c) = whole(r, c);
  }
}

}  // namespace

void Elasticity::add_tangent(const double* a, double viscous, double floor, double* tangent,
                             int stride) const {
  // Order 1 has room here; higher orders are worth an allocation.
  constexpr std::size_t few = 3;
  const std::size_t count = at(size_), m = count - 1;
  std::array<std::array<double, 6>, few> few_b;
  std::array<double, (few - 1) * (few - 1)> few_geometric{};
  std::vector<std::array<double, 6>> many_b(count > few ? count : 0);
  std::vector<double> many_geometric(count > few ? m * m : 0, 0.0);
  std::array<double, 6>* b =
      count > few ? many_b.data() : few_b.data();  // B_k, columns x and y of three rows
  double* geometric = count > few ? many_geometric.data() : few_geometric.data();  // (N − 1)², lower triangle
  at_points([&](auto size, const Point& point, const Vec2* g) {
    const Gradient2 f = deformation(size, a, g);
    const Stress s = second_piola(f, point.initial);
    const double weight = (1.0 + viscous) * point.weight;
    for (int k = 1; k < size; ++k) {
      b[k] = {f.xx * g[k].x, f.xy * g[k].y, f.xx * g[k].y + f.xy * g[k].x,
              f.yx * g[k].x, f.yy * g[k].y, f.yx * g[k].y + f.yy * g[k].x};
    }
    for (int l = 1; l < size; ++l) {
      const Vec2 sg{point.weight * (s.xx * g[l].x + s.xy * g[l].y),
                    point.weight * (s.xy * g[l].x + s.yy * g[l].y)};
      const auto& bl = b[l];
      std::array<double, 6> cb;
      for (std::size_t c = 0; c < 6; c += 3) {
        cb[c] = weight * (c11_ * bl[c] + c12_ * bl[c + 1]);
        cb[c + 1] = weight * (c12_ * bl[c] + c11_ * bl[c + 1]);
        cb[c + 2] = weight * c33_ * bl[c + 2];
      }
      double* column_x = tangent + static_cast<std::ptrdiff_t>(2 * l) * stride;
      double* column_y = column_x + stride;
      for (int k = l; k < size; ++k) {
        const auto& bk = b[k];
        geometric[(l - 1) * (size - 1) + k - 1] += dot(g[k], sg);
        column_x[2 * k] += bk[0] * cb[0] + bk[1] * cb[1] + bk[2] * cb[2];
        column_x[2 * k + 1] += bk[3] * cb[0] + bk[4] * cb[1] + bk[5] * cb[2];
        column_y[2 * k + 1] += bk[3] * cb[3] + bk[4] * cb[4] + bk[5] * cb[5];
        if (k > l) column_y[2 * k] += bk[0] * cb[3] + bk[1] * cb[4] + bk[2] * cb[5];
      }
    }
  });
  if (m == 2) {
    floor_eigenvalues(geometric, floor);
  } else {
    floor_eigenvalues(geometric, size_ - 1, floor);
  }
  with_known_size(size_, [&](auto size) {
    for (int l = 1; l < size; ++l) {
      for (int k = l; k < size; ++k) {
        const double value = geometric[(l - 1) * (size - 1) + k - 1];
        tangent[static_cast<std::ptrdiff_t>(2 * l) * stride + 2 * k] += value;
        tangent[static_cast<std::ptrdiff_t>(2 * l + 1) * stride + 2 * k + 1] += value;
      }
    }
  });
}

double Elasticity::material_work(const double* a, const double* d) const {
  double sum = 0.0;
  at_points([&](auto size, const Point& point, const Vec2* g) {
    const Gradient2 f = deformation(size, a, g), h = deformation(size, d, g);
    const double xx = f.xx * h.xx + f.yx * h.yx, yy = f.xy * h.xy + f.yy * h.yy;
    const double two_xy = f.xx * h.xy + f.xy * h.xx + f.yx * h.yy + f.yy * h.yx;
    sum += point.weight * (c11_ * (xx * xx + yy * yy) + 2.0 * c12_ * xx * yy + c33_ * two_xy * two_xy);
  });
  return sum;
}

double Elasticity::squared_stress(const double* a, const double* b) const {
  double sum = 0.0;
  at_points([&](auto size, const Point& point, const Vec2* g) {
    Stress s = second_piola(deformation(size, a, g), point.initial);
    if (b != nullptr) {
      const Stress other = second_piola(deformation(size, b, g), point.initial);
      s = {s.xx - other.xx, s.yy - other.yy, s.xy - other.xy};
    }
    sum += point.weight * (s.xx * s.xx + s.yy * s.yy + 2.0 * s.xy * s.xy);
  });
  return sum;
}

namespace {
Stress push_forward(double fxx, double fxy, double fyx, double fyy, const Stress& s) {
  const double j = fxx * fyy - fxy * fyx;
  const double pxx = fxx * s.xx + fxy * s.xy, pxy = fxx * s.xy + fxy * s.yy;
  const double pyx = fyx * s.xx + fyy * s.xy, pyy = fyx * s.xy + fyy * s.yy;
  return {(pxx * fxx + pxy * fxy) / j, (pyx * fyx + pyy * fyy) / j, (pxx * fyx + pxy * fyy) / j};
}
}  // namespace

Stress Elasticity::cauchy(const double* a, const Basis& basis, Vec2 point) const {
  std::vector<Vec2> g(static_cast<std::size_t>(size_));
  basis.gradients(point, g.data());
  const Gradient2 f = deformation(size_, a, g.data());
  return push_forward(f.xx, f.xy, f.yx, f.yy, second_piola(f, in_situ_at(in_situ_, point)));
}

Stress Elasticity::mean_cauchy(const double* a) const {
  Stress mean;
  double total = 0.0;
  at_points([&](auto size, const Point& point, const Vec2* g) {
    const Gradient2 f = deformation(size, a, g);
    const Stress s = push_forward(f.xx, f.xy, f.yx, f.yy, second_piola(f, point.initial));
    mean.xx += point.weight * s.xx;
    mean.yy += point.weight * s.yy;
    mean.xy += point.weight * s.xy;
    total += point.weight;
  });
  return {mean.xx / total, mean.yy / total, mean.xy / total};
}

}  // namespace keyblock::block
