#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "block/basis.h"
#include "block/eigenvalue_floor.h"
#include "block/elasticity.h"
#include "block/pose.h"
#include "geometry/quadrature.h"

namespace keyblock::block {
namespace {

const Polygon l_shape{{{3, 0}, {5, 0.2}, {5, 1}, {4, 1}, {4.1, 3}, {3, 2.8}}, {}};
const Polygon holed{{{-2, -2}, {4, -2}, {4, 3}, {-2, 3}}, {{{0, 0}, {0, 1}, {2, 1}, {2, 0}}}};
const Material rock{2270.0, 3.0e9, 0.21, PlaneState::plane_stress};
const InSituStress stress{-1e6, -2e6, 1e5, 1e4, 2e4, 1.0};

TEST(Basis, IsOrthonormalAtEveryOrder) {
  for (const Polygon& region : {l_shape, holed}) {
    for (int order : {1, 2, 3, 5, 10, 24}) {
      const Basis basis(region, order);
      const auto n = static_cast<std::size_t>(basis.size());
      std::vector<double> phi(n), gram(n * n, 0.0);
      for (const WeightedPoint& w : polygon_rule(region, 2 * order)) {
        basis.evaluate(w.point, phi.data());
        for (std::size_t i = 0; i < n; ++i) {
          for (std::size_t j = 0; j <= i; ++j) gram[i * n + j] += w.weight * phi[i] * phi[j];  // symmetric
        }
      }
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) EXPECT_NEAR(gram[i * n + j], i == j ? 1.0 : 0.0, 1e-11) << order;
      }
    }
  }
}

// Looked at between the points it was made from: a polynomial of the order, and its gradient, come back from their projection.
TEST(Basis, KeepsItsDigitsAtHighOrdersOnAnyShape) {
  const Vec2 along{std::cos(0.5), std::sin(0.5)}, across{-along.y, along.x};
  const Polygon triangle{{{0, 0}, {3, 0}, {0.5, 1}}, {}}, needle{{{1, 3}, {2, -1}, {1.2, 3.8}, {1, 3.9}}, {}},
      plank{{{0, 0}, 100.0 * along, 100.0 * along + across, across}, {}};
  for (const Polygon& region : {triangle, needle, plank, l_shape, holed}) {
    const Box box = bounds(region);
    const Vec2 centre = 0.5 * (box.min + box.max), slope{0.6 / norm(box.size()), 1.6 / norm(box.size())};
    for (const int order : {12, 24}) {
      const auto power = [&](Vec2 p, int n) { return std::pow(dot(slope, p - centre), n); };
      const Basis basis(region, order);
      std::vector<double> phi(static_cast<std::size_t>(basis.size())), a(phi.size(), 0.0);
      std::vector<Vec2> g(phi.size());
      for (const WeightedPoint& w : polygon_rule(region, 2 * order + 6)) {
        basis.evaluate(w.point, phi.data());
        for (std::size_t k = 0; k < a.size(); ++k) a[k] += w.weight * phi[k] * power(w.point, order);
      }
      double largest = 0.0;
      for (const Vec2 p : region.outer) largest = std::max(largest, std::abs(power(p, order)));
      for (std::size_t e = 0; e < region.outer.size(); ++e) {
        const Vec2 p = lerp(region.outer[e], region.outer[(e + 1) % region.outer.size()], 0.3);
        basis.evaluate(p, phi.data());
        basis.gradients(p, g.data());
        double value = 0.0;
        Vec2 gradient;
        for (std::size_t k = 0; k < a.size(); ++k) {
          value += a[k] * phi[k];
          gradient += a[k] * g[k];
        }
        EXPECT_NEAR(value / largest, power(p, order) / largest, 1e-9) << order;
        const Vec2 error = gradient - order * power(p, order - 1) * slope;
        EXPECT_NEAR(norm(error) / (order * norm(slope) * largest), 0.0, 1e-8) << order;
      }
    }
  }
}

TEST(Basis, BeginsWithThoseOfLowerOrders) {
  const Polygon square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}};
  for (const Polygon& region : {square, l_shape, holed}) {
    const Basis higher(region, 7);
    std::vector<double> all(static_cast<std::size_t>(higher.size()));
    higher.evaluate(region.outer[2], all.data());
    for (int order = 1; order < higher.order(); ++order) {
      std::vector<double> phi(static_cast<std::size_t>(basis_size(order)));
      Basis(region, order).evaluate(region.outer[2], phi.data());
      for (std::size_t k = 0; k < phi.size(); ++k) EXPECT_EQ(phi[k], all[k]) << order;
    }
  }
}

TEST(Basis, ReproducesTheIdentity) {
  const Basis basis(l_shape, 4);
  const std::vector<Vec2> a = basis.identity();
  std::vector<double> phi(a.size());
  for (const Vec2 p : l_shape.outer) {
    basis.evaluate(p, phi.data());
    Vec2 x;
    for (std::size_t k = 0; k < a.size(); ++k) x += phi[k] * a[k];
    EXPECT_NEAR(norm(x - p), 0.0, 1e-13);
  }
  basis.evaluate(centroid(l_shape), phi.data());
  EXPECT_NEAR(phi[0], 1.0 / std::sqrt(area(l_shape)), 1e-14);
  EXPECT_NEAR(phi[1], 0.0, 1e-13);
  EXPECT_NEAR(phi[2], 0.0, 1e-13);
  EXPECT_THROW(Basis(l_shape, 0), std::invalid_argument);
  constexpr double w = 1e-11;  // x y vanishes on two crossed slits
  const Polygon slits{{{-1, -w},
                       {-w, -w},
                       {-w, -1},
                       {w, -1},
                       {w, -w},
                       {1, -w},
                       {1, w},
                       {w, w},
                       {w, 1},
                       {-w, 1},
                       {-w, w},
                       {-1, w}},
                      {}};
  EXPECT_NO_THROW(Basis(slits, 1));
  EXPECT_THROW(Basis(slits, 2), std::invalid_argument);
}

std::vector<double> coefficients(const Basis& basis) {
  std::vector<double> a;
  for (const Vec2 c : basis.identity()) a.insert(a.end(), {c.x, c.y});
  return a;
}

std::vector<double> disturbed(const Basis& basis, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<double> a = coefficients(basis);
  for (double& x : a) x += uniform(random);
  return a;
}

void add_tangent(const Elasticity& elasticity, const double* a, double viscous, double floor, double* tangent,
                 int stride) {
  const int m = elasticity.size() - 1;
  std::vector<double> geometric(static_cast<std::size_t>(m * m));
  std::vector<double> force(static_cast<std::size_t>(2 * elasticity.size()));
  elasticity.add_force_and_material_tangent(a, viscous, force.data(), tangent, stride, geometric.data());
  if (may_lie_below(geometric.data(), m, floor)) raise_eigenvalues(geometric.data(), m, floor);
  elasticity.add_geometric_tangent(geometric.data(), tangent, stride);
}

std::vector<double> force_of(const Elasticity& elasticity, const std::vector<double>& a) {
  std::vector<double> force(a.size(), 0.0), tangent(a.size() * a.size()), geometric(tangent.size());
  elasticity.add_force_and_material_tangent(a.data(), 0.0, force.data(), tangent.data(),
                                            static_cast<int>(a.size()), geometric.data());
  return force;
}

class ElasticityOrder : public ::testing::TestWithParam<int> {};

TEST_P(ElasticityOrder, ForceAndTangentAreDerivatives) {
  const Basis basis(l_shape, GetParam());
  const Elasticity elasticity(l_shape, basis, rock, stress);
  const std::vector<double> a = disturbed(basis, 0.02, 1);
  const int n = 2 * basis.size();
  const std::vector<double> force = force_of(elasticity, a);
  std::vector<double> tangent(a.size() * a.size(), 0.0);
  add_tangent(elasticity, a.data(), 0.0, 1e30, tangent.data(), n);
  double force_scale = 0.0, tangent_scale = 0.0;
  for (const double f : force) force_scale = std::max(force_scale, std::abs(f));
  for (const double k : tangent) tangent_scale = std::max(tangent_scale, std::abs(k));
  const double h = 1e-5;
  for (int j = 0; j < n; ++j) {
    std::vector<double> up = a, down = a;
    up[static_cast<std::size_t>(j)] += h;
    down[static_cast<std::size_t>(j)] -= h;
    const std::vector<double> force_up = force_of(elasticity, up), force_down = force_of(elasticity, down);
    const double slope = (elasticity.energy(up.data()) - elasticity.energy(down.data())) / (2 * h);
    EXPECT_NEAR(slope / force_scale, force[static_cast<std::size_t>(j)] / force_scale, 1e-6);
    for (int i = j; i < n; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const double expected = (force_up[row] - force_down[row]) / (2 * h);
      EXPECT_NEAR(tangent[static_cast<std::size_t>(j * n + i)] / tangent_scale, expected / tangent_scale,
                  1e-7);
    }
  }
}

TEST_P(ElasticityOrder, MaterialWorkIsWhatViscosityAddsToTheTangent) {
  const Basis basis(l_shape, GetParam());
  const Elasticity elasticity(l_shape, basis, rock, stress);
  const std::vector<double> a = disturbed(basis, 0.02, 1), b = disturbed(basis, 0.01, 9);
  const int n = 2 * basis.size();
  std::vector<double> plain(a.size() * a.size(), 0.0), viscous(plain), d(a.size());
  add_tangent(elasticity, a.data(), 0.0, 1e30, plain.data(), n);
  add_tangent(elasticity, a.data(), 1.0, 1e30, viscous.data(), n);
  for (std::size_t k = 0; k < d.size(); ++k) d[k] = b[k] - a[k];
  double work = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto lower = static_cast<std::size_t>(std::min(i, j) * n + std::max(i, j));
      work +=
          d[static_cast<std::size_t>(i)] * (viscous[lower] - plain[lower]) * d[static_cast<std::size_t>(j)];
    }
  }
  EXPECT_NEAR(elasticity.material_work(a.data(), d.data()) / work, 1.0, 1e-10);
}

TEST_P(ElasticityOrder, EnergyBeyondSecondOrderIsWhatForceAndTangentLeave) {
  const Basis basis(l_shape, GetParam());
  const Elasticity elasticity(l_shape, basis, rock, stress);
  const std::vector<double> a = disturbed(basis, 0.02, 1), b = disturbed(basis, 0.3, 9);
  const int n = 2 * basis.size();
  const std::vector<double> force = force_of(elasticity, a);
  std::vector<double> tangent(a.size() * a.size(), 0.0), d(a.size());
  add_tangent(elasticity, a.data(), 0.0, 1e30, tangent.data(), n);
  for (std::size_t k = 0; k < d.size(); ++k) d[k] = b[k] - a[k];
  double known = 0.0;
  for (int i = 0; i < n; ++i) {
    known += force[static_cast<std::size_t>(i)] * d[static_cast<std::size_t>(i)];
    for (int j = 0; j < n; ++j) {
      const auto lower = static_cast<std::size_t>(std::min(i, j) * n + std::max(i, j));
      known += 0.5 * d[static_cast<std::size_t>(i)] * tangent[lower] * d[static_cast<std::size_t>(j)];
    }
  }
  const double change = elasticity.energy(b.data()) - elasticity.energy(a.data());
  EXPECT_GT(std::abs(change - known), 1e-3 * std::abs(change));
  EXPECT_NEAR(elasticity.beyond_second_order(a.data(), d.data()) / (change - known), 1.0, 1e-8);
}

TEST_P(ElasticityOrder, EnergyIsInvariantUnderRotationAndStressTurns) {
  const Basis basis(l_shape, GetParam());
  const Elasticity elasticity(l_shape, basis, rock, stress);
  const std::vector<double> a = disturbed(basis, 0.01, 2);
  const double angle = 1.1, c = std::cos(angle), s = std::sin(angle);
  std::vector<double> turned = a;
  for (std::size_t k = 0; k + 1 < a.size(); k += 2) {
    turned[k] = c * a[k] - s * a[k + 1];
    turned[k + 1] = s * a[k] + c * a[k + 1];
  }
  EXPECT_NEAR(elasticity.energy(turned.data()) / elasticity.energy(a.data()), 1.0, 1e-12);
  const Stress before = elasticity.mean_cauchy(a.data()), after = elasticity.mean_cauchy(turned.data());
  EXPECT_NEAR((before.xx + before.yy) / (after.xx + after.yy), 1.0, 1e-12);
  EXPECT_NEAR((c * c * before.xx - 2 * s * c * before.xy + s * s * before.yy) / after.xx, 1.0, 1e-10);
}

// Of the geometric part only the eigenvalues below the floor change, and become the floor.
TEST_P(ElasticityOrder, FloorRaisesWhatIsBelowIt) {
  const Basis basis(l_shape, GetParam());
  const InSituStress crushing{-1e9, -2e7, 3e7, 0.0, 0.0, 0.0};
  const std::vector<double> a = coefficients(basis);
  const int n = 2 * basis.size(), m = basis.size() - 1;
  const auto tangent = [&](const std::optional<InSituStress>& in_situ, double floor) {
    std::vector<double> k(a.size() * a.size(), 0.0);
    add_tangent(Elasticity(l_shape, basis, rock, in_situ), a.data(), 0.0, floor, k.data(), n);
    Eigen::MatrixXd x(m, m);  // of the coefficients along x but the first
    for (int j = 0; j < m; ++j) {
      for (int i = j; i < m; ++i)
        x(i, j) = x(j, i) = k[static_cast<std::size_t>((2 * j + 2) * n + 2 * i + 2)];
    }
    return x;
  };
  const Eigen::MatrixXd material = tangent(std::nullopt, 1e30),
                        geometric = tangent(crushing, 1e30) - material;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(geometric);
  const double lowest = solver.eigenvalues()[0], highest = solver.eigenvalues()[m - 1];
  ASSERT_LT(lowest, highest);
  for (const double floor : {-0.5 * (lowest + highest), -2.0 * lowest, -0.5 * highest}) {
    const Eigen::MatrixXd expected = solver.eigenvectors() *
                                     solver.eigenvalues().cwiseMax(-floor).asDiagonal() *
                                     solver.eigenvectors().transpose();
    const Eigen::MatrixXd error = tangent(crushing, floor) - material - expected;
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-9 * std::abs(lowest)) << floor;
  }
}

TEST_P(ElasticityOrder, FloorKeepsTheTangentPositive) {
  const Basis basis(l_shape, GetParam());
  const InSituStress crushing{-1e9, -1e9, 0.0, 0.0, 0.0, 0.0};
  const Elasticity elasticity(l_shape, basis, rock, crushing);
  const std::vector<double> a = coefficients(basis);
  const int n = 2 * basis.size();
  std::vector<double> tangent(a.size() * a.size(), 0.0);
  add_tangent(elasticity, a.data(), 0.0, 1e6, tangent.data(), n);
  // Pure rotation is resisted by the geometric part alone.
  double along = 0.0;
  std::vector<double> spin(a.size());
  for (std::size_t k = 2; k + 1 < a.size(); k += 2) {
    spin[k] = -a[k + 1];
    spin[k + 1] = a[k];
  }
  double squared = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto lower = static_cast<std::size_t>(std::min(i, j) * n + std::max(i, j));
      along += spin[static_cast<std::size_t>(i)] * tangent[lower] * spin[static_cast<std::size_t>(j)];
    }
    squared += spin[static_cast<std::size_t>(i)] * spin[static_cast<std::size_t>(i)];
  }
  EXPECT_GE(along / squared, -1.001e6);
  EXPECT_LT(along / squared, -0.9e6);
}

TEST_P(ElasticityOrder, FreeSpinKeepsAreaAndEnergy) {
  const Basis basis(l_shape, GetParam());
  const Pose pose(l_shape, basis);
  std::vector<double> a = coefficients(basis), v(a.size(), 0.0);
  const double omega = 10.0;
  for (int steps : {314, 63}) {
    const double dt = 2.0 * std::numbers::pi / omega / steps;
    for (std::size_t k = 2; k + 1 < a.size(); k += 2) {
      v[k] = -omega * a[k + 1];
      v[k + 1] = omega * a[k];
    }
    const double area_before = pose.area(a.data());
    double energy_before = 0.0, energy_after = 0.0;
    for (const double x : v) energy_before += x * x;
    const std::vector<double> start = a;
    for (int step = 0; step < steps; ++step) {
      std::vector<double> increment = v;
      for (double& d : increment) d *= dt;
      const double spin = pose.mean_spin(increment.data(), a.data());
      EXPECT_NEAR(spin, omega * dt, 1e-12);
      pose.update(spin, increment.data(), a.data(), v.data());
    }
    for (const double x : v) energy_after += x * x;
    EXPECT_NEAR(pose.area(a.data()) / area_before, 1.0, 1e-12);
    EXPECT_NEAR(energy_after / energy_before, 1.0, 1e-12);
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], start[k], 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, ElasticityOrder, ::testing::Values(1, 2, 3, 5));

// The basis of a plank that is turned is another one of the same space: norm and trace of its stiffness stay.
TEST(Elasticity, StiffnessOfAThinPlankDoesNotDependOnHowItLies) {
  for (const int order : {2, 3, 4}) {
    for (const double width : {0.1, 0.01, 0.001}) {
      const auto stiffness = [&](double angle) {
        const Vec2 along{std::cos(angle), std::sin(angle)}, across = width * perpendicular(along);
        const Polygon plank{{{}, along, along + across, across}, {}};
        const Basis basis(plank, order);
        std::vector<double> a;
        for (const Vec2 x : basis.identity()) a.insert(a.end(), {x.x, x.y});
        const Eigen::Index n = 2 * basis.size();
        Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(n, n);
        std::vector<double> geometric(static_cast<std::size_t>(n * n)), force(a.size());
        Elasticity(plank, basis, rock, std::nullopt)
            .add_force_and_material_tangent(a.data(), 0.0, force.data(), tangent.data(), static_cast<int>(n),
                                            geometric.data());
        const Eigen::MatrixXd whole = tangent.selfadjointView<Eigen::Lower>();
        return std::pair{whole.trace(), whole.norm()};
      };
      const auto lying = stiffness(0.0);
      for (const double angle : {0.5, 0.7, 2.0}) {
        const auto turned = stiffness(angle);
        EXPECT_NEAR(turned.first / lying.first, 1.0, 1e-9) << order << " " << width << " " << angle;
        EXPECT_NEAR(turned.second / lying.second, 1.0, 1e-9) << order << " " << width << " " << angle;
      }
    }
  }
}

TEST(Pose, RotationAgreesWithTheLibrary) {
  for (double w : {0.0, 1e-9, 0.01, 0.3, -2.0, 7.5}) {
    double c, s;
    rotation(w, c, s);
    EXPECT_NEAR(c, std::cos(w), 4e-15);
    EXPECT_NEAR(s, std::sin(w), 4e-15);
  }
}

// Of a state that is none; halving it would not end.
TEST(Pose, NoRotationByInfinity) {
  for (const double w : {HUGE_VAL, -HUGE_VAL, std::nan("")}) {
    double c = 0.0, s = 0.0;
    rotation(w, c, s);
    EXPECT_TRUE(std::isnan(c) && std::isnan(s));
  }
}

}  // namespace
}  // namespace keyblock::block
