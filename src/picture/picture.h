#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "results/run_data.h"

namespace keyblock::picture {

/// What is drawn, beside the moment.
struct Options {
  std::string color = "displacement";  ///< of the blocks: block_quantities()
  std::string joints = "none";         ///< joint_words
  std::string arrows = "none";         ///< arrow_words
  bool forces = false;                 ///< force chains
  bool stress = false;                 ///< crosses of the principal stresses
  bool thrust = false;                 ///< line of thrust, with hinges
  bool outline = false;                ///< blocks as they were, over those as they are
  double exaggeration = 1.0;           ///< factor on displacements, as drawn
};
inline constexpr std::string_view joint_words[] = {"none", "state", "slip", "opening", "set"};
inline constexpr std::string_view arrow_words[] = {"none", "displacement", "velocity"};

/// A section of a run as a picture: the blocks where they are at a moment, in the colours of a quantity, with legend, scale bar, time and
/// title. Scales, window and size are the same for all moments of a run, so that pictures can be compared and make a film.
class SectionPicture {
 public:
  /// The run must outlive it, and have a frame.
  SectionPicture(const results::RunData& run, Options options);
  ~SectionPicture();
  SectionPicture(const SectionPicture&) = delete;
  SectionPicture& operator=(const SectionPicture&) = delete;

  [[nodiscard]] std::string draw(std::size_t frame) const;
  /// Says what it is: `three-joint-sets-slip-3.400s`.
  [[nodiscard]] std::string file_name(std::size_t frame) const;

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

/// The frame nearest to a time, the later of two that are as near.
std::size_t frame_near(const results::RunData& run, double time);
/// A title as a part of a file name: small letters, digits and hyphens.
std::string file_word(std::string_view title);

}  // namespace keyblock::picture
