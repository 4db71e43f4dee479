#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "loading/ground_motion.h"
#include "loading/intensity_measures.h"
#include "rockmass/trace.h"
#include "scenario/scenario.h"
#include "simulation/setup.h"

/// The files that a scenario names. A mistake inside a file is reported at its place there, one in what the scenario
/// says about the file at its place in the scenario. All mistakes are thrown as one InputError.
namespace keyblock::scenario {

/// Paths of all files that the scenario names, each once, in their order.
std::vector<std::filesystem::path> input_paths(const Scenario& scenario);

/// The same files as a run records them: paths from the folder of the scenario, and what their contents hash to.
std::vector<simulation::InputFile> input_files(const Scenario& scenario);

/// The traces of all [[trace_map]], each with its index.
/// `strengths`, if given, receives those of the traces of each map (rockmass::read_trace_map);
/// Those of a tessellation are those of the realization. `skipped` receives what of drawings is no line, in words.
std::vector<rockmass::Trace> read_trace_maps(
    const Scenario& scenario, std::vector<std::vector<rockmass::TraceStrength>>* strengths = nullptr,
    std::vector<std::string>* skipped = nullptr, int realization = 0);

/// All [[motion]], in the order of the scenario: records read, projected on the section and cut to their window,
/// tables and sines as they are; unscaled. What the user should know is added to `warnings`: notes of the readers,
/// directions that are not those the files name.
/// Those of a suite that are turned have the angle of the realization.
std::vector<loading::GroundMotion> read_motions(const Scenario& scenario, std::vector<std::string>& warnings,
                                                int realization = 0);

/// A record in its window, as it is measured.
struct MeasuredRecord {
  std::optional<loading::GroundMotion> horizontal;  ///< loading::horizontal_motion
  double azimuth = 0.0;                             ///< °, of the first horizontal component
  loading::GroundMotion section;
};
MeasuredRecord measured_record(const Scenario& scenario, const MotionSpec& spec);

/// RotD50 of the records of all [[motion]], in their order, over the window and after their baseline and target; unscaled. No numbers of what
/// has no two horizontal components.
std::vector<loading::HorizontalMeasures> horizontal_measures(const Scenario& scenario);

/// What seems wrong with a scenario that can be run: K0 below 1/3, an excavation that no stage takes out, … Reads no
/// files.
std::vector<std::string> plausibility_warnings(const Scenario& scenario);

/// Those of them that concern joints and the outlines of excavations, for who only cuts.
std::vector<std::string> rock_mass_warnings(const Scenario& scenario);

/// What seems wrong with [study]: realizations where nothing is random.
std::vector<std::string> study_warnings(const Scenario& scenario);

/// plausibility_warnings, and what reading the files has to say, for `keyblock check`: returns the warnings, throws the mistakes of
/// all files together.
std::vector<std::string> check_inputs(const Scenario& scenario);

}  // namespace keyblock::scenario
