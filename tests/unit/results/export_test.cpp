#include "results/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <tuple>

#include "../fresh_folder.h"
#include "core/atomic_file.h"
#include "core/checked_json.h"
#include "core/error.h"
#include "debian_python.h"
#include "drawing/drawing.h"
#include "results/block_shape.h"
#include "results/csv.h"
#include "results/result_writer.h"
#include "sample_run.h"

namespace keyblock::results {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// The sample with displacements of a few centimetres, and nothing excavated but block 2 from step 15 on.
RunData small_motions() {
  SampleRun sample;
  RunData data = sample.expected();
  for (record::Frame& frame : data.frames) {
    for (std::size_t k = 0; k < frame.displacement.size(); ++k) {
      frame.displacement[k] = {0.01F * static_cast<float>(frame.step), -0.25F};
    }
    frame.status = {record::BlockStatus::in_place, record::BlockStatus::fallen,
                    frame.step < 15 ? record::BlockStatus::loosened : record::BlockStatus::excavated};
  }
  return data;
}

std::vector<std::string> lines(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<std::string> out;
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

TEST(BlockShape, HolesAndDisplacements) {
  const RunData data = small_motions();
  const Polygon shape = block_shape(data.model, data.frames[1], 1);
  ASSERT_EQ(shape.holes.size(), 1U);
  EXPECT_NEAR(shape.outer[0].x, 466003.1 + 0.1, 1e-6);
  EXPECT_NEAR(shape.outer[0].y, 6691603.7 - 0.25, 1e-6);
  EXPECT_NEAR(area(shape), 15.0, 1e-6);
  const Vec2 u = block_displacement(data.model, data.frames[1], 1);
  EXPECT_NEAR(u.x, 0.1, 1e-6);
  EXPECT_NEAR(u.y, -0.25, 1e-6);
  double covered = 0.0;
  for (const auto& t : block_triangles(data.model, 1)) {
    for (const int k : t) EXPECT_TRUE(k >= 3 && k < 11);
    const auto p = [&](std::size_t k) { return data.model.vertices[static_cast<std::size_t>(t[k])]; };
    covered += 0.5 * cross(p(1) - p(0), p(2) - p(0));
  }
  EXPECT_NEAR(covered, 15.0, 1e-12);
}

TEST(LastOrders, AreThoseOfTheLastFrame) {
  RunData data = small_motions();
  EXPECT_EQ(last_orders(data), (std::vector<int>{31, 32, 33}));
  data.frames.clear();
  EXPECT_EQ(last_orders(data), (std::vector<int>{1, 2, 1}));
}

TEST(Export, Csv) {
  const FreshFolder fresh;
  const auto folder = fresh / "made";
  RunData data = small_motions();
  for (record::Frame& frame : data.frames)
    frame.elements[1].utilization = std::numeric_limits<double>::quiet_NaN();
  const auto files = export_run(data, folder, ExportFormat::csv);
  EXPECT_THAT(files,
              testing::ElementsAre(folder / "blocks.csv", folder / "contacts.csv", folder / "steps.csv",
                                   folder / "histories.csv", folder / "breaks.csv",
                                   folder / "element_frames.csv", folder / "release.csv"));
  const auto elements = lines(folder / "element_frames.csv");
  EXPECT_EQ(
      elements[0],
      "frame,time,stage,step,element,name,kind,present,from_x,from_y,to_x,to_y,force,elongation,yielded,"
      "moment,shear,utilization");
  EXPECT_EQ(elements.size(), 1U + 6 * 2);
  EXPECT_THAT(elements[1], HasSubstr(",0,\"anchor, \"\"3\"\"\",spring,"));
  EXPECT_THAT(elements[2], testing::EndsWith(","));  // no limit
  const auto blocks = lines(folder / "blocks.csv");
  EXPECT_EQ(blocks[0], "frame,time,stage,step,block,name,status,x,y,ux,uy,sxx,syy,sxy");
  EXPECT_EQ(blocks.size(), 1U + 2 * 3 + 4 * 2);  // without the excavated block in the last four of six frames
  EXPECT_THAT(blocks[1], testing::StartsWith("0,0,0,5,0,base,in place,466000.4"));
  EXPECT_THAT(blocks[3], HasSubstr("slider,loosened"));
  const auto contacts = lines(folder / "contacts.csv");
  EXPECT_EQ(contacts.size(), 1U + 0 + 1 + 2);
  EXPECT_THAT(contacts[1], HasSubstr(",open,"));
  EXPECT_THAT(contacts[1], testing::EndsWith("joint set,J1"));
  const auto breaks = lines(folder / "breaks.csv");
  EXPECT_EQ(breaks[0],
            "time,stage,step,mode,x,y,length,block_a,block_b,edge_kind,edge_index,trace,element,name");
  EXPECT_EQ(breaks.size(), 1U + 4);
  EXPECT_THAT(breaks[1], HasSubstr(",0,7,tension,46600"));
  EXPECT_THAT(breaks[1], testing::EndsWith(",2,1,trace map,0,12,-1,map"));
  EXPECT_THAT(breaks[3], testing::EndsWith(",0,2,1,free,0,-1,1,boundary.base"));
  EXPECT_EQ(lines(folder / "steps.csv").size(), 31U);
  EXPECT_EQ(lines(folder / "histories.csv").size(), 31U);
  EXPECT_THAT(lines(folder / "release.csv"),
              testing::ElementsAre("stage,step,excavation,released,crown,springline,mean",
                                   "0,3,tunnel,0,0,0,0", "0,9,tunnel,0.4,0.002,,0.001"));
}

TEST(Export, HistoriesOfExcavatedRockAreEmptyCells) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  record::HistoryRow row;
  row.time = 0.5;
  row.points = {{none, none, none, none, none, none, none}, {1, 2, 3, 4, 5, 6, 7, 8, 9}};
  record::ModelRecord model;
  model.history_names = {"a", "b"};
  EXPECT_THAT(histories_csv(model, {row}), testing::EndsWith("\n0.5,,,,,,,,,,1,2,3,4,5,6,7,8,9\n"));
}

TEST(Export, GeoJsonOfEveryStageEnd) {
  const FreshFolder folder;
  const auto files = export_run(small_motions(), folder, ExportFormat::geojson);
  ASSERT_THAT(files, testing::ElementsAre(folder / "stage_1_in-situ.geojson",
                                          folder / "stage_2_first-earthquake.geojson"));
  const json first = json::parse(read_file(files[0])), second = json::parse(read_file(files[1]));
  EXPECT_EQ(first["type"], "FeatureCollection");
  EXPECT_EQ(first["features"].size(), 3U);
  EXPECT_EQ(second["features"].size(), 2U);
  const json& block = second["features"][1];
  EXPECT_EQ(block["properties"]["status"], "fallen");
  EXPECT_NEAR(block["properties"]["displacement_m"].get<double>(), std::hypot(0.3, 0.25), 1e-6);
  const json& rings = block["geometry"]["coordinates"];
  ASSERT_EQ(rings.size(), 2U);
  EXPECT_EQ(rings[0].size(), 5U);
  EXPECT_EQ(rings[0].front(), rings[0].back());
  EXPECT_NEAR(rings[0][0][0].get<double>(), 466003.1 + 0.3, 1e-6);
}

// Read as a scenario reads drawings.
TEST(Export, DrawingsOfEveryStageEnd) {
  const FreshFolder folder;
  const auto files = export_run(small_motions(), folder, ExportFormat::dxf);
  ASSERT_THAT(files,
              testing::ElementsAre(folder / "stage_1_in-situ.dxf", folder / "stage_2_first-earthquake.dxf"));
  const drawing::Drawing first = drawing::read_drawing(read_file(files[0]), "1.dxf"),
                         second = drawing::read_drawing(read_file(files[1]), "2.dxf");
  EXPECT_TRUE(first.skipped.empty());
  const auto fallen = drawing::lines_on(second, {"FALLEN"});
  ASSERT_EQ(fallen.size(), 2U);  // its outline and its hole
  EXPECT_TRUE(fallen[0].closed);
  EXPECT_EQ(fallen[0].vertices.size(), 4U);
  EXPECT_NEAR(fallen[0].vertices[0].x, 466003.1 + 0.3, 1e-6);
  const auto joints = drawing::lines_on(first, {"JOINT_J_2"});
  ASSERT_FALSE(joints.empty());
  for (const drawing::DrawnLine& joint : joints) EXPECT_GE(joint.vertices.size(), 2U);
}

TEST(Export, GeoJsonOfAStageThatDidNotEndIsNamedSo) {
  const FreshFolder folder;
  RunData data = small_motions();
  data.run.stages.back().interrupted = true;
  EXPECT_THAT(export_run(data, folder, ExportFormat::geojson),
              testing::ElementsAre(folder / "stage_1_in-situ.geojson",
                                   folder / "stage_2_first-earthquake_unfinished.geojson"));
}

// What runs to an end early, or is exported anew with fewer frames, leaves no files of the longer one beside its own.
TEST(Export, TakesThePlaceOfAnEarlierOne) {
  const FreshFolder folder;
  RunData data = small_motions();
  export_run(data, folder, ExportFormat::vtk);
  export_run(data, folder, ExportFormat::csv);
  write_file_atomically(folder / "scene.pvsm", "mine");
  data.frames.resize(4);
  data.model.history_names.clear();
  data.model.element_histories.clear();
  export_run(data, folder, ExportFormat::vtk);
  EXPECT_TRUE(std::filesystem::exists(folder / "blocks_00003.vtu"));
  EXPECT_FALSE(std::filesystem::exists(folder / "blocks_00004.vtu"));
  EXPECT_TRUE(std::filesystem::exists(folder / "histories.csv"));
  export_run(data, folder, ExportFormat::csv);
  EXPECT_FALSE(std::filesystem::exists(folder / "histories.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "blocks.csv"));
  EXPECT_EQ(read_file(folder / "scene.pvsm"), "mine");
}

TEST(Export, FilesThatAreOfNoExportStayUnlessTheyMayGo) {
  const FreshFolder folder;
  const RunData data = small_motions();
  write_file_atomically(folder / "steps.csv", "mine");
  EXPECT_THROW(export_run(data, folder, ExportFormat::geojson), InputError);
  export_run(data, folder, ExportFormat::geojson, true);
  EXPECT_THROW(export_run(data, folder, ExportFormat::csv), InputError);
  EXPECT_EQ(read_file(folder / "steps.csv"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder / "blocks.csv"));
  export_run(data, folder, ExportFormat::csv, true);
  EXPECT_NE(read_file(folder / "steps.csv"), "mine");
  export_run(data, folder, ExportFormat::csv);
}

// A list that somebody has changed leads to no file elsewhere.
TEST(Export, OnlyFilesOfItsFolderAreRemoved) {
  const FreshFolder fresh;
  const auto folder = fresh / "out";
  export_run(small_motions(), folder, ExportFormat::csv);
  write_file_atomically(fresh / "mine", "mine");
  for (const char* name : {"thesis.txt", "mine.geojson", ".csv"})
    write_file_atomically(folder / name, "mine");
  write_file_atomically(
      folder / "keyblock-export.json",
      R"({"csv": ["../mine", "..", 3, "thesis.txt", "mine.geojson", ".csv"], "vtk": 7, "other": ["thesis.txt"]})");
  export_run(small_motions(), folder, ExportFormat::csv, true);
  EXPECT_EQ(read_file(fresh / "mine"), "mine");
  for (const char* name : {"thesis.txt", "mine.geojson", ".csv"})
    EXPECT_EQ(read_file(folder / name), "mine") << name;
}

TEST(Export, LongNamesOfStages) {
  const FreshFolder folder;
  RunData data = small_motions();
  for (auto& stage : data.run.stages) stage.stage.name = std::string(99, 'a') + " " + std::string(200, 'b');
  const std::string part(99, 'a');
  EXPECT_THAT(export_run(data, folder, ExportFormat::geojson),
              testing::ElementsAre(folder / ("stage_1_" + part + ".geojson"),
                                   folder / ("stage_2_" + part + ".geojson")));
}

std::vector<double> series_times(const std::filesystem::path& series) {
  std::vector<double> times;
  for (const std::string& line : lines(series)) {
    const std::size_t at = line.find("timestep=\"");
    if (at != std::string::npos) times.push_back(std::strtod(line.c_str() + at + 10, nullptr));
  }
  return times;
}

// Two static stages: blocks at their starts and ends, and once on the way; contacts at the ends.
TEST(Export, VtkSeriesHaveTheSameTimeForTheSameStep) {
  const FreshFolder folder;
  RunData data = small_motions();
  data.frames.resize(5, data.frames.front());
  data.contacts.resize(2, data.contacts.front());
  const std::pair<int, long> frames[] = {{0, 0}, {0, 10}, {0, 20}, {1, 20}, {1, 35}};
  for (std::size_t k = 0; k < 5; ++k) std::tie(data.frames[k].stage, data.frames[k].step) = frames[k];
  for (record::Frame& frame : data.frames) frame.time = 0.0;
  data.contacts[0].stage = 0, data.contacts[0].step = 20;
  data.contacts[1].stage = 1, data.contacts[1].step = 35;
  for (record::ContactFrame& frame : data.contacts) frame.time = 0.0;
  const auto files = export_run(data, folder, ExportFormat::vtk);
  const std::vector<double> blocks = series_times(files[0]);
  ASSERT_EQ(blocks.size(), 5U);
  EXPECT_TRUE(std::is_sorted(blocks.begin(), blocks.end(), std::less_equal<>()));
  EXPECT_THAT(series_times(files[1]), testing::ElementsAre(blocks[2], blocks[4]));
}

TEST(Export, VtkSeriesHasTimesThatAscend) {
  const FreshFolder folder;
  const auto files = export_run(small_motions(), folder, ExportFormat::vtk);
  EXPECT_EQ(files[0], folder / "blocks.pvd");
  EXPECT_EQ(files[1], folder / "contacts.pvd");
  EXPECT_EQ(files[2], folder / "outlines.pvd");
  EXPECT_EQ(files[3], folder / "centres.pvd");
  EXPECT_EQ(files[4], folder / "forces.pvd");
  EXPECT_EQ(files[5], folder / "elements.pvd");
  EXPECT_EQ(files[6], folder / "breaks.vtp");
  EXPECT_EQ(files[7], folder / "view.py");
  EXPECT_EQ(files.size(), 8U + 4 * 6 + 2 * 3);
  for (const std::size_t series : {2U, 3U}) EXPECT_EQ(series_times(files[series]), series_times(files[0]));
  EXPECT_EQ(series_times(files[4]), series_times(files[1]));
  const std::vector<double> times = series_times(files[0]);
  ASSERT_EQ(times.size(), 6U);
  for (std::size_t k = 1; k < times.size(); ++k) EXPECT_GT(times[k], times[k - 1]);
  EXPECT_EQ(times[0], 0.0);
}

TEST(Export, VtkFilesAreReadByVtk) {
  if (!python_has("vtkmodules")) GTEST_SKIP() << "python3-vtk9 is not installed";
  const FreshFolder folder;
  RunData data = small_motions();
  // At the right upper corner of block 1, where the joint begins that belongs to it.
  record::ContactRecord& corner = data.contacts.back().contacts[0];
  corner.block_b = 1;
  corner.position = {7.3, 6.75};
  corner.normal = {0.0, 1.0};
  corner.length = 2.0;
  export_run(data, folder, ExportFormat::vtk);
  const PythonResult result = python(folder, R"(
import sys
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLPolyDataReader
reader = vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1] + "/blocks_00005.vtu")
reader.Update()
grid = reader.GetOutput()
data = grid.GetCellData()
area = sum(abs(grid.GetCell(k).ComputeArea()) for k in range(1, grid.GetNumberOfCells()))
print("points", grid.GetNumberOfPoints(), "area of block 1", round(area, 6))
print("type of cell 0", grid.GetCellType(0), "its points", grid.GetCell(0).GetNumberOfPoints())
print("blocks", sorted({int(data.GetArray("block").GetValue(k)) for k in range(grid.GetNumberOfCells())}))
print("order", int(data.GetArray("order").GetValue(1)))
print("status", int(data.GetArray("status").GetValue(1)))
print("stress", data.GetArray("stress").GetNumberOfComponents(), data.GetArray("stress").GetComponentName(3))
print("displacement", [round(v, 6) for v in grid.GetPointData().GetArray("displacement").GetTuple3(0)])
print("point", [round(v, 6) for v in grid.GetPoint(3)])
print("magnitude", round(data.GetArray("displacement_magnitude").GetValue(0), 6))
print("step", int(grid.GetFieldData().GetArray("step").GetValue(0)))
reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1] + "/contacts_00002.vtp")
reader.Update()
lines = reader.GetOutput()
print("contacts", lines.GetNumberOfLines(), lines.GetNumberOfPoints(), int(lines.GetCellData().GetArray("state").GetValue(1)))
print("line", [round(v, 5) for p in (0, 1) for v in lines.GetPoint(p)])
)",
                                     folder.string());
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(result.output,
            "points 14 area of block 1 15.0\n"
            "type of cell 0 7 its points 3\n"
            "blocks [0, 1]\n"
            "order 32\n"
            "status 2\n"
            "stress 6 XY\n"
            "displacement [0.3, -0.25, 0.0]\n"
            "point [3.3, 2.75, 0.0]\n"
            "magnitude 0.390512\n"
            "step 30\n"
            "contacts 2 4 1\n"
            "line [7.3, 6.75, 0.0, 5.3, 6.75, 0.0]\n");
}

}  // namespace
}  // namespace keyblock::results
