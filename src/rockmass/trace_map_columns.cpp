#include "rockmass/trace_map_columns.h"

#include <algorithm>
#include <cctype>

namespace keyblock::rockmass {
namespace {

/// Without signs that part words: `START_X` and `start x` are `startx`.
std::string plain_name(std::string name) {
  std::erase_if(name, [](char c) { return std::string_view("_ .-()[]").find(c) != std::string_view::npos; });
  if (name.size() > 2 && name.ends_with('m') &&
      std::isdigit(static_cast<unsigned char>(name[name.size() - 2])) != 0)
    name.pop_back();  // `x1 (m)`
  return name;
}

/// Columns of these names, if there are both.
std::optional<std::pair<std::size_t, std::size_t>> pair_of(const std::vector<std::string>& names,
                                                           const std::string& x, const std::string& y) {
  const auto at_x = std::find(names.begin(), names.end(), x), at_y = std::find(names.begin(), names.end(), y);
  if (at_x == names.end() || at_y == names.end()) return {};
  return std::pair(static_cast<std::size_t>(at_x - names.begin()),
                   static_cast<std::size_t>(at_y - names.begin()));
}

/// `x1 y1 x2 y2 …`, counted from 1 or 0.
VertexPlaces numbered_vertices(const std::vector<std::string>& names) {
  for (const auto& [x, y] : {std::pair("x", "y"), std::pair("easting", "northing"), std::pair("e", "n")}) {
    for (const int first : {1, 0}) {
      VertexPlaces places;
      for (int k = first; const auto vertex = pair_of(names, x + std::to_string(k), y + std::to_string(k));
           ++k)
        places.push_back(*vertex);
      if (places.size() >= 2) return places;
    }
  }
  return {};
}

/// `xstart ystart xend yend`, `START_X …` and the like.
VertexPlaces named_ends(const std::vector<std::string>& names) {
  constexpr std::pair<const char*, const char*> ends[] = {
      {"start", "end"},  {"from", "to"}, {"begin", "end"}, {"beg", "end"},
      {"first", "last"}, {"ini", "fin"}, {"i", "f"},       {"s", "e"},
      {"a", "b"},        {"p1", "p2"},   {"pt1", "pt2"},   {"start", "stop"}};
  for (const auto& [from, to] : ends) {
    const std::string a = from, b = to;
    const auto x_first = pair_of(names, "x" + a, "y" + a), x_last = pair_of(names, "x" + b, "y" + b);
    if (x_first && x_last) return {*x_first, *x_last};
    const auto first = pair_of(names, a + "x", a + "y"), last = pair_of(names, b + "x", b + "y");
    if (first && last) return {*first, *last};
  }
  return {};
}

/// `id x y x y`
VertexPlaces repeated_vertices(const std::vector<std::string>& names) {
  std::vector<std::size_t> x, y;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == "x") x.push_back(k);
    if (names[k] == "y") y.push_back(k);
  }
  VertexPlaces places;
  for (std::size_t k = 0; x.size() >= 2 && x.size() == y.size() && k < x.size(); ++k)
    places.emplace_back(x[k], y[k]);
  return places;
}

}  // namespace

std::optional<std::size_t> column_of(const std::vector<std::string>& names,
                                     std::initializer_list<std::string_view> wanted) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
  });
  return found == names.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - names.begin()));
}

bool is_header_of_points(const std::vector<std::string>& names) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k].empty() || names[k].front() != (k % 2 == 0 ? 'x' : 'y') ||
        names[k].find_first_not_of("_0123456789", 1) != std::string::npos)
      return false;
  }
  return names.size() >= 4 && names.size() % 2 == 0;
}

VertexPlaces places_of_vertices(const std::vector<std::string>& names) {
  std::vector<std::string> plain;
  for (const std::string& name : names) plain.push_back(plain_name(name));
  VertexPlaces places = numbered_vertices(plain);
  if (places.empty()) places = named_ends(plain);
  return places.empty() ? repeated_vertices(plain) : places;
}

}  // namespace keyblock::rockmass
