#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/polygon.h"
#include "scenario/ground_facts.h"
#include "scenario/scenario.h"
#include "study/run_result.h"
#include "study/variant.h"

namespace keyblock::study {

inline constexpr double most_cells = 1e6;  ///< of a map

/// One run: a realization × a value on every axis × a variant.
struct PlannedRun {
  std::string key;  ///< see run_key
  int realization = 0;
  std::vector<std::vector<std::string>> values;  ///< of every axis, of each of its keys, as TOML
  std::string variant;
  /// False: an earlier plan of the same folder had it, the scenario asks for it no more. It keeps its place, so that the
  /// index of a run never changes.
  bool wanted = true;
  std::string control = {};  ///< key of its control run (see control_places); empty: it has none
};

/// A scenario as it is written.
struct ScenarioText {
  std::string text;
  std::filesystem::path file;
  std::vector<std::string> overrides;
};
/// Reads the file. Throws InputError.
ScenarioText read_scenario_text(const std::filesystem::path& file, std::vector<std::string> overrides);

/// A file that a scenario reads, as it was when the study was planned.
struct InputFile {
  std::string name;  ///< path from the folder of the scenario
  std::string hash;
};

/// All that is to be run, and what a reader of the results needs beside them.
struct Plan {
  std::filesystem::path scenario;  ///< the file; paths in the text are relative to its folder
  std::string text;                ///< of it
  std::vector<std::string> overrides;
  std::string version;
  std::string input;  ///< scenario_identity
  std::vector<InputFile> files;

  std::string title;
  std::uint64_t seed = 0;
  int realizations = 1;  ///< with `until`, the most
  int strata = 0;        ///< rockmass::Sampling; the number of realizations, or 0: they are independent
  std::vector<scenario::VarySpec> axes;
  std::string stage;  ///< at whose end measures are compared
  std::string since;  ///< at whose end they begin; empty: the first excavation
  /// The last stage before the shaking (record/before_shaking.h); empty: there is none, or none before `stage`.
  std::string before_shaking;
  std::vector<DamageLevel> levels;
  std::optional<MarginalCheck> marginal;
  bool control = false;  ///< every rock mass has a run without shaking (variant.h: unshaken)
  double confidence = 0.95;
  std::optional<scenario::UntilSpec> until;
  scenario::Keep keep = scenario::Keep::report;
  MapGrid grid;
  std::vector<Ring> outlines;
  std::vector<scenario::GroundFact> ground;  ///< of all combinations
  std::vector<std::string> warnings;  ///< of a limit: what seems wrong with the scenario and the search

  std::vector<PlannedRun> runs;

  [[nodiscard]] std::size_t wanted() const;
};

/// Reads the scenario and lists its runs by realization, then combination (the first axis changes most slowly), then
/// variant: the first part of a plan is a smaller study. A scenario without [study] is a study of one run. All
/// combinations see the same joints, as these depend on seed and realization alone.
///
/// `warnings`, if given, receives what seems wrong with the scenario, before it is cut, and with the study. Throws InputError with every mistake of the scenario, of its
/// combinations and of their files, and for more than a million runs.
Plan make_plan(const std::filesystem::path& scenario, const std::vector<std::string>& overrides,
               const std::string& version, std::vector<std::string>* warnings = nullptr);
/// The same of a scenario at hand: its text, and the file from whose folder its paths count, which need not be there.
Plan make_plan(const ScenarioText& scenario, const std::string& version,
               std::vector<std::string>* warnings = nullptr);

/// The name of a run and of its folder: `r0007-5d2c81a0f3`, the realization and a hash (FNV-1a, 64 bit, its first ten
/// digits) of the overrides `key=value` in the order of their text, keys and values written in one way, and of the variant. It
/// depends neither on the other runs nor on the order of axes and values.
std::string run_key(int realization, const std::vector<std::string>& overrides, const std::string& variant);

VariantTerms variant_terms(const Plan& plan);

/// Of every run that has one, the place of its control run: that of the same rock mass, without shaking. −1: none.
///
/// Combinations that differ in scales of shaking alone have one rock mass, and one control run; its values on axes of such
/// scales are 0.
std::vector<std::ptrdiff_t> control_places(const Plan& plan);

/// `key=value` of every key of every axis.
std::vector<std::string> overrides_of(const Plan& plan, const PlannedRun& run);

/// The runs of `earlier` in their places, then those that `plan` has beyond them. What `plan` does not have is kept as not
/// wanted.
void keep_places(const std::vector<PlannedRun>& earlier, Plan& plan);

/// The raster of the places around the openings: the box of all outlines, grown by the width of the opening (the first
/// excavation) and cut to the domain; cells of width/40 unless given. Without excavations: the box of the domain or of the
/// blocks, 80 cells along its longer side. Throws InputError for more than a million cells.
MapGrid map_grid(const scenario::Scenario& scenario);

/// Those of the scenario; by default 0.2, 2 and 10 % of the area of the openings fallen ("light", "moderate",
/// "severe"), and without openings "any": a block has fallen.
std::vector<DamageLevel> damage_levels(const scenario::Scenario& scenario);

/// The name of a file in Plan::files.
std::string input_name(const std::filesystem::path& scenario, const std::filesystem::path& file);

/// Hash of a scenario with its overrides and without [study]. `file` is for messages.
std::string scenario_identity(const std::string& text, const std::filesystem::path& file,
                              const std::vector<std::string>& overrides);

/// Content hash, 16 hexadecimal digits.
std::string hash_text(std::string_view content);

}  // namespace keyblock::study
