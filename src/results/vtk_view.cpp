#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "results/block_shape.h"
#include "results/vtk_parts.h"

namespace keyblock::results {
namespace {

constexpr std::string_view script =
    R"py("""Opens this export in ParaView: paraview --script=view.py, in this folder; or saves a picture: pvpython view.py blocks.png.

Shown are the blocks, coloured by displacement, and their outlines; springs, supports and other elements by their force. Ready in the pipeline, to be switched on by
the eye beside them: forces of contacts, principal stresses and velocities.
"""
import os
import sys

from paraview.simple import *

folder = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else os.getcwd()


def series(name):
    return PVDReader(registrationName=name, FileName=os.path.join(folder, name + ".pvd"))


blocks, outlines, centres = series("blocks"), series("outlines"), series("centres")
contacts, forces = series("contacts"), series("forces")
view = GetActiveViewOrCreate("RenderView")
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.GoToLast()

shown = Show(blocks, view)
shown.Representation = "Surface"
ColorBy(shown, ("CELLS", "displacement_magnitude"))
largest = LARGEST_IN_PLACE  # m, of blocks that have not fallen
if largest > 0.0:
    GetColorTransferFunction("displacement_magnitude").RescaleTransferFunction(0.0, largest)
shown.SetScalarBarVisibility(view, True)

lines = Show(outlines, view)
ColorBy(lines, None)
lines.AmbientColor = lines.DiffuseColor = [0.1, 0.1, 0.1]
lines.LineWidth = 1.0

# Arrows and crosses, the largest of them a twentieth of the model. What is to be seen over the blocks lies in front of them.
x0, x1, y0, y1, z0, z1 = blocks.GetDataInformation().GetBounds()
size = 0.05 * max(x1 - x0, y1 - y0)
lines.Position = [0.0, 0.0, 0.01 * size]


def arrows(name, source, array, color, glyph="Arrow"):
    UpdatePipeline(time=view.ViewTime, proxy=source)
    information = source.PointData.GetArray(array)
    if information is None:
        return
    largest = max((abs(v) for k in range(3) for v in information.GetRange(k)), default=0.0)
    if not 0.0 < largest < float("inf"):
        return
    glyphs = Glyph(registrationName=name, Input=source, GlyphType=glyph)
    glyphs.OrientationArray = ["POINTS", array]
    glyphs.ScaleArray = ["POINTS", array]
    glyphs.ScaleFactor = size / largest
    glyphs.GlyphMode = "All Points"
    look = Show(glyphs, view)
    ColorBy(look, None)
    look.AmbientColor = look.DiffuseColor = color
    look.Position = [0.0, 0.0, 0.02 * size]
    Hide(glyphs, view)


arrows("forces of contacts", forces, "force", [0.8, 0.1, 0.1])
arrows("principal stress 1", centres, "principal_1_vector", [0.1, 0.3, 0.8], "Line")
arrows("principal stress 2", centres, "principal_2_vector", [0.8, 0.3, 0.1], "Line")
arrows("velocities", centres, "velocity", [0.1, 0.5, 0.1])

if os.path.exists(os.path.join(folder, "elements.pvd")):
    elements = series("elements")
    look = Show(elements, view)
    ColorBy(look, ("CELLS", "force"))
    look.LineWidth = 3.0
    look.Position = [0.0, 0.0, 0.015 * size]

view.Background = [1.0, 1.0, 1.0]
view.OrientationAxesVisibility = 0
view.InteractionMode = "2D"
view.CameraParallelProjection = 1
ResetCamera(view)
Render(view)
if sys.argv[1:] and sys.argv[1].endswith(".png"):
    SaveScreenshot(sys.argv[1], view, ImageResolution=[1200, 900])
)py";

/// Of the blocks that have not fallen, in the last frame, m: beside those that have, all others would have one colour.
double largest_in_place(const RunData& data) {
  double largest = 0.0;
  if (data.frames.empty()) return largest;
  const record::Frame& frame = data.frames.back();
  for (std::size_t b = 0; b < data.model.blocks.size(); ++b) {
    if (frame.status[b] <= record::BlockStatus::loosened)
      largest = std::max(largest, norm(block_displacement(data.model, frame, b)));
  }
  return largest;
}

}  // namespace

std::string vtk_view(const RunData& data) {
  constexpr std::string_view place = "LARGEST_IN_PLACE";
  std::string text(script);
  return text.replace(text.find(place), place.size(), fmt::format("{}", largest_in_place(data)));
}

}  // namespace keyblock::results
