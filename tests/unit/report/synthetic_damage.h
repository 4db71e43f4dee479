#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "geometry/vec2.h"
#include "record/record.h"

namespace keyblock::made_up {

/// Damage at the end of a stage of a made-up run with an opening of this size: the second opens it, the third shakes it.
/// `loosened`: area, m², from the third on.
record::Damage synthetic_damage(std::size_t stage, const std::vector<record::FallenBlock>& fallen,
                                double loosened, Vec2 opening);

/// What the rock of a made-up run is and what acts on it.
std::vector<std::pair<std::string, std::string>> synthetic_ground();

}  // namespace keyblock::made_up
