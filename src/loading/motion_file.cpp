#include "loading/motion_file.h"

#include <cmath>

#include "core/atomic_file.h"
#include "loading/motion_text.h"

namespace keyblock::loading {

std::size_t MotionComponent::peak_index() const {
  std::size_t peak = 0;
  for (std::size_t k = 1; k < acceleration.size(); ++k) {
    if (std::abs(acceleration[k]) > std::abs(acceleration[peak])) peak = k;
  }
  return peak;
}

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
    if (format.matches(text)) return format.read(text);
  }
  text.fail(0,
            "a record in the format USGS SMC, PEER AT2, CSMIP V2 or COSMOS V2, or two columns (time, "
            "acceleration)");
}

}  // namespace keyblock::loading
