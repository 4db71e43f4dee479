#include "loading/ground_motion.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace keyblock::loading {

GroundMotion::GroundMotion(std::string name, std::vector<double> time, std::vector<Vec2> acceleration)
    : name_(std::move(name)), time_(std::move(time)), acceleration_(std::move(acceleration)) {
  if (time_.size() != acceleration_.size() || time_.empty() || time_.front() != 0.0 ||
      !std::is_sorted(time_.begin(), time_.end())) {
    throw std::invalid_argument("GroundMotion: times must ascend from 0, one acceleration each");
  }
  integral_.resize(time_.size());
  way_.resize(time_.size());
  for (std::size_t k = 1; k < time_.size(); ++k) {
    const double half_step = 0.5 * (time_[k] - time_[k - 1]);
    integral_[k] = integral_[k - 1] + half_step * (acceleration_[k - 1] + acceleration_[k]);
    way_[k] = way_[k - 1] + way_from(k - 1, time_[k] - time_[k - 1], acceleration_[k]);
  }
}

GroundMotion GroundMotion::scaled(double factor) const {
  std::vector<Vec2> accelerations = acceleration_;
  for (Vec2& a : accelerations) a = factor * a;
  GroundMotion motion(name_, time_, std::move(accelerations));
  motion.share_of_record_ = share_of_record_;
  return motion;
}

Vec2 GroundMotion::at(double time) const {
  if (time_.empty() || time < 0.0 || time > time_.back()) return {};
  const auto next = std::upper_bound(time_.begin(), time_.end(), time);
  if (next == time_.end()) return acceleration_.back();
  const auto k = static_cast<std::size_t>(next - time_.begin());
  return lerp(acceleration_[k - 1], acceleration_[k], (time - time_[k - 1]) / (time_[k] - time_[k - 1]));
}

Vec2 GroundMotion::mean(double t0, double t1) const {
  if (t0 == t1) return at(t0);
  if (t0 > t1) std::swap(t0, t1);
  const double begin = std::max(t0, 0.0), end = std::min(t1, duration());
  if (time_.empty() || begin >= end) return {};
  const auto first =
      static_cast<std::size_t>(std::upper_bound(time_.begin(), time_.end(), begin) - time_.begin());
  const auto last =
      static_cast<std::size_t>(std::lower_bound(time_.begin(), time_.end(), end) - time_.begin());
  // Nodes strictly inside are first … last − 1. The value at `end` is the limit from the left.
  const auto before = [&](double t, std::size_t k) {
    return lerp(acceleration_[k - 1], acceleration_[k], (t - time_[k - 1]) / (time_[k] - time_[k - 1]));
  };
  const Vec2 a = before(begin, first), b = before(end, last);
  if (first >= last) return (end - begin) / (t1 - t0) * 0.5 * (a + b);
  const Vec2 head = 0.5 * (time_[first] - begin) * (a + acceleration_[first]);
  const Vec2 tail = 0.5 * (end - time_[last - 1]) * (acceleration_[last - 1] + b);
  return (head + (integral_[last - 1] - integral_[first]) + tail) / (t1 - t0);
}

/// m, in a time from sample k on, at whose end the acceleration is `last`.
Vec2 GroundMotion::way_from(std::size_t k, double time, Vec2 last) const {
  return time * (integral_[k] + time / 6.0 * (2.0 * acceleration_[k] + last));
}

Vec2 GroundMotion::velocity(double time) const {
  return time > 0.0 ? time * mean(0.0, time) : Vec2{};
}

Vec2 GroundMotion::displacement(double time) const {
  if (time_.empty() || time <= 0.0) return {};
  if (time >= time_.back()) return way_.back() + (time - time_.back()) * integral_.back();
  const auto k =
      static_cast<std::size_t>(std::upper_bound(time_.begin(), time_.end(), time) - time_.begin()) - 1;
  return way_[k] + way_from(k, time - time_[k], at(time));
}

double GroundMotion::peak() const {
  double peak = 0.0;
  for (const Vec2 a : acceleration_) peak = std::max(peak, norm(a));
  return peak;
}

}  // namespace keyblock::loading
