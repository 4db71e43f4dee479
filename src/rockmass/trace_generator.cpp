#include "rockmass/trace_generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/random.h"
#include "rockmass/distribution.h"
#include "rockmass/section.h"

namespace keyblock::rockmass {

namespace {

/// Candidates for the interval that holds the centre of the window.
constexpr std::uint32_t candidates = 128;

/// The draws of an interval of a line lie at 4·interval + Draw.
enum class Draw : std::uint32_t { length, gap, dip, dip_direction };
constexpr std::uint32_t first_candidate = 1u << 28;
constexpr std::uint32_t pick_draw = 1u << 31;

double round_to(double value, double step) {
  return std::nearbyint(value / step) * step;
}

Vec2 direction_of(double apparent_dip_degrees) {
  constexpr double step = 0x1p-40;
  const double angle = radians(apparent_dip_degrees);
  return {round_to(std::cos(angle), step), round_to(-std::sin(angle), step)};
}

/// 0, −1, 1, −2, 2, … → 0, 1, 2, 3, 4, …
std::uint32_t folded(int k) {
  return k >= 0 ? 2u * static_cast<std::uint32_t>(k) : 2u * static_cast<std::uint32_t>(-(k + 1)) + 1u;
}

double draw(const RandomStream& stream, std::uint32_t interval, Draw what) {
  return stream.uniform(4u * interval + static_cast<std::uint32_t>(what));
}

/// The interval that holds the anchor, and how far behind the anchor it begins.
struct Start {
  std::uint32_t interval = 0;
  double offset = 0.0;
};

template <typename Length>
Start stationary_start(const RandomStream& stream, const Length& length) {
  std::array<double, candidates> lengths;
  double total = 0.0;
  for (std::uint32_t k = 0; k < candidates; ++k) {
    lengths[k] = length(first_candidate + k);
    total += lengths[k];
  }
  double rest = stream.uniform(pick_draw) * total;
  std::uint32_t k = 0;
  while (k + 1 < candidates && rest >= lengths[k]) rest -= lengths[k++];
  return {first_candidate + k, rest};
}

bool meets(const Box& box, Vec2 a, Vec2 b) {
  Box segment;
  segment.add(a);
  segment.add(b);
  if (!segment.overlaps(box)) return false;
  const auto side = [&](double x, double y) { return cross(b - a, Vec2{x, y} - a); };
  const std::array<double, 4> sides{side(box.min.x, box.min.y), side(box.max.x, box.min.y),
                                    side(box.max.x, box.max.y), side(box.min.x, box.max.y)};
  const auto [low, high] = std::minmax_element(sides.begin(), sides.end());
  return *low <= 0.0 && *high >= 0.0;
}

[[noreturn]] void refuse(const JointSet& set, const std::string& number) {
  Diagnostic diagnostic;
  diagnostic.key = fmt::format("joint_set.'{}'", set.name);
  diagnostic.found = fmt::format("statistics that give {} traces in the domain", number);
  diagnostic.expected = fmt::format("at most {:.0g}", max_traces);
  diagnostic.hint = "larger spacing, length or gap, or a smaller domain";
  throw InputError(std::move(diagnostic));
}

/// One joint set in one section.
class Generator {
 public:
  Generator(const JointSet& set, int set_index, double azimuth, const Box& window, std::uint64_t seed,
            int realization)
      : set_(set),
        source_{TraceSource::Kind::joint_set, set_index},
        azimuth_(azimuth),
        window_(window),
        seed_(seed),
        realization_(static_cast<std::uint32_t>(realization)),
        along_(direction_of(apparent_dip(set.dip, set.dip_direction, azimuth))),
        centre_(0.5 * (window.min + window.max)),
        scattered_(set.dip_std > 0.0 || set.dip_direction_std > 0.0) {
    factor_ = set.spacing_measure == SpacingMeasure::true_spacing
                  ? round_to(trace_spacing_factor(set.dip, set.dip_direction, azimuth), 0x1p-40)
                  : 1.0;
    const Vec2 half = 0.5 * window.size();
    // A turned joint reaches the window from half its length away.
    const double reach = scattered_ ? 0.5 * quantile(set.length, 1.0 - 1e-9) : 0.0;
    half_along_ = half.x * std::abs(along_.x) + half.y * std::abs(along_.y) + reach;
    half_across_ = half.x * std::abs(along_.y) + half.y * std::abs(along_.x) + reach;
  }

  [[nodiscard]] double expected() const {
    const double spacing = factor_ * truncated_mean(set_.spacing);
    return (2.0 * half_across_ / spacing) * expected_of_line();
  }

  [[nodiscard]] double expected_of_line() const {
    const double length = truncated_mean(set_.length);
    return (2.0 * half_along_ + length) / (length + truncated_mean(set_.gap));
  }

  std::vector<Trace> run() {
    if (!std::isfinite(factor_)) return {};
    const RandomStream stream = line_stream(0);
    const auto spacing = [&](std::uint32_t interval) {
      return factor_ * quantile(set_.spacing, draw(stream, interval, Draw::length));
    };
    const Start start = stationary_start(stream, spacing);
    const std::string too_many = fmt::format("more than {:.0g}", max_traces);
    if (!std::isfinite(start.offset)) refuse(set_, too_many);
    const auto each_line = [&](const auto& visit) {
      double position = -start.offset;
      for (int k = 0; position >= -half_across_; position -= spacing(folded(--k))) visit(k, position);
      position = spacing(start.interval) - start.offset;
      for (int k = 1; position <= half_across_; position += spacing(folded(k++))) visit(k, position);
    };
    // The statistics may expect few traces and yet draw many, as a lognormal spacing of enormous deviation does. Lines
    // are counted first, as counting costs little.
    const double of_line = expected_of_line();
    double lines = 0.0;
    each_line([&](int, double) {
      if (++lines * of_line > max_traces) refuse(set_, too_many);
    });
    each_line([&](int number, double position) { add_line(number, position); });
    return std::move(traces_);
  }
  /// As run(), of the gaps between them.
  std::vector<Trace> run_for_gaps() {
    wants_gaps_ = true;
    run();
    return std::move(gaps_);
  }

 private:
  /// Of a trace: line and interval, by the numbers of their draws.
  struct Place {
    std::uint32_t line, interval;
  };

  [[nodiscard]] RandomStream line_stream(std::uint32_t number) const {
    return {seed_, realization_, static_cast<std::uint32_t>(source_.index), number};
  }

  void add_line(int number, double position) {
    const RandomStream stream = line_stream(1u + folded(number));
    const auto length = [&](std::uint32_t i) { return quantile(set_.length, draw(stream, i, Draw::length)); };
    const auto cycle = [&](std::uint32_t i) {
      return length(i) + quantile(set_.gap, draw(stream, i, Draw::gap));
    };
    const Start start = stationary_start(stream, cycle);
    std::vector<OnLine> of_line;
    const auto add = [&](std::uint32_t i, double begin) {
      const OnLine trace = trace_of(stream, {1u + folded(number), i}, position, begin, length(i));
      add_trace(trace);
      if (wants_gaps_) of_line.push_back(trace);
    };
    add(start.interval, -start.offset);
    double begin = cycle(start.interval) - start.offset;
    for (int k = 1; begin <= half_along_; begin += cycle(folded(k++))) add(folded(k), begin);
    double end = -start.offset;
    for (int k = -1; end >= -half_along_; --k) {
      end -= cycle(folded(k));
      add(folded(k), end);
    }
    std::ranges::sort(of_line, {}, &OnLine::begin);
    for (std::size_t k = 0; k + 1 < of_line.size(); ++k) add_gap(of_line[k].b, of_line[k + 1].a);
  }

  /// A trace, and where it begins on its line, m.
  struct OnLine {
    double begin = 0.0;
    Vec2 a, b;
    Place place;
  };

  [[nodiscard]] OnLine trace_of(const RandomStream& stream, Place place, double position, double begin,
                                double length) const {
    const Vec2 middle = centre_ + position * perpendicular(along_) + (begin + 0.5 * length) * along_;
    Vec2 direction = along_;
    if (scattered_) {
      const double dip =
          set_.dip + set_.dip_std * inverse_normal_cdf(draw(stream, place.interval, Draw::dip));
      const double dip_direction =
          set_.dip_direction +
          set_.dip_direction_std * inverse_normal_cdf(draw(stream, place.interval, Draw::dip_direction));
      direction = direction_of(apparent_dip(dip, dip_direction, azimuth_));
    }
    return {begin, on_grid(middle - 0.5 * length * direction), on_grid(middle + 0.5 * length * direction),
            place};
  }

  void add_trace(const OnLine& trace) {
    if (++drawn_ > max_traces) refuse(set_, fmt::format("more than {:.0g}", max_traces));
    if (!(trace.a == trace.b) && meets(window_, trace.a, trace.b))
      traces_.push_back({trace.a, trace.b, source_, static_cast<int>(traces_.size()), trace.place.line,
                         trace.place.interval});
  }

  void add_gap(Vec2 a, Vec2 b) {
    if (!(a == b) && meets(window_, a, b)) gaps_.push_back({a, b, source_});
  }

  static Vec2 on_grid(Vec2 p) {
    constexpr double step = 0x1p-30;
    return {round_to(p.x, step), round_to(p.y, step)};
  }

  const JointSet& set_;
  TraceSource source_;
  double azimuth_;
  Box window_;
  std::uint64_t seed_;
  std::uint32_t realization_;
  Vec2 along_;  ///< of the lines; positions across them count along perpendicular(along_)
  Vec2 centre_;
  bool scattered_;
  double factor_ = 1.0;
  double half_along_ = 0.0;   ///< half the stretch of a line that can hold traces of the window, m
  double half_across_ = 0.0;  ///< half the stretch across the lines, m
  double drawn_ = 0.0;        ///< traces so far, with those beside the window
  std::vector<Trace> traces_;
  bool wants_gaps_ = false;
  std::vector<Trace> gaps_;
};

}  // namespace

double expected_traces(const JointSet& set, double section_azimuth, const Box& window) {
  return Generator(set, 0, section_azimuth, window, 0, 0).expected();
}

std::vector<Trace> generate_traces(const JointSet& set, int set_index, double section_azimuth,
                                   const Box& window, std::uint64_t seed, int realization) {
  Generator generator(set, set_index, section_azimuth, window, seed, realization);
  const double expected = generator.expected();
  if (!(expected <= max_traces)) refuse(set, fmt::format("about {:.2g}", expected));
  return generator.run();
}

std::vector<Trace> gaps_of_traces(const JointSet& set, int set_index, double section_azimuth,
                                  const Box& window, std::uint64_t seed, int realization) {
  return Generator(set, set_index, section_azimuth, window, seed, realization).run_for_gaps();
}

}  // namespace keyblock::rockmass
