#include "study/measure_observer.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/index.h"
#include "record/standing.h"

namespace keyblock::study {
namespace {

using record::BlockStatus;

// Where the outlines of a block cross the horizontal line at y, ascending. A vertex on the line counts as above it.
std::vector<double> crossings(const record::ModelRecord& model, const record::ModelRecord::Block& block,
                              double y) {
  std::vector<double> x;
  for (std::size_t r = 0; r + 1 < block.ring_start.size(); ++r) {
    const int begin = block.ring_start[r], end = block.ring_start[r + 1];
    for (int k = begin; k < end; ++k) {
      const Vec2 a = model.vertices[at(k)];
      const Vec2 b = model.vertices[at(k + 1 < end ? k + 1 : begin)];
      if ((a.y >= y) == (b.y >= y)) continue;
      x.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
  }
  std::sort(x.begin(), x.end());
  return x;
}

}  // namespace

std::vector<int> blocks_of_cells(const MapGrid& grid, const record::ModelRecord& model, std::size_t blocks) {
  std::vector<int> cells(at(grid.columns) * at(grid.rows), -1);
  const Vec2 corner = grid.corner - model.origin;
  // The first cell whose centre lies at or beyond a coordinate, within 0 … count.
  const auto first_beyond = [&](double x, double start, int count) {
    return static_cast<int>(
        std::clamp(std::ceil((x - start) / grid.cell - 0.5), 0.0, static_cast<double>(count)));
  };
  for (std::size_t b = 0; b < std::min(blocks, model.blocks.size()); ++b) {
    const auto& block = model.blocks[b];
    Box box;
    for (int k = block.ring_start.front(); k < block.ring_start.back(); ++k) box.add(model.vertices[at(k)]);
    const int top = first_beyond(box.max.y, corner.y, grid.rows);
    for (int row = first_beyond(box.min.y, corner.y, grid.rows); row < top; ++row) {
      const std::vector<double> x = crossings(model, block, corner.y + (row + 0.5) * grid.cell);
      for (std::size_t k = 0; k + 1 < x.size(); k += 2) {
        const int end = first_beyond(x[k + 1], corner.x, grid.columns);
        for (int column = first_beyond(x[k], corner.x, grid.columns); column < end; ++column) {
          cells[at(row) * at(grid.columns) + at(column)] = static_cast<int>(b);
        }
      }
    }
  }
  return cells;
}

void MeasureObserver::begin(const record::ModelRecord& model) {
  model_ = model;
  result_.blocks = static_cast<int>(blocks_);
  for (const record::DrawnStrength& drawn : model.strengths)
    result_.strengths.emplace_back(drawn.name(), drawn.mean);
  double area = 0.0, moving = 0.0;
  for (const auto& block : std::span(model.blocks).first(std::min(blocks_, model.blocks.size()))) {
    if (block.fixed) continue;
    area += block.area;
    ++moving;
  }
  result_.block_size = moving > 0.0 ? std::sqrt(area / moving) : 0.0;
  fell_.assign(blocks_, -1);
}

std::string MeasureObserver::name_of(int block) const {
  return block < 0 ? std::string() : model_.blocks[at(block)].name;
}

void MeasureObserver::stage_begin(int /*index*/, const record::StageRecord& stage) {
  mechanism_ = {};
  stage_begins_ = stage.stage.kind == record::StageKind::settle;
}

void MeasureObserver::frame(const record::Frame& frame) {
  last_ = frame;
  if (stage_begins_) mechanism_.start = frame;
  stage_begins_ = false;
}

void MeasureObserver::contacts(const record::ContactFrame& frame) {
  if (mechanism_.is_known()) mechanism_.contacts = frame.contacts;
}

void MeasureObserver::add_record(const record::Stage& stage, StageMeasures& measures) const {
  if (stage.kind != record::StageKind::shake || stage.motion < 0 || at(stage.motion) >= records_.size())
    return;
  const auto& [name, record] = records_[at(stage.motion)];
  const double scale = std::abs(stage.scale);
  measures.record = name;
  measures.pga_rotd50 = scale * record.pga;
  measures.pgv_rotd50 = scale * record.pgv;
  measures.sa_03_rotd50 = scale * record.sa_03;
  measures.sa_10_rotd50 = scale * record.sa_10;
}

void MeasureObserver::stage_end(int index, const record::StageRecord& stage) {
  if (stage.moving.empty()) mechanism_ = {};
  if (stage.interrupted) return;
  StageMeasures measures;
  measures.name = stage.stage.name;
  measures.kind = stage.stage.kind;
  measures.pga = stage.pga;
  measures.pgv = stage.pgv;
  measures.arias = stage.arias;
  measures.damage = stage.damage;
  measures.standing = record::standing_of(stage, loosened_, !model_.excavation_names.empty());
  measures.movers = stage.movers;
  measures.heaviest = name_of(stage.movers.heaviest);
  add_record(stage.stage, measures);
  result_.stages.push_back(std::move(measures));
  fallen_ = stage.fallen;
  std::vector<int> fell(blocks_, -1);
  for (const record::FallenBlock& block : fallen_)
    fell[at(block.block)] = fell_[at(block.block)] < 0 ? index : fell_[at(block.block)];
  fell_ = std::move(fell);
}

void MeasureObserver::end(const record::RunRecord& run) {
  result_.steps = run.steps;
  result_.wall_time = run.wall_time;
  result_.state_hash = run.state_hash;
  result_.unconverged_steps = run.open_close.unconverged_steps;
  result_.max_overlap = run.max_overlap.depth;
  result_.energy_residual_ratio = run.energy.residual_ratio;
  for (const record::FallenBlock& f : fallen_) {
    const auto& block = model_.blocks[at(f.block)];
    result_.fallen.push_back({f.block, block.name, fell_[at(f.block)], block.centroid + model_.origin, f.area,
                              f.weight, f.depth, f.part});
  }
  for (const int b : blocks_of_cells(grid_, model_, blocks_)) {
    const auto k = at(b);
    result_.map.push_back(b < 0 || k >= last_.status.size() ? BlockStatus::in_place : last_.status[k]);
  }
}

}  // namespace keyblock::study
