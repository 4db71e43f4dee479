#pragma once

namespace keyblock::block {

/// Highest order of a displacement polynomial: the last at which those of triangles keep nine digits (docs/decisions/0011-orders.md).
constexpr int highest_order = 24;

}  // namespace keyblock::block
