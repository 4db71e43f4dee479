#pragma once
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/file_set.h"
#include "results/run_data.h"

/// Results in the formats of other programs. Coordinates are real ones (the local origin is added) but in VTK. Blocks that are
/// excavated are left out from then on.
namespace keyblock::results {

enum class ExportFormat {
  vtk,      ///< for ParaView: FOLDER/view.py, and time series of one file per frame
  csv,      ///< FOLDER/blocks.csv, contacts.csv, steps.csv and, where points were chosen, histories.csv
  geojson,  ///< FOLDER/stage_1_NAME.geojson …: the blocks as they lie at the end of each stage
  dxf,      ///< FOLDER/stage_1_NAME.dxf …: the same as drawings, with the joints
};
std::optional<ExportFormat> export_format(std::string_view name);

/// Writes into `folder` (made where it is missing) in the place of an earlier export of this format, and returns the files written,
/// those to open first in front. Throws InputError when there can be no such folder or file, or, unless `replace`, when there are
/// files that are of no export; and RunError when one cannot be written. Then `folder` is as it was before.
std::vector<std::filesystem::path> export_run(const RunData& data, const std::filesystem::path& folder,
                                              ExportFormat format, bool replace = false);

/// VTK XML files, in local coordinates; each has the field data TimeValue, stage, step and origin. Series of them: blocks (cells),
/// outlines (lines), centres (a point per block), contacts (a line per joint that a contact stands for) and forces (a point per
/// contact that carries one); arrays as in docs/result-file.md. The time steps of a series must differ: where time stands still,
/// as in static stages, each frame counts as a microsecond; the true time is TimeValue. view.py opens all in ParaView.
std::vector<std::filesystem::path> export_vtk(const RunData& data, FileSet& out);

/// Tables with one row per block and frame, per contact and contact frame, per recorded step.
std::vector<std::filesystem::path> export_csv(const RunData& data, FileSet& out);

/// RFC 7946 as to its form; the coordinates are those of the section, in metres.
std::vector<std::filesystem::path> export_geojson(const RunData& data, FileSet& out);

/// Drawings in metres: blocks as closed polylines on the layers IN_PLACE, LOOSENED, FALLEN and FIXED, the sides of joints as they lie on JOINT_NAME, of
/// their set or map.
std::vector<std::filesystem::path> export_dxf(const RunData& data, FileSet& out);

}  // namespace keyblock::results
