#pragma once
#include <cstdint>
#include <vector>

#include "rockmass/joint_set.h"
#include "rockmass/trace.h"

namespace keyblock::rockmass {

/// Most traces one joint set may have in a window; a set that expects more is refused.
constexpr double max_traces = 5e6;

/// Estimate, from above, of the number of traces that meet the window: for the box around it along the lines.
double expected_traces(const JointSet& set, double section_azimuth, const Box& window);

/// The traces of a joint set that meet `window`, whole (not clipped), in a section whose x axis points to
/// `section_azimuth` (degrees).
///
/// Model (Hsiung & Shi 2001): parallel lines along the apparent dip; their distances normal to the lines are
/// spacing × trace_spacing_factor, or spacing itself if it is measured between traces. On each line traces
/// and gaps alternate, all lengths independent. With scatter, every joint has its own dip and dip direction
/// and is turned about the centre of its trace; its length stays.
///
/// Lines and traces are stationary: the interval (or trace and gap) that holds the centre of the window is
/// picked with a probability proportional to its length among 128 drawn ones and placed uniformly; from there
/// the process runs both ways. That is a process begun infinitely far outside. Means (S spacing in the
/// section, L, G means of length and gap): traces per area P20 = 1/(S(L+G)), length per area P21 =
/// L/(S(L+G)).
///
/// Draws are keyed by seed, realization, set_index and number of the line, counted from the centre of the
/// window. So nothing depends on other sets or on the order of realizations, and a window grown about its
/// centre keeps the traces it had. Directions are rounded to 2⁻⁴⁰, coordinates to 2⁻³⁰ m (1e-9 m), so that
/// the last bits of a machine's sines and logarithms do not show.
///
/// Throws InputError when more than max_traces are expected, or drawn.
std::vector<Trace> generate_traces(const JointSet& set, int set_index, double section_azimuth,
                                   const Box& window, std::uint64_t seed, int realization);

/// The gaps between these traces that meet `window`: from the end of each to the beginning of the next one on its line.
std::vector<Trace> gaps_of_traces(const JointSet& set, int set_index, double section_azimuth,
                                  const Box& window, std::uint64_t seed, int realization);

}  // namespace keyblock::rockmass
