#pragma once

namespace keyblock::block {

/// Highest order of a displacement polynomial. Beyond it products of the polynomials of triangles lose too many digits to be
/// made orthonormal, and a step of one block takes seconds. Measured on triangles, beams and polygons of one block.
constexpr int highest_order = 12;

}  // namespace keyblock::block
