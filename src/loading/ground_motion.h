#pragma once
#include <string>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock::loading {

/// Acceleration of the base in the section plane, linear between samples, zero outside its duration.
class GroundMotion {
 public:
  GroundMotion() = default;
  /// `time` ascends from 0; one acceleration (m/s²) per time.
  GroundMotion(std::string name, std::vector<double> time, std::vector<Vec2> acceleration);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] double duration() const { return time_.empty() ? 0.0 : time_.back(); }
  [[nodiscard]] Vec2 at(double time) const;
  /// Mean over [t0, t1], exact for the piecewise linear function: a step driven by it gains the exact velocity.
  [[nodiscard]] Vec2 mean(double t0, double t1) const;
  /// m/s and m of the base that is at rest at time 0; after the end it goes on at the velocity that it has.
  [[nodiscard]] Vec2 velocity(double time) const;
  [[nodiscard]] Vec2 displacement(double time) const;
  /// Largest |a| over time, m/s².
  [[nodiscard]] double peak() const;
  /// Of ∫|a|² dt of the record that it was cut out of, the share that it has; 1 where nothing was cut off.
  [[nodiscard]] double share_of_record() const { return share_of_record_; }
  void set_share_of_record(double share) { share_of_record_ = share; }
  /// The same motion with accelerations times `factor`.
  [[nodiscard]] GroundMotion scaled(double factor) const;
  [[nodiscard]] const std::vector<double>& times() const { return time_; }
  [[nodiscard]] const std::vector<Vec2>& accelerations() const { return acceleration_; }

 private:
  [[nodiscard]] Vec2 way_from(std::size_t sample, double time, Vec2 last) const;

  std::string name_;
  std::vector<double> time_;
  std::vector<Vec2> acceleration_;
  std::vector<Vec2> integral_;  ///< ∫₀^{time_k} a dt
  std::vector<Vec2> way_;       ///< its integral
  double share_of_record_ = 1.0;
};

}  // namespace keyblock::loading
