#pragma once
#include <string>
#include <string_view>

#include "cutting/block_system.h"

namespace keyblock::cutting {

/// `free`, `joint_set`, `trace_map`, `excavation`, `domain`.
std::string_view name_of(EdgeKind kind);

/// The blocks as a GeoJSON FeatureCollection in real coordinates (origin added): one Feature per block with a Polygon and
/// the properties `id` (its number), `area` (m²), `excavations` (list of indices) and `edges`: per ring a list of
/// [kind, index], one per edge, in the order of the coordinates.
std::string to_geojson(const BlockSystem& system);

}  // namespace keyblock::cutting
