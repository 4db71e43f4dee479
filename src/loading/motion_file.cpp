#include "loading/motion_file.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "loading/motion_text.h"

namespace keyblock::loading {

std::size_t MotionComponent::peak_index() const {
  std::size_t peak = 0;
  for (std::size_t k = 1; k < acceleration.size(); ++k) {
    if (std::abs(acceleration[k]) > std::abs(acceleration[peak])) peak = k;
  }
  return peak;
}

namespace {

// m/s². What is summed and squared of larger ones would not stay finite.
constexpr double largest_acceleration = 1e9;

void check_samples(const std::vector<MotionComponent>& components) {
  for (const MotionComponent& component : components) {
    const std::size_t peak = component.peak_index();
    if (std::abs(component.acceleration[peak]) <= largest_acceleration) continue;
    Diagnostic diagnostic;
    diagnostic.where.file = component.file;
    diagnostic.found =
        fmt::format("an acceleration of {:.3g} {} in sample {}",
                    component.acceleration[peak] / component.file_unit_in_si, component.file_unit, peak + 1);
    diagnostic.expected = fmt::format("at most {:.0e} m/s2", largest_acceleration);
    throw InputError(std::move(diagnostic));
  }
}

}  // namespace

std::vector<MotionComponent> read_motion_file(const std::filesystem::path& path) {
  struct Format {
    bool (*matches)(const MotionText&);
    std::vector<MotionComponent> (*read)(const MotionText&);
  };
  constexpr Format formats[] = {{matches_smc, read_smc},
                                {matches_csmip, read_csmip},
                                {matches_cosmos, read_cosmos},
                                {matches_at2, read_at2},
                                {matches_csv, read_csv}};
  const MotionText text(path.string(), read_file(path));
  for (const Format& format : formats) {
    if (!format.matches(text)) continue;
    std::vector<MotionComponent> components = format.read(text);
    check_samples(components);
    return components;
  }
  text.fail(0,
            "a record in the format USGS SMC, PEER AT2, CSMIP V2 or COSMOS V2, or two columns (time, "
            "acceleration)");
}

}  // namespace keyblock::loading
