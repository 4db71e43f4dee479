#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "loading/intensity_measures.h"
#include "record/record.h"
#include "study/outputs.h"
#include "study/run_result.h"

namespace keyblock::study {

/// A ground motion of the scenario, unscaled.
struct ShakingRecord {
  std::string name;
  loading::HorizontalMeasures measures;
};

/// Gathers the measures of a run. A block fell in the first stage from whose end on it has always counted as fallen.
class MeasureObserver : public record::RunObserver {
 public:
  /// Fills `result` (except for key, realization, values, variant and error), which must outlive the run. The first `blocks`
  /// blocks of the model are the rock; a frame comes after them. loosened: m, of DamageLimits. records: the ground motions.
  MeasureObserver(RunResult& result, const MapGrid& grid, std::size_t blocks, double loosened,
                  std::vector<ShakingRecord> records = {})
      : result_(result), grid_(grid), blocks_(blocks), loosened_(loosened), records_(std::move(records)) {}

  void begin(const record::ModelRecord& model) override;
  void stage_begin(int index, const record::StageRecord& stage) override;
  void frame(const record::Frame& frame) override;
  void contacts(const record::ContactFrame& frame) override;
  void stage_end(int index, const record::StageRecord& stage) override;
  void end(const record::RunRecord& run) override;

  [[nodiscard]] const record::ModelRecord& model() const { return model_; }
  [[nodiscard]] const record::Frame& last_frame() const { return last_; }
  /// Of the last stage, where it is static and blocks move in it; else not known.
  [[nodiscard]] const Mechanism& mechanism() const { return mechanism_; }

 private:
  [[nodiscard]] std::string name_of(int block) const;
  /// Name of the record, and its measures times the scale.
  void add_record(const record::Stage& stage, StageMeasures& measures) const;

  RunResult& result_;
  MapGrid grid_;
  std::size_t blocks_;
  double loosened_;
  std::vector<ShakingRecord> records_;
  record::ModelRecord model_;
  record::Frame last_;
  Mechanism mechanism_;
  bool stage_begins_ = false;
  std::vector<int> fell_;                    ///< stage of every block; −1: has not fallen
  std::vector<record::FallenBlock> fallen_;  ///< at the end of the last stage
};

/// Of every cell of the grid, row by row from the lower left, the index of the block in whose reference outline its centre
/// lies, among the first `blocks` of the model; −1 where there is none.
std::vector<int> blocks_of_cells(const MapGrid& grid, const record::ModelRecord& model, std::size_t blocks);

}  // namespace keyblock::study
