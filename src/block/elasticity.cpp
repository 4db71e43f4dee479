#include "block/elasticity.h"

#include <cmath>
#include <type_traits>

#include "core/index.h"
#include "core/known_size.h"
#include "geometry/compact_rule.h"

namespace keyblock::block {

Stress in_situ_at(const std::optional<InSituStress>& in_situ, Vec2 point) {
  if (!in_situ) return {};
  const double height = point.y - in_situ->reference_y;
  return {in_situ->sxx + in_situ->sxx_gradient * height, in_situ->syy + in_situ->syy_gradient * height,
          in_situ->sxy};
}

namespace {

double add_up(double x) {
  return x;
}
double add_up(Lanes x) {
  return sum(x);
}

}  // namespace

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
  const std::vector<WeightedPoint> rule = compact_rule(region, degree);
  std::vector<Vec2> gradients(at(size_));
  if (basis.order() == 1) {  // the centroid alone
    basis.gradients(rule[0].point, gradients.data());
    point_ = {rule[0].weight, in_situ_at(in_situ, rule[0].point)};
    for (std::size_t k = 0; k < gradient_.size(); ++k) gradient_[k] = {gradients[k].x, gradients[k].y};
    return;
  }
  constexpr std::size_t width = lane_count;
  const std::size_t groups = (rule.size() + width - 1) / width;
  points_.resize(groups);
  gradients_.resize(groups * at(size_));
  for (std::size_t q = 0; q < groups * width; ++q) {
    const WeightedPoint& w = rule[std::min(q, rule.size() - 1)];
    const Stress initial = in_situ_at(in_situ, w.point);
    const std::size_t group = q / width, lane = q % width;
    Point<Lanes>& point = points_[group];
    point.weight[lane] = q < rule.size() ? w.weight : 0.0;
    point.initial.xx[lane] = initial.xx;
    point.initial.yy[lane] = initial.yy;
    point.initial.xy[lane] = initial.xy;
    basis.gradients(w.point, gradients.data());
    for (std::size_t k = 0; k < at(size_); ++k) {
      gradients_[group * at(size_) + k].x[lane] = gradients[k].x;
      gradients_[group * at(size_) + k].y[lane] = gradients[k].y;
    }
  }
}

template <typename Do>
void Elasticity::with_points(const Do& what) const {
  with_known_size(size_, [&](auto size) {
    if constexpr (std::is_same_v<decltype(size), std::integral_constant<int, 3>>) {
      what(size, std::span<const Point<double>>(&point_, 1), gradient_.data());
    } else {
      what(size, std::span<const Point<Lanes>>(points_), gradients_.data());
    }
  });
}

template <typename Value>
double Elasticity::sum_over_points(const Value& value) const {
  double total = 0.0;
  with_points([&](auto size, auto points, const auto* gradients) {
    for (std::size_t q = 0; q < points.size(); ++q)
      total += add_up(value(size, points[q], gradients + q * at(size)));
  });
  return total;
}

template <typename Number, typename Size>
Elasticity::Deformation<Number> Elasticity::deformation(Size size, const double* a,
                                                        const Gradient<Number>* gradients) {
  Deformation<Number> f;
  for (int k = 1; k < size; ++k) {
    f.xx += a[2 * k] * gradients[k].x;
    f.xy += a[2 * k] * gradients[k].y;
    f.yx += a[2 * k + 1] * gradients[k].x;
    f.yy += a[2 * k + 1] * gradients[k].y;
  }
  return f;
}

namespace {

/// Green's strain, with twice its shear.
template <typename Deformation>
auto strain(const Deformation& f) {
  const auto exx = 0.5 * (f.xx * f.xx + f.yx * f.yx - 1.0), eyy = 0.5 * (f.xy * f.xy + f.yy * f.yy - 1.0),
             two_exy = f.xx * f.xy + f.yx * f.yy;
  return SymmetricTensor<std::remove_const_t<decltype(exx)>>{exx, eyy, two_exy};
}

/// F S Fᵀ / det F
template <typename Deformation, typename Tensor>
Tensor push_forward(const Deformation& f, const Tensor& s) {
  const auto j = f.xx * f.yy - f.xy * f.yx;
  const auto pxx = f.xx * s.xx + f.xy * s.xy, pxy = f.xx * s.xy + f.xy * s.yy;
  const auto pyx = f.yx * s.xx + f.yy * s.xy, pyy = f.yx * s.xy + f.yy * s.yy;
  return {(pxx * f.xx + pxy * f.xy) / j, (pyx * f.yx + pyy * f.yy) / j, (pxx * f.yx + pxy * f.yy) / j};
}

}  // namespace

template <typename Number>
SymmetricTensor<Number> Elasticity::second_piola(const Deformation<Number>& f,
                                                 const SymmetricTensor<Number>& initial) const {
  const SymmetricTensor<Number> e = strain(f);
  return {initial.xx + c11_ * e.xx + c12_ * e.yy, initial.yy + c12_ * e.xx + c11_ * e.yy,
          initial.xy + c33_ * e.xy};
}

double Elasticity::energy(const double* a) const {
  return sum_over_points([&](auto size, const auto& point, const auto* g) {
    const auto f = deformation(size, a, g);
    const auto e = strain(f), s = second_piola(f, point.initial);
    const auto& initial = point.initial;
    return point.weight *
           (0.5 * ((s.xx + initial.xx) * e.xx + (s.yy + initial.yy) * e.yy + (s.xy + initial.xy) * e.xy));
  });
}

/// Keeps at all points what the tangent is made of: B_k, then B_{k + 1}.
template <typename Number, typename Size>
void Elasticity::add_force(Size size, std::span<const Point<Number>> points,
                           const Gradient<Number>* gradients, const double* a, double viscous, double* force,
                           Columns<Number>* b, Stressed<Number>* stressed) const {
  const std::size_t count = points.size();
  for (std::size_t q = 0; q < count; ++q) {
    const Gradient<Number>* g = gradients + q * at(size);
    const Deformation<Number> f = deformation(size, a, g);
    const SymmetricTensor<Number> s = second_piola(f, points[q].initial);
    const Number w = points[q].weight;
    stressed[q] = {{w * s.xx, w * s.yy, w * s.xy}, (1.0 + viscous) * w};
    // P = F S
    const Number pxx = w * (f.xx * s.xx + f.xy * s.xy), pxy = w * (f.xx * s.xy + f.xy * s.yy);
    const Number pyx = w * (f.yx * s.xx + f.yy * s.xy), pyy = w * (f.yx * s.xy + f.yy * s.yy);
    for (int k = 1; k < size; ++k) {
      force[2 * k] += add_up(pxx * g[k].x + pxy * g[k].y);
      force[2 * k + 1] += add_up(pyx * g[k].x + pyy * g[k].y);
      b[at(k) * count + q] = {{f.xx * g[k].x, f.xy * g[k].y, f.xx * g[k].y + f.xy * g[k].x},
                              {f.yx * g[k].x, f.yy * g[k].y, f.yx * g[k].y + f.yy * g[k].x}};
    }
  }
}

/// cb: room for C B_l at all points, weighted.
template <typename Number, typename Size>
void Elasticity::write_tangent(Size size, std::span<const Stressed<Number>> stressed,
                               const Gradient<Number>* gradients, const Columns<Number>* b,
                               Columns<Number>* cb, double* tangent, int stride, double* geometric) const {
  const std::size_t count = stressed.size();
  const auto times = [](const Number(&x)[3], const Number(&y)[3]) {
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
  };
  for (int l = 1; l < size; ++l) {
    for (std::size_t q = 0; q < count; ++q) {
      const Number w = stressed[q].weight;
      const auto elastic = [&](const Number(&from)[3], Number(&to)[3]) {
        to[0] = w * (c11_ * from[0] + c12_ * from[1]);
        to[1] = w * (c12_ * from[0] + c11_ * from[1]);
        to[2] = w * (c33_ * from[2]);
      };
      elastic(b[at(l) * count + q].x, cb[q].x);
      elastic(b[at(l) * count + q].y, cb[q].y);
    }
    double* column_x = tangent + static_cast<std::ptrdiff_t>(2 * l) * stride;
    double* column_y = column_x + stride;
    for (int k = l; k < size; ++k) {
      Number xx{}, yx{}, xy{}, yy{}, g{};
      for (std::size_t q = 0; q < count; ++q) {
        const Columns<Number>&row = b[at(k) * count + q], &column = cb[q];
        const Gradient<Number>&at_k = gradients[q * at(size) + at(k)],
              &at_l = gradients[q * at(size) + at(l)];
        const SymmetricTensor<Number>& s = stressed[q].stress;
        xx += times(row.x, column.x);
        yx += times(row.y, column.x);
        xy += times(row.x, column.y);
        yy += times(row.y, column.y);
        g += at_k.x * (s.xx * at_l.x + s.xy * at_l.y) + at_k.y * (s.xy * at_l.x + s.yy * at_l.y);
      }
      column_x[2 * k] = add_up(xx);
      column_x[2 * k + 1] = add_up(yx);
      column_y[2 * k + 1] = add_up(yy);
      if (k > l) column_y[2 * k] = add_up(xy);
      geometric[(l - 1) * (size - 1) + k - 1] = add_up(g);
    }
  }
}

void Elasticity::add_force_and_material_tangent(const double* a, double viscous, double* force,
                                                double* tangent, int stride, double* geometric) const {
  with_points([&]<typename Number>(auto size, std::span<const Point<Number>> points,
                                   const Gradient<Number>* gradients) {
    // Orders 1 and 2 have room here; higher ones are worth an allocation.
    constexpr std::size_t few_groups = 2, few = few_groups * 6;
    const std::size_t count = points.size();
    std::array<Columns<Number>, few> few_b;
    std::array<Columns<Number>, few_groups> few_cb;
    std::array<Stressed<Number>, few_groups> few_stressed;
    const bool is_small = count <= few_groups && at(size) * count <= few;
    std::vector<Columns<Number>> many(is_small ? 0 : (at(size) + 1) * count);
    std::vector<Stressed<Number>> many_stressed(is_small ? 0 : count);
    Columns<Number>* b = is_small ? few_b.data() : many.data();
    Columns<Number>* cb = is_small ? few_cb.data() : many.data() + at(size) * count;
    Stressed<Number>* stressed = is_small ? few_stressed.data() : many_stressed.data();
    add_force(size, points, gradients, a, viscous, force, b, stressed);
    write_tangent(size, std::span<const Stressed<Number>>(stressed, count), gradients, b, cb, tangent, stride,
                  geometric);
  });
}

void Elasticity::add_geometric_tangent(const double* geometric, double* tangent, int stride) const {
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

double Elasticity::beyond_second_order(const double* a, const double* d) const {
  std::vector<double> moved(2 * static_cast<std::size_t>(size_));
  const double start = energy(a);
  const auto change_at = [&](double share) {
    for (std::size_t k = 0; k < moved.size(); ++k) moved[k] = a[k] + share * d[k];
    return energy(moved.data()) - start;
  };
  const double before = change_at(-1.0), half_before = change_at(-0.5), half = change_at(0.5),
               end = change_at(1.0);
  // Even and odd parts: of ½ k t² + q t⁴ at 1 and ½, and of f t + c t³.
  const double even = 0.5 * (end + before), half_even = 0.5 * (half + half_before),
               odd = 0.5 * (end - before), half_odd = 0.5 * (half - half_before);
  return 4.0 / 3.0 * ((even - 4.0 * half_even) + (odd - 2.0 * half_odd));
}

double Elasticity::material_work(const double* a, const double* d) const {
  return sum_over_points([&](auto size, const auto& point, const auto* g) {
    const auto f = deformation(size, a, g), h = deformation(size, d, g);
    const auto xx = f.xx * h.xx + f.yx * h.yx, yy = f.xy * h.xy + f.yy * h.yy;
    const auto two_xy = f.xx * h.xy + f.xy * h.xx + f.yx * h.yy + f.yy * h.yx;
    return point.weight * (c11_ * (xx * xx + yy * yy) + 2.0 * c12_ * xx * yy + c33_ * two_xy * two_xy);
  });
}

double Elasticity::squared_stress(const double* a, const double* b) const {
  return sum_over_points([&](auto size, const auto& point, const auto* g) {
    auto s = second_piola(deformation(size, a, g), point.initial);
    if (b != nullptr) {
      const auto other = second_piola(deformation(size, b, g), point.initial);
      s = {s.xx - other.xx, s.yy - other.yy, s.xy - other.xy};
    }
    return point.weight * (s.xx * s.xx + s.yy * s.yy + 2.0 * s.xy * s.xy);
  });
}

Stress Elasticity::cauchy(const double* a, const Basis& basis, Vec2 point) const {
  std::vector<Vec2> g(at(size_));
  basis.gradients(point, g.data());
  std::vector<Gradient<double>> gradients;
  for (const Vec2 v : g) gradients.push_back({v.x, v.y});
  const Deformation<double> f = deformation(size_, a, gradients.data());
  return push_forward(f, second_piola(f, in_situ_at(in_situ_, point)));
}

Stress Elasticity::mean_cauchy(const double* a) const {
  Stress mean;
  double total = 0.0;
  with_points([&](auto size, auto points, const auto* gradients) {
    for (std::size_t q = 0; q < points.size(); ++q) {
      const auto f = deformation(size, a, gradients + q * at(size));
      const auto s = push_forward(f, second_piola(f, points[q].initial));
      const auto w = points[q].weight;
      mean.xx += add_up(w * s.xx);
      mean.yy += add_up(w * s.yy);
      mean.xy += add_up(w * s.xy);
      total += add_up(w);
    }
  });
  return {mean.xx / total, mean.yy / total, mean.xy / total};
}

}  // namespace keyblock::block
