#include "synthetic_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "core/index.h"
#include "core/random.h"
#include "study/outputs.h"

namespace keyblock::made_up {

namespace {

using record::BlockStatus;
using record::StageKind;

constexpr double radius = 2.75, half_domain = 10.0;
constexpr int columns = 28;

double lot(int realization, std::uint32_t use, std::uint32_t draw) {
  return RandomStream(77, static_cast<std::uint32_t>(realization), use, 0).uniform(draw);
}

/// How easily the rock of a realization falls, and what a single run adds by chance: lognormal.
double severity_of(int realization, double scale, int order, std::uint32_t run) {
  const double rock = 0.5 * inverse_normal_cdf(lot(realization, 1, 0));
  const double chance = 0.2 * inverse_normal_cdf(lot(realization, 2, run));
  return 0.35 * scale * scale * std::exp(rock + chance) * (order == 1 ? 1.0 : 0.7);
}

std::vector<Vec2> outline(Vec2 centre) {
  std::vector<Vec2> ring;
  for (int k = 0; k < 96; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 96.0;
    ring.push_back(centre + Vec2{radius * std::cos(angle), radius * std::sin(angle)});
  }
  return ring;
}

/// Status of rock by its place: rock above the opening falls first, from its rim outwards.
BlockStatus status_at(Vec2 p, double severity, double draw) {
  const double distance = norm(p);
  if (distance < radius) return BlockStatus::excavated;
  const double depth = (distance - radius) / 2.2;
  const double above = p.y / distance;
  const double pull = 1.6 * severity * std::max(0.0, above) + 0.25 * severity;
  if (depth + 0.55 * draw < pull) return BlockStatus::fallen;
  return depth + 0.5 * draw < 1.9 * pull ? BlockStatus::loosened : BlockStatus::in_place;
}

void add_stages(study::RunResult& run, double scale, double severity, bool opening) {
  const auto stage = [&](const char* name, StageKind kind, double share) {
    study::StageMeasures s;
    s.name = name;
    s.kind = kind;
    if (kind == StageKind::shake) {
      s.pga = 1.07 * scale;
      s.pgv = 0.093 * scale;
      s.arias = 0.21 * scale * scale;
    }
    const double x = share * severity;
    s.damage.fallen_area = x < 0.03 ? 0.0 : 4.0 * x;
    s.damage.fallen_weight = 25e3 * s.damage.fallen_area;
    s.damage.largest_fallen_area = 0.4 * s.damage.fallen_area;
    s.damage.largest_fallen_weight = 0.4 * s.damage.fallen_weight;
    s.damage.largest_block_pressure = opening ? 0.4 * s.damage.fallen_weight / 0.5 : std::nan("");
    s.damage.fallen_depth = opening ? 0.3 * s.damage.fallen_area : std::nan("");
    s.damage.fallen_blocks = static_cast<int>(s.damage.fallen_area / 0.2);
    s.damage.opening_filled_ratio = s.damage.fallen_area / 23.8;
    s.damage.loosened_area = 3.0 * std::sqrt(x);
    s.damage.displacement_max = 0.5 * std::sqrt(x);
    s.damage.rotation_max = 30.0 * x;
    s.damage.slip_max = s.damage.slip_max_ever = 0.4 * std::sqrt(x);
    s.damage.slip_mean = 0.004 * x;
    s.damage.slipped_length = 60.0 * x;
    s.damage.opened_length = 25.0 * x;
    s.damage.closure_vertical = 0.02 * x;
    s.damage.closure_horizontal = -0.004 * x;
    run.stages.push_back(s);
  };
  stage("excavated", StageKind::settle, 0.1);
  stage("first earthquake", StageKind::shake, 0.9);
  stage("after", StageKind::rest, 1.0);
}

void add_map(study::RunResult& run, const study::MapGrid& grid, double severity) {
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const Vec2 p = grid.corner + grid.cell * Vec2{i + 0.5, j + 0.5};
      // Neighbouring cells share a block, and with it a draw.
      const auto block = static_cast<std::uint32_t>(100 * (j / 3) + i / 3);
      run.map.push_back(status_at(p, severity, lot(run.realization, 3, block)));
    }
  }
}

}  // namespace

study::StudyData synthetic_study(const SyntheticStudyOptions& options) {
  study::StudyData study;
  study.title = "Tunnel <synthetic> & shaken";
  study.seed = 18446744073709551615ULL;
  study.version = "0.1.0";
  study.axes = {{"stage.'first earthquake'.scale", options.scales}, {"rock.order", options.orders}};
  study.stage = "after";
  study.before = "excavated";
  study.at_shaking = true;
  if (options.since) study.since = "excavated";
  if (options.levels)
    study.levels = {{"light", "fallen_area_m2", 0.25},
                    {"moderate", "fallen_area_m2", 0.8},
                    {"severe", "fallen_area_m2", 6.0}};
  if (options.variants) {
    study.marginal = study::MarginalCheck{};
    study.variants = {"friction-", "friction+", "released"};
  }
  study.precision = study::Precision{"fallen_area_m2", 0.1, std::nullopt};
  if (options.opening) {
    study.outlines = {outline({0.0, 0.0})};
    study.ground = {{"opening “tunnel”", "circle, 5.5 m wide, 5.5 m high"}};
  }
  study.ground.push_back({"unit weight γ", "22.27 kN/m³ (2270 kg/m³)"});
  study.ground.push_back({"joints: friction φ", "30°"});
  if (options.map) study.grid = {{-5.5, -5.5}, 0.275, 40, 40};
  for (int r = 0; r < options.realizations; ++r) {
    std::uint32_t place = 0;
    for (const std::string& scale : options.scales) {
      for (const std::string& order : options.orders) {
        const double s = std::strtod(scale.c_str(), nullptr);
        const double severity = severity_of(r, s, std::atoi(order.c_str()), place);
        std::vector<std::string> variants{""};
        if (options.variants && r < 20) variants = {"", "friction-", "friction+", "released"};
        for (const std::string& variant : variants) {
          ++study.planned;
          study::RunResult run;
          run.key = fmt::format("r{}-s{}-o{}{}", r, scale, order, variant);
          run.realization = r;
          run.values = {scale, order};
          run.variant = variant;
          run.blocks = 700 + r % 50;
          run.steps = 22'000 + r;
          run.wall_time = 13.0 + 0.1 * r;
          run.state_hash = "00ff";
          run.max_overlap = 2e-5;
          run.energy_residual_ratio = 1e-6;
          const bool fails = options.failures && (r == 7 || (r == 23 && order == "2")) && place < 3;
          if (options.failures && r == options.realizations - 1 && scale == options.scales.back()) continue;
          if (fails) {
            run.error =
                r == 7 ? "killed by signal 9" : "a step did not converge, \"first earthquake\", t = 3.2 s";
          } else {
            const double factor = variant == "friction-"   ? 1.0 + 1.5 * lot(r, 4, place)
                                  : variant == "friction+" ? 0.8
                                                           : 1.0;
            add_stages(run, s, factor * severity, options.opening);
            if (options.map) add_map(run, study.grid, factor * severity);
          }
          study.runs.push_back(std::move(run));
        }
        ++place;
      }
    }
  }
  return study;
}

std::pair<record::ModelRecord, record::Frame> synthetic_tunnel(int realization, double severity) {
  record::ModelRecord model;
  record::Frame frame;
  model.excavation_outlines = {outline({0.0, 0.0})};
  model.opening_width = 2.0 * radius;
  const double size = 2.0 * half_domain / columns;
  const auto corner = [&](int i, int j) {
    const auto draw = static_cast<std::uint32_t>(1000 * j + i);
    const bool inside = i > 0 && j > 0 && i < columns && j < columns;
    const Vec2 shift =
        inside ? 0.6 * size * Vec2{lot(realization, 5, draw) - 0.5, lot(realization, 6, draw) - 0.5} : Vec2{};
    Vec2 p = Vec2{-half_domain + size * i, -half_domain + size * j} + shift;
    // Blocks at the rim end there.
    const double distance = norm(p);
    if (std::abs(distance - radius) < 0.5 * size) p = (radius / distance) * p;
    return p;
  };
  double floor = -radius;
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < columns; ++i) {
      const Vec2 ring[] = {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
      record::ModelRecord::Block block;
      block.centroid = 0.25 * (ring[0] + ring[1] + ring[2] + ring[3]);
      block.area = 0.5 * std::abs(cross(ring[2] - ring[0], ring[3] - ring[1]));
      const int first = static_cast<int>(model.vertices.size());
      block.ring_start = {first, first + 4};
      const BlockStatus status =
          status_at(block.centroid, severity, lot(realization, 3, static_cast<std::uint32_t>(100 * j + i)));
      Vec2 u;
      if (status == BlockStatus::fallen) {
        const double x = std::clamp(0.8 * block.centroid.x, -2.0, 2.0);
        u = Vec2{x, -std::sqrt(radius * radius - x * x) + 0.4 + 0.3 * (floor + radius)} - block.centroid;
        floor += 0.25;
      } else if (status == BlockStatus::loosened) {
        u = {0.0, -0.12};
      }
      for (const Vec2 p : ring) {
        model.vertices.push_back(p);
        frame.displacement.push_back({static_cast<float>(u.x), static_cast<float>(u.y)});
      }
      model.blocks.push_back(std::move(block));
      frame.status.push_back(status);
    }
  }
  return {std::move(model), std::move(frame)};
}

void write_synthetic_pictures(const std::filesystem::path& directory, const study::StudyData& study,
                              const SyntheticStudyOptions& options) {
  for (const study::RunResult& run : study.runs) {
    if (at(run.realization) >= options.pictures || !run.error.empty() || !run.variant.empty()) continue;
    const auto [model, frame] = synthetic_tunnel(run.realization, run.stages.back().damage.fallen_area / 4.0);
    const std::filesystem::path folder = directory / "runs" / run.key;
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "thumbnail.svg") << study::thumbnail_svg(model, frame);
    std::ofstream(folder / "report.html") << "<!doctype html><title>" << run.key << "</title>";
  }
}

}  // namespace keyblock::made_up
