#include "loading/motion_direction.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <string>

#include "loading/motion_text.h"

namespace keyblock::loading {
namespace {

// A quadrant bearing: N21E is 21° east of north.
std::optional<double> quadrant_bearing(std::string_view words) {
  if (words.size() < 3 || (words.front() != 'n' && words.front() != 's') ||
      (words.back() != 'e' && words.back() != 'w'))
    return {};
  const auto bearing = parse_number(words.substr(1, words.size() - 2));
  if (!bearing || !(*bearing >= 0.0 && *bearing <= 90.0)) return {};
  const double eastwards = words.back() == 'e' ? *bearing : -*bearing;
  return words.front() == 'n' ? std::fmod(360.0 + eastwards, 360.0) : 180.0 - eastwards;
}

}  // namespace

MotionDirection parse_direction(std::string_view words) {
  MotionDirection direction;
  std::string all = lower(trim(words.substr(0, words.find('('))));
  if (all.ends_with("degrees")) all.resize(all.size() - 7);
  if (all.ends_with("deg") || all.ends_with("dg")) all.resize(all.rfind('d'));
  if (all.ends_with("°")) all.resize(all.size() - 2);
  std::erase_if(all, [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; });
  const auto any_of = [&](std::initializer_list<std::string_view> known) {
    return std::find(known.begin(), known.end(), all) != known.end();
  };
  direction.downwards = any_of({"down", "dwn", "dn"});
  direction.vertical =
      direction.downwards || any_of({"up", "u", "ver", "vert", "vertical", "v", "z", "ud", "u-d"});
  if (any_of({"n", "ns", "n-s", "sn", "s-n", "north", "north-south"})) direction.azimuth = 0.0;
  if (any_of({"e", "ew", "e-w", "we", "w-e", "east", "east-west"})) direction.azimuth = 90.0;
  if (any_of({"s", "south"})) direction.azimuth = 180.0;
  if (any_of({"w", "west"})) direction.azimuth = 270.0;
  if (const auto degrees = parse_number(all); degrees && *degrees >= 0.0 && *degrees <= 360.0) {
    direction.azimuth = *degrees;
  } else if (const auto bearing = quadrant_bearing(all)) {
    direction.azimuth = bearing;
  }
  return direction;
}

MotionDirection channel_code_direction(std::string_view code) {
  const std::string name = lower(trim(code));
  if (name.size() != 3) return {};
  const bool is_sensor = name[1] == 'n' || name[1] == 'l' || name[1] == 'g' || name[1] == 'h';
  const bool is_direction = name[2] == 'n' || name[2] == 'e' || name[2] == 'z';
  return is_sensor && is_direction ? parse_direction(std::string_view(name).substr(2)) : MotionDirection{};
}

}  // namespace keyblock::loading
