#include "statistics/split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "statistics/distributions.h"

namespace keyblock::statistics {

namespace {

constexpr double least_rho = -0.3, most_rho = 0.985;
constexpr int rho_places = 60;
constexpr double rho_tolerance = 1e-10;
/// Of the derivatives of ln L by ρ.
constexpr double rho_step = 1e-3;
constexpr double least_cell = 1e-12;
/// Beyond, Φ₂ is Φ of the other one.
constexpr double far_threshold = 9.0;

/// Nodes above 0 and weights of Gauss and Legendre, 24 points on −1 … 1.
struct GaussNodes {
  std::array<double, 12> node{}, weight{};
};

GaussNodes gauss_nodes() {
  constexpr int n = 24;
  GaussNodes gauss;
  for (int i = 0; i < n / 2; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 0.0;
    for (int step = 0; step < 20; ++step) {
      double p = 1.0, before = 0.0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k;
        before = p;
        p = next;
      }
      slope = n * (x * p - before) / (x * x - 1.0);
      x -= p / slope;
    }
    gauss.node[static_cast<std::size_t>(i)] = x;
    gauss.weight[static_cast<std::size_t>(i)] = 2.0 / ((1.0 - x * x) * slope * slope);
  }
  return gauss;
}

/// n_ab of two pairs that share what `shared` gives, in both orders.
class CoupleTable {
 public:
  CoupleTable(std::span<const Pair> pairs, std::size_t levels, const std::function<int(const Pair&)>& shared)
      : size_(levels + 1), counts_(size_ * size_, 0.0) {
    std::map<int, std::vector<double>> groups;
    for (const Pair& pair : pairs)
      groups.try_emplace(shared(pair), size_, 0.0).first->second[pair.first] += 1.0;
    for (const auto& [id, n] : groups) {
      for (std::size_t a = 0; a < size_; ++a) {
        for (std::size_t b = 0; b < size_; ++b) counts_[a * size_ + b] += n[a] * (a == b ? n[b] - 1.0 : n[b]);
      }
    }
  }

  [[nodiscard]] bool is_empty() const {
    return std::all_of(counts_.begin(), counts_.end(), [](double n) { return n == 0.0; });
  }

  [[nodiscard]] double log_likelihood(std::span<const double> thresholds, double rho) const {
    std::vector<double> ends{-far_threshold};
    ends.insert(ends.end(), thresholds.begin(), thresholds.end());
    ends.push_back(far_threshold);
    const std::size_t n = ends.size();
    std::vector<double> below(n * n);
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = a; b < n; ++b)
        below[a * n + b] = below[b * n + a] = bivariate_normal_cdf(ends[a], ends[b], rho);
    }
    double sum = 0.0;
    for (std::size_t a = 0; a < size_; ++a) {
      for (std::size_t b = 0; b < size_; ++b) {
        const double cell =
            below[(a + 1) * n + b + 1] - below[a * n + b + 1] - below[(a + 1) * n + b] + below[a * n + b];
        sum += counts_[a * size_ + b] * std::log(std::max(cell, least_cell));
      }
    }
    return sum;
  }

 private:
  std::size_t size_;
  std::vector<double> counts_;
};

double likeliest(const CoupleTable& table, std::span<const double> thresholds) {
  if (table.is_empty()) return not_a_number;
  const auto log_likelihood = [&](double rho) { return table.log_likelihood(thresholds, rho); };
  const auto place = [](int k) { return least_rho + (most_rho - least_rho) * k / (rho_places - 1); };
  int best = 0;
  double most = log_likelihood(place(0));
  for (int k = 1; k < rho_places; ++k) {
    const double here = log_likelihood(place(k));
    if (here > most) {
      most = here;
      best = k;
    }
  }
  // The golden section of the two pieces beside it.
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = place(std::max(best - 1, 0)), high = place(std::min(best + 1, rho_places - 1));
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double at_left = log_likelihood(left), at_right = log_likelihood(right);
  while (high - low > rho_tolerance) {
    if (at_left >= at_right) {
      high = right;
      right = left;
      at_right = at_left;
      at_left = log_likelihood(left = high - golden * (high - low));
    } else {
      low = left;
      left = right;
      at_left = at_right;
      at_right = log_likelihood(right = low + golden * (high - low));
    }
  }
  return 0.5 * (low + high);
}

double nearest(const CoupleTable& table, std::span<const double> thresholds, double start) {
  if (table.is_empty() || std::isnan(start)) return not_a_number;
  const double middle = std::clamp(start, least_rho + rho_step, most_rho - rho_step);
  const double below = table.log_likelihood(thresholds, middle - rho_step);
  const double here = table.log_likelihood(thresholds, middle);
  const double above = table.log_likelihood(thresholds, middle + rho_step);
  const double bend = above - 2.0 * here + below;
  if (!(bend < 0.0)) return middle;
  return std::clamp(middle - 0.5 * rho_step * (above - below) / bend, least_rho, most_rho);
}

int rock_of(const Pair& pair) {
  return pair.rock;
}
int record_of(const Pair& pair) {
  return pair.record;
}

}  // namespace

double bivariate_normal_cdf(double h, double k, double rho) {
  static const GaussNodes gauss = gauss_nodes();
  const double angle = std::asin(rho);
  double sum = 0.0;
  for (std::size_t i = 0; i < gauss.node.size(); ++i) {
    for (const double node : {-gauss.node[i], gauss.node[i]}) {
      const double t = 0.5 * angle * (node + 1.0), s = std::sin(t), c = std::cos(t);
      sum += gauss.weight[i] * std::exp(-(h * h + k * k - 2.0 * h * k * s) / (2.0 * c * c));
    }
  }
  return normal_cdf(h) * normal_cdf(k) + angle / (4.0 * std::numbers::pi) * sum;
}

SharedCorrelations shared_correlations(std::span<const Pair> pairs, std::span<const double> thresholds) {
  const std::size_t levels = thresholds.size();
  return {likeliest(CoupleTable(pairs, levels, rock_of), thresholds),
          likeliest(CoupleTable(pairs, levels, record_of), thresholds)};
}

SharedCorrelations near_correlations(std::span<const Pair> pairs, std::span<const double> thresholds,
                                     const SharedCorrelations& start) {
  const std::size_t levels = thresholds.size();
  return {nearest(CoupleTable(pairs, levels, rock_of), thresholds, start.rock),
          nearest(CoupleTable(pairs, levels, record_of), thresholds, start.record)};
}

}  // namespace keyblock::statistics
