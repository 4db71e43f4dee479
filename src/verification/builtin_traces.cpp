#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "core/atomic_file.h"
#include "core/checked_json.h"
#include "core/error.h"
#include "cutting/topology.h"
#include "rockmass/section.h"
#include "rockmass/trace_generator.h"
#include "rockmass/trace_map.h"
#include "verification/builtin.h"
#include "verification/reference_distribution.h"

namespace keyblock::verification {
namespace {

using rockmass::Distribution;
using rockmass::JointSet;
using rockmass::Trace;
using enum rockmass::DistributionKind;

constexpr double azimuth = 165.0;
constexpr int realizations = 60;
constexpr std::uint64_t drawn_seed = 2001;
constexpr double snapping = 0.001;  // m, as in the published counts
const Box window{{-10.0, -10.0}, {10.0, 10.0}};

struct NamedSet {
  const char* name;
  JointSet set;
};

JointSet joint_set(double dip, double direction, Distribution spacing, Distribution length,
                   Distribution gap) {
  JointSet set;
  set.name = "J";
  set.dip = dip;
  set.dip_direction = direction;
  set.spacing = spacing;
  set.length = length;
  set.gap = gap;
  return set;
}

/// Those of Hsiung & Shi (2001), and two with other distributions.
std::vector<NamedSet> joint_sets() {
  return {
      {"paper_1", joint_set(79, 270, {uniform, 0.3, 0.105}, {uniform, 1.8, 0.63}, {uniform, 0.4, 0.14})},
      {"paper_2", joint_set(81, 230, {uniform, 0.3, 0.105}, {uniform, 2.4, 0.84}, {uniform, 0.3, 0.105})},
      {"paper_3", joint_set(5, 165, {uniform, 0.5, 0.175}, {uniform, 1.8, 0.63}, {uniform, 0.5, 0.175})},
      {"skewed", joint_set(40, 120, {exponential, 0.3, 0.0}, {lognormal, 1.0, 0.7}, {exponential, 0.5, 0.0})},
      {"cut_off", joint_set(60, 350, {lognormal, 0.4, 0.3}, {normal, 1.5, 0.5}, {normal, 0.5, 0.4})}};
}

struct Samples {
  std::vector<double> spacings, lengths, gaps;
};

// Those whose place, which does not depend on their size, is well inside the window, so that none is missed.
void add_samples(const JointSet& set, const std::vector<Trace>& traces, Samples& samples) {
  constexpr double micrometres = 1e6;
  const double angle = rockmass::radians(rockmass::apparent_dip(set.dip, set.dip_direction, azimuth));
  const Vec2 along{std::cos(angle), -std::sin(angle)};
  const double factor = rockmass::trace_spacing_factor(set.dip, set.dip_direction, azimuth);
  const auto inner = [](double position) { return std::abs(position) < 5.0; };
  std::map<long, std::map<double, double>> lines;  // position across (µm) → begin → end
  for (const Trace& trace : traces) {
    lines[std::lround(micrometres * cross(along, trace.a))][dot(along, trace.a)] = dot(along, trace.b);
  }
  for (auto line = lines.begin(); line != lines.end(); ++line) {
    const double position = static_cast<double>(line->first) / micrometres;
    if (!inner(position)) continue;
    if (const auto next = std::next(line); next != lines.end()) {
      samples.spacings.push_back((static_cast<double>(next->first) / micrometres - position) / factor);
    }
    for (auto trace = line->second.begin(); trace != line->second.end(); ++trace) {
      const auto [begin, end] = *trace;
      if (inner(0.5 * (begin + end))) samples.lengths.push_back(end - begin);
      if (const auto next = std::next(trace); inner(end) && next != line->second.end()) {
        samples.gaps.push_back(next->first - end);
      }
    }
  }
}

// The outer ring of the first polygon of a GeoJSON file.
Ring read_area(const std::filesystem::path& file) {
  try {
    const auto json = nlohmann::json::parse(read_file(file));
    Ring ring;
    for (const auto& p : json.at("features").at(0).at("geometry").at("coordinates").at(0)) {
      ring.push_back({p.at(0).get<double>(), p.at(1).get<double>()});
    }
    return ring;
  } catch (const nlohmann::json::exception&) {
    Diagnostic diagnostic;
    diagnostic.where.file = file.string();
    diagnostic.found = "something else";
    diagnostic.expected = "GeoJSON whose first feature is a polygon";
    throw InputError(std::move(diagnostic));
  }
}

}  // namespace

BuiltinResults trace_statistics(const std::vector<std::filesystem::path>&) {
  BuiltinResults results;
  std::size_t smallest = std::numeric_limits<std::size_t>::max();
  for (const auto& [name, set] : joint_sets()) {
    Samples samples;
    for (int realization = 0; realization < realizations; ++realization) {
      add_samples(set, rockmass::generate_traces(set, 0, azimuth, window, drawn_seed, realization), samples);
    }
    smallest = std::min({smallest, samples.spacings.size(), samples.lengths.size(), samples.gaps.size()});
    results[std::string(name) + "_spacing"] = kolmogorov_smirnov(samples.spacings, set.spacing);
    results[std::string(name) + "_length"] = kolmogorov_smirnov(samples.lengths, set.length);
    results[std::string(name) + "_gap"] = kolmogorov_smirnov(samples.gaps, set.gap);
  }
  results["smallest_sample"] = static_cast<double>(smallest);
  return results;
}

BuiltinResults trace_topology(const std::vector<std::filesystem::path>& data) {
  if (data.size() != 2) {
    Diagnostic diagnostic;
    diagnostic.where.file = "trace_topology";
    diagnostic.found = std::to_string(data.size()) + " files in data";
    diagnostic.expected = "two: the traces and the area";
    throw InputError(std::move(diagnostic));
  }
  const auto counts =
      cutting::count_nodes(rockmass::read_trace_map(data[0], 0), read_area(data[1]), snapping);
  return {{"isolated", counts.isolated}, {"crossing", counts.crossing}, {"abutting", counts.abutting},
          {"boundary", counts.boundary}, {"branches", counts.branches}, {"length_m", counts.length}};
}

}  // namespace keyblock::verification
