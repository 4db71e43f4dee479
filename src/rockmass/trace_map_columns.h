#pragma once
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// What the columns of a table of traces are, by their names in small letters.
namespace keyblock::rockmass {

/// The first column that has one of the names; none: there is no such column.
std::optional<std::size_t> column_of(const std::vector<std::string>& names,
                                     std::initializer_list<std::string_view> wanted);

/// Whether they are `x y x y …`, with numbers or without.
bool is_header_of_points(const std::vector<std::string>& names);

/// Columns of the x and y of each vertex of a line.
using VertexPlaces = std::vector<std::pair<std::size_t, std::size_t>>;

/// Whatever else stands beside them; empty when there are no two vertices.
VertexPlaces places_of_vertices(const std::vector<std::string>& names);

}  // namespace keyblock::rockmass
