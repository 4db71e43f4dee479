#pragma once
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/file_set.h"
#include "results/run_data.h"

/// Results in the formats of other programs. Coordinates are real ones (the local origin is added). Blocks that are
/// excavated are left out from then on.
namespace keyblock::results {

enum class ExportFormat {
  vtk,      ///< for ParaView: FOLDER/blocks.pvd and contacts.pvd, time series of one file per frame
  csv,      ///< FOLDER/blocks.csv, contacts.csv, steps.csv and, where points were chosen, histories.csv
  geojson,  ///< FOLDER/stage_1_NAME.geojson …: the blocks as they lie at the end of each stage
};
std::optional<ExportFormat> export_format(std::string_view name);

/// Writes into `folder` (made where it is missing) in the place of an earlier export of this format, and returns the files written,
/// those to open first in front. Throws InputError when there can be no such folder or file, or, unless `replace`, when there are
/// files that are of no export; and RunError when one cannot be written. Then `folder` is as it was before.
std::vector<std::filesystem::path> export_run(const RunData& data, const std::filesystem::path& folder,
                                              ExportFormat format, bool replace = false);

/// VTK XML files. Blocks are polygons, those with holes sets of triangles, with point data `displacement` (m) and cell
/// data `block`, `status`, `stress` (xx, yy, xy; Pa), `displacement_magnitude` (m, of the centroid), `order` and
/// `excavation` (−1: none). Contacts are lines as long as the joint that belongs to them, with `state`, `slip`, `gap`,
/// `normal_force`, `shear_force`, `block_a`, `block_b`, `edge_kind` and `edge_index`. The time steps of a series must
/// differ: where time stands still, as in static stages, each frame counts as a microsecond; the true time, stage and
/// step stand in the field data TimeValue, stage and step of each file.
std::vector<std::filesystem::path> export_vtk(const RunData& data, FileSet& out);

/// Tables with one row per block and frame, per contact and contact frame, per recorded step.
std::vector<std::filesystem::path> export_csv(const RunData& data, FileSet& out);

/// RFC 7946 as to its form; the coordinates are those of the section, in metres.
std::vector<std::filesystem::path> export_geojson(const RunData& data, FileSet& out);

}  // namespace keyblock::results
