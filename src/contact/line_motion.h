#pragma once

namespace keyblock::contact {

/// A line of length L whose ends move by m turns by less than this times m / L, as long as m is at most `largest_line_motion` of L.
/// (Rounded up: 2 m / L, and what the ends come closer by.)
inline constexpr double line_turn = 2.2, largest_line_motion = 0.05;

}  // namespace keyblock::contact
