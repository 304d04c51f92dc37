"""Pictures of a mesh: what lies on the CAD, coloured by its local geometric error.

The boundary triangles are gathered on rank 0, which draws them alone. (Drawing on all ranks would want a display on
each of them, and ParaView 5.11 was seen to hang there when a rank has nothing to draw.)
"""

import ctypes
import ctypes.util
import os

from paraview import simple
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (vtkActor, vtkColorTransferFunction, vtkDataSetMapper, vtkRenderer,
                                         vtkRenderWindow, vtkWindowToImageFilter)

import cadrefine_session as session
from cadrefine_pipeline import gathered
from cadrefine_session import Failure

SIZE = (1400, 900)
DECADES = 6  # Of the colour scale, downwards from the largest error.
VIRIDIS = ((0.267, 0.005, 0.329), (0.231, 0.318, 0.545), (0.129, 0.569, 0.549), (0.369, 0.788, 0.384),
           (0.993, 0.906, 0.144))


def check_display():
    """A picture needs an X server, and VTK crashes without one."""
    if not os.environ.get("DISPLAY"):
        raise Failure("a screenshot needs a display, and DISPLAY is not set; run it under xvfb-run")
    name = ctypes.util.find_library("X11")
    if name:
        x11 = ctypes.CDLL(name)
        x11.XOpenDisplay.restype = ctypes.c_void_p
        display = x11.XOpenDisplay(None)
        if not display:
            raise Failure(f"a screenshot needs a display, and {os.environ['DISPLAY']} cannot be opened")
        x11.XCloseDisplay(ctypes.c_void_p(display))


def largest_error(mesh):
    return mesh.CellData["GeometricError"].GetRange(0)[1]


def screenshot(mesh, path, focus, largest):
    """Writes a picture of `mesh`, whose cells have the array GeometricError; `largest` is the scale's upper end."""
    shown = gathered(cells_on_cad(mesh))
    if session.speaks():
        draw(shown, largest, path, focus)


def cells_on_cad(mesh):
    """The boundary triangles whose corners all lie on the CAD; of a mesh of triangles all of them."""
    surface = simple.ExtractSurface(Input=mesh)
    surface.UpdatePipeline()
    if flat(mesh.GetDataInformation().GetBounds()):
        return surface
    chosen = simple.Threshold(Input=surface)
    chosen.Scalars = ["POINTS", "CADDimension"]
    chosen.LowerThreshold, chosen.UpperThreshold = 0, 2  # Only now: choosing the array resets them.
    chosen.AllScalars = 1
    chosen.UpdatePipeline()
    return chosen if chosen.GetDataInformation().GetNumberOfCells() else surface


def flat(bounds):
    return bounds[4] == bounds[5]


def draw(shown, largest, path, focus):
    import vtkmodules.vtkRenderingFreeType  # noqa: F401  (these two make drawing work at all)
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401

    colours = error_colours(largest)
    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    renderer.AddActor(surface_actor(shown, colours))
    renderer.AddActor2D(colour_bar(colours))
    look_at(renderer, focus or shown.GetBounds())
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    window.Render()
    picture = vtkWindowToImageFilter()
    picture.SetInput(window)
    picture.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetFileName(path + ".part")
    writer.SetInputConnection(picture.GetOutputPort())
    writer.Write()
    window.Finalize()
    session.raise_errors(path)
    os.replace(path + ".part", path)


def error_colours(largest):
    """Logarithmic colours over the last DECADES decades; smaller errors have the first colour."""
    ramp = vtkColorTransferFunction()
    for index, colour in enumerate(VIRIDIS):
        ramp.AddRGBPoint(index / (len(VIRIDIS) - 1), *colour)
    colours = vtkLookupTable()
    colours.SetNumberOfTableValues(256)
    for index in range(256):
        colours.SetTableValue(index, *ramp.GetColor(index / 255), 1.0)
    top = largest if largest > 0 else 1.0
    colours.SetTableRange(top * 10.0**-DECADES, top)
    colours.SetScaleToLog10()
    return colours


def surface_actor(shown, colours):
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(shown)
    mapper = vtkDataSetMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray("GeometricError")
    mapper.SetLookupTable(colours)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.15, 0.15, 0.15)
    actor.GetProperty().SetInterpolationToFlat()
    actor.GetProperty().SetAmbient(0.45)
    actor.GetProperty().SetDiffuse(0.55)
    return actor


def colour_bar(colours):
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor

    bar = vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle("local geometric error")
    bar.SetNumberOfLabels(DECADES + 1)
    bar.SetLabelFormat("%.0e")
    bar.SetUnconstrainedFontSize(True)
    for text, size in ((bar.GetTitleTextProperty(), 20), (bar.GetLabelTextProperty(), 18)):
        text.SetColor(0.0, 0.0, 0.0)
        text.SetFontSize(size)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
    bar.SetPosition(0.02, 0.04)
    bar.SetWidth(0.16)
    bar.SetHeight(0.4)
    return bar


def look_at(renderer, bounds):
    """From ahead, the side and above onto a body; straight down on a mesh in the plane."""
    direction, up = ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)) if flat(bounds) else ((-0.6, -0.64, 0.48), (0.0, 0.0, 1.0))
    centre = [(bounds[2 * i] + bounds[2 * i + 1]) / 2 for i in range(3)]
    size = max(sum((bounds[2 * i + 1] - bounds[2 * i]) ** 2 for i in range(3)) ** 0.5, 1e-300)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*[c + 3 * size * d for c, d in zip(centre, direction)])
    camera.SetViewUp(*up)
    camera.SetParallelScale(0.45 * size)
    renderer.ResetCameraClippingRange()
