"""What view.py uses of paraview.simple, made of VTK. Proxies refuse properties that those of ParaView do not have."""

import os
import xml.etree.ElementTree as ElementTree

import vtkmodules.all as vtk

shown, screenshots = [], []  # what the script has made, for tests
updated = set()  # sources whose data is known


class Proxy:
    _allowed = ()

    def __init__(self, **properties):
        for name, value in properties.items():
            setattr(self, name, value)

    def __setattr__(self, name, value):
        if not name.startswith("_") and name not in self._allowed:
            raise AttributeError(f"{type(self).__name__} has no property {name}")
        object.__setattr__(self, name, value)


class ArrayInformation:
    def __init__(self, array):
        self._array = array

    def GetRange(self, component=0):
        return self._array.GetRange(component)


class PointData:
    def __init__(self, data):
        self._data = data

    def GetArray(self, name):
        array = self._data.GetPointData().GetArray(name)
        return None if array is None else ArrayInformation(array)


class DataInformation:
    def __init__(self, data):
        self._data = data

    def GetBounds(self):
        return self._data.GetBounds()


class PVDReader(Proxy):
    _allowed = ("registrationName", "FileName")

    def _output(self):
        """The last moment of the series."""
        last = list(ElementTree.parse(self.FileName).iter("DataSet"))[-1].get("file")
        reader = vtk.vtkXMLUnstructuredGridReader() if last.endswith(".vtu") else vtk.vtkXMLPolyDataReader()
        reader.SetFileName(os.path.join(os.path.dirname(self.FileName), last))
        reader.Update()
        return reader.GetOutput()

    @property
    def PointData(self):
        if self not in updated:
            raise RuntimeError("nothing is known of the data of a source before it is updated")
        return PointData(self._output())

    def GetDataInformation(self):
        return DataInformation(self._output())


class Glyph(Proxy):
    _allowed = ("registrationName", "Input", "GlyphType", "OrientationArray", "ScaleArray", "ScaleFactor", "GlyphMode")

    def _output(self):
        data = self.Input._output()
        kind, array = self.ScaleArray
        if kind != "POINTS" or self.OrientationArray != [kind, array] or data.GetPointData().SetActiveVectors(array) < 0:
            raise ValueError(f"no vectors {array}")
        glyph = vtk.vtkGlyph3D()
        shape = {"Arrow": vtk.vtkArrowSource, "Line": vtk.vtkLineSource}[self.GlyphType]()
        glyph.SetSourceConnection(shape.GetOutputPort())
        glyph.SetInputData(data)
        glyph.SetVectorModeToUseVector()
        glyph.SetScaleModeToScaleByVector()
        glyph.SetScaleFactor(self.ScaleFactor)
        glyph.Update()
        return glyph.GetOutput()


class Representation(Proxy):
    _allowed = ("Representation", "AmbientColor", "DiffuseColor", "LineWidth", "Position")

    def __init__(self, source):
        self._source, self._color, self._visible, self._bar = source, None, True, False

    def SetScalarBarVisibility(self, view, visible):
        self._bar = visible

    def _actor(self):
        surface = vtk.vtkDataSetSurfaceFilter()
        surface.SetInputData(self._source._output())
        surface.Update()
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(surface.GetOutput())
        mapper.SetScalarVisibility(self._color is not None)
        actor = vtk.vtkActor()
        if self._color:
            mapper.SetScalarModeToUseCellFieldData()
            mapper.SelectColorArray(self._color[1])
            mapper.SetScalarRange(_ranges.get(self._color[1]) or self._source._output().GetCellData().GetArray(self._color[1]).GetRange())
        else:
            actor.GetProperty().SetColor(self.DiffuseColor)
        actor.GetProperty().LightingOff()
        actor.GetProperty().SetLineWidth(getattr(self, "LineWidth", 2.0))
        actor.SetPosition(getattr(self, "Position", (0.0, 0.0, 0.0)))
        actor.SetMapper(mapper)
        return actor


class View(Proxy):
    ViewTime = 0.0
    _allowed = ("Background", "OrientationAxesVisibility", "InteractionMode", "CameraParallelProjection")


class Scene:
    def UpdateAnimationUsingDataTimeSteps(self):
        pass

    def GoToLast(self):
        pass


class TransferFunction:
    def __init__(self, name):
        self._name = name

    def RescaleTransferFunction(self, least, most):
        _ranges[self._name] = (least, most)


def GetColorTransferFunction(name):
    return TransferFunction(name)


_view, _ranges = View(), {}


def GetActiveViewOrCreate(kind):
    assert kind == "RenderView"
    return _view


def GetAnimationScene():
    return Scene()


def UpdatePipeline(time=None, proxy=None):
    updated.add(proxy)


def Show(source, view):
    updated.add(source)
    shown.append(Representation(source))
    return shown[-1]


def Hide(source, view):
    for representation in shown:
        if representation._source is source:
            representation._visible = False


def ColorBy(representation, array):
    if array is not None:
        kind, name = array
        data = representation._source._output()
        if kind != "CELLS" or data.GetCellData().GetArray(name) is None:
            raise ValueError(f"no cell array {name}")
    representation._color = array


def ResetCamera(view):
    pass


def Render(view):
    """Without a screen everything is made but the picture."""
    for representation in shown:
        representation._actor()


def SaveScreenshot(name, view, ImageResolution=(800, 600)):
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(view.Background)
    for representation in shown:
        if representation._visible or os.environ.get("KEYBLOCK_SHOW_ALL"):
            renderer.AddActor(representation._actor())
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(*ImageResolution)
    window.AddRenderer(renderer)
    renderer.GetActiveCamera().SetParallelProjection(view.CameraParallelProjection)
    renderer.ResetCamera()
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(name)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()
    screenshots.append(name)
