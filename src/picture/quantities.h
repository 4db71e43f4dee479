#pragma once
#include <span>
#include <string>
#include <vector>

#include "picture/colors.h"
#include "picture/scale.h"
#include "results/run_data.h"

namespace keyblock::picture {

/// What blocks may be coloured by, described once: pictures, films and their --help have it from here. The report and Python use the same names.
struct BlockQuantity {
  const char* name;
  const char* title;
  Quantity quantity = Quantity::none;
  ColorMap map = ColorMap::magma;
  bool much_is_low = false;  ///< dark is the most compressed rock
  bool is_class = false;
};
std::span<const BlockQuantity> block_quantities();
/// Null for a name that there is not.
const BlockQuantity* find_quantity(std::string_view name);

/// Named colours of a quantity that is no number on a scale.
struct NamedColor {
  std::string name, color;
};

/// The values of blocks, moment by moment, on one scale for all moments of the run.
class BlockValues {
 public:
  BlockValues(const results::RunData& run, const BlockQuantity& quantity);

  /// Of every block; the number of a class; NaN where there is none.
  [[nodiscard]] std::vector<double> at(std::size_t frame) const;
  [[nodiscard]] const Scale& scale() const { return scale_; }
  [[nodiscard]] std::vector<NamedColor> classes() const;
  [[nodiscard]] const BlockQuantity& quantity() const { return quantity_; }
  [[nodiscard]] std::string color(double value) const;

 private:
  [[nodiscard]] double value(const record::Frame& frame, std::size_t block) const;
  [[nodiscard]] std::vector<double> largest_slips(std::size_t frame) const;

  const results::RunData& run_;
  const BlockQuantity& quantity_;
  std::vector<int> orders_;  ///< that blocks have in some frame, ascending
  Scale scale_;
};

/// The last frame of every stage that has one.
std::vector<std::size_t> stage_end_frames(const results::RunData& run);
/// The frame from which displacement counts: the first of the stage that first excavates, or that of the start (none).
std::optional<std::size_t> reference_frame(const results::RunData& run);
/// Of all blocks, since the reference frame and against the base where all fixed blocks move alike; none before.
std::vector<Vec2> block_displacements(const results::RunData& run, std::size_t frame);
/// The snapshot of contacts that a picture of a frame shows: the last of its stage or of an earlier one that is not later; none: there is none.
const record::ContactFrame* contacts_at(const results::RunData& run, std::size_t frame);

/// Principal values of a stress, and the direction of the larger one, rad.
struct Principal {
  double larger = 0.0, smaller = 0.0, angle = 0.0;
};
Principal principal_of(const std::array<float, 3>& stress);

}  // namespace keyblock::picture
