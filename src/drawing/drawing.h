#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec2.h"

/// Drawings: polylines on layers, as programs of computer-aided design and maps write them.
namespace keyblock::drawing {

/// One polyline, coordinates as in the file. Curves are chords of at most chord_angle.
struct DrawnLine {
  std::vector<Vec2> vertices;  ///< a first one that is repeated at the end is not kept
  bool closed = false;         ///< the last vertex is joined to the first
  std::string layer;
  std::string entity;  ///< as the format calls it: LWPOLYLINE
  int line = 0;        ///< of the file, where it begins; of a shapefile the number of the record
};

/// Entities of one kind on one layer that are no lines, or lines that are not read.
struct Skipped {
  std::string entity, layer;
  int count = 0;
  int line = 0;  ///< of the first one
};

struct Drawing {
  std::string file;
  std::vector<DrawnLine> lines;  ///< in the order of the file
  std::vector<Skipped> skipped;
  std::vector<std::string> layers;  ///< of the lines, in the order of their first use; none in a shapefile
  std::optional<double> unit;       ///< m; where the file names one
};

/// Degrees of a chord of arcs: a circle has 96, as those of excavations.
inline constexpr double chord_angle = 3.75;

/// How a drawing is laid into the section: p' = scale R(rotate) (p − origin).
struct Placement {
  std::optional<double> scale;  ///< m per unit of the file; none: the unit that the file names, else 1
  Vec2 origin{};                ///< m in the section are [0, 0] here, in coordinates of the file
  double rotate = 0.0;          ///< degrees, counter-clockwise

  [[nodiscard]] bool operator==(const Placement&) const = default;
  /// Precondition: scale.
  [[nodiscard]] Vec2 operator()(Vec2 p) const;
};

/// By the first bytes.
bool is_dxf(std::string_view text);
bool is_binary_dxf(std::string_view text);
bool is_shapefile(std::string_view text);

/// An ASCII drawing (Autodesk DXF Reference, R12 and later): LINE, LWPOLYLINE and POLYLINE with bulges, ARC, CIRCLE, ELLIPSE, SPLINE by control
/// points, and these in block references (INSERT), in model space. Heights are ignored; planes seen from below are mirrored. What is on layer 0 of a
/// block lies on the layer of its reference. Layers that are off or frozen count like others.
///
/// Throws InputError: group codes or numbers that are none, a file that ends early, blocks that hold themselves, far too many
/// vertices.
Drawing read_dxf(std::string_view text, const std::string& file);

/// The main file (.shp) of a shapefile (ESRI 1998): PolyLine and Polygon, also those with Z or M, of which x and y are read. Throws InputError.
Drawing read_shapefile(std::string_view text, const std::string& file);

/// One or the other, by its first bytes. Throws InputError for anything else.
Drawing read_drawing(std::string_view text, const std::string& file);

/// The lines on these layers, capitals or not; without layers all. Throws InputError: a layer without lines, no line at all.
std::vector<DrawnLine> lines_on(const Drawing& drawing, const std::vector<std::string>& layers);

/// m per unit: of the placement, of the file, else 1. Throws InputError for a drawing that names no unit and is too large to be in metres.
double scale_of(const Drawing& drawing, const std::vector<DrawnLine>& lines, const Placement& placement);

/// What was skipped on these layers (without: on all), in words; empty where nothing was.
std::string skipped_words(const Drawing& drawing, const std::vector<std::string>& layers);

}  // namespace keyblock::drawing
