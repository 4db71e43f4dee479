#pragma once
#include <string>

#include "report/array_pack.h"
#include "results/run_data.h"

namespace keyblock::report {

/// What the page is given beside its program.
struct PageData {
  std::string header;  ///< JSON; holds no '<', so that it can stand in a script element
  std::string arrays;  ///< ArrayPack::encoded()
};

PageData make_page_data(const results::RunData& run);

/// The arrays of the page. n(x) is the number of x; "codec" is encode_frames.
///
/// | name | type | numbers | what |
/// |---|---|---|---|
/// | ring.begin, ring.end | u32 | n(rings) | display vertices of a ring |
/// | ring.block | u32 | n(rings) | its block |
/// | vertex.position | f32 | 2 n(vertices) | x, y in reference position, m |
/// | edge.kind, edge.index | u8, i32 | n(vertices) | label of the piece from here to the next vertex |
/// | block.order, block.fixed | u8 | n(blocks) | order at the end; whether fixed |
/// | block.area, block.density | f32 | n(blocks) | m², kg/m³ |
/// | frame.time, frame.step | f64 | n(frames) | s; steps since the start of the run |
/// | frame.stage | i32 | n(frames) | |
/// | frame.status | u8 | n(frames) n(blocks) | BlockStatus |
/// | frame.displacement | u8 | codec | columns: x of all vertices, then y; displacement_quantum |
/// | frame.stress | u8 | codec | columns: xx of all blocks, then yy, xy; stress_quantum |
/// | snapshot.frame | u32 | n(snapshots) | frame from which a contact snapshot holds |
/// | snapshot.begin | u32 | n(snapshots) + 1 | its joint pieces |
/// | piece.vertex | u32 | n(pieces) | see results::JointPiece |
/// | piece.from, piece.to | u8 | n(pieces) | shares in 1/255 |
/// | piece.state | u8 | n(pieces) | ContactState |
/// | piece.slip, piece.gap | f32 | n(pieces) | m |
/// | frame.velocity | u8 | codec | columns: x of all blocks, then y; velocity_quantum; not in files without velocities |
/// | chain.begin | u32 | n(snapshots) + 1 | force chains of a snapshot: picture::ForceChain |
/// | chain.block | u32 | 2 n(chains) | the two blocks |
/// | chain.middle | f32 | 2 n(chains) | x, y of the resultant, m |
/// | chain.force | f32 | n(chains) | N per thickness |
/// | chain.hinge | u8 | n(chains) | whether the resultant is at an end of the joint |
/// | history.time | f64 | rows | s |
/// | element.reference | f32 | 4 n(elements) | ends before the run, x and y of both, m; not in runs without elements, as all of these |
/// | element.ends | f32 | 4 n(elements) n(frames) | m |
/// | element.numbers | f32 | 3 n(elements) n(frames) | the first three of record::element_state_fields of each |
/// | element.present | u8 | n(elements) n(frames) | |
/// | history.values | f32 | (1 + 9 n(points) + 2 n(element histories)) rows | by column: step; record::history_fields of each point; record::element_history_fields of each that follows an element |
/// | step.step | f64 | rows | steps since the start of the run |
/// | step.values | f32 | n(step_columns) rows | by column, as step_columns in the header names them |
/// | motion.K.time, .x, .y | f64, f32, f32 | samples | of stage K; s since the start of the run, m/s² |
ArrayPack page_arrays(const results::RunData& run);

/// Resolution of the displacements in the page, m: 10^-7 of the model's size, finer where all displacements
/// are small, and coarser where a block flies too far to be told in most_quanta.
double displacement_quantum(const results::RunData& run);

/// Resolution of the stresses in the page, Pa: a thousandth of their typical (median) size.
double stress_quantum(const results::RunData& run);

/// Resolution of the velocities in the page, m/s: a hundredth of that of a typical arrow, which no eye can tell.
double velocity_quantum(const results::RunData& run);

/// Facts as JSON: see interface Header in viewer/src/data.ts, field by field.
std::string page_header(const results::RunData& run, const ArrayPack& arrays);

}  // namespace keyblock::report
