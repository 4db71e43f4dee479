#include "scenario/usual.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace keyblock::scenario {
namespace {

std::string usual_range(const Usual& usual, double size) {
  const bool is_limited = std::isfinite(usual.most) && !std::isfinite(usual.without_limit);
  if (is_limited) return fmt::format("{:.4g} to {}", usual.least, with_unit(usual.most, usual.unit));
  if (size < usual.least) return "at least " + with_unit(usual.least, usual.unit);
  return fmt::format("at most {}, or {} and more for what never breaks", with_unit(usual.most, usual.unit),
                     with_unit(usual.without_limit, usual.unit));
}

std::string hint(const Usual& usual, double value) {
  const auto is_likely = [&](double x) { return x >= usual.least_likely && x <= usual.most_likely; };
  if (const double angle = std::atan(value) * 180.0 / std::numbers::pi;
      usual.may_be_tangent && value < usual.least && is_likely(angle))
    return fmt::format("was it a coefficient? {:.4g} is the tangent of {:.4g} degrees", value, angle);
  const auto meant = std::ranges::find_if(
      usual.mistaken, [&](const OtherUnit& unit) { return is_likely(std::abs(value) * unit.factor); });
  if (meant == usual.mistaken.end()) return {};
  return fmt::format("was it in {}? That is {}", meant->name, with_unit(value * meant->factor, usual.unit));
}

}  // namespace

std::string with_unit(double value, std::string_view unit) {
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string unusual_text(const Usual& usual, double value) {
  const double size = std::abs(value);
  if (size == 0.0 || (size >= usual.least && size <= usual.most) || size >= usual.without_limit) return {};
  const std::string meant = hint(usual, value);
  return "usual is " + usual_range(usual, size) + (meant.empty() ? "" : "; " + meant);
}

}  // namespace keyblock::scenario
