"""Pictures of a mesh: what lies on the CAD, coloured by its local geometric error."""

import ctypes
import ctypes.util
import os

from paraview import simple

import cadrefine_session as session
from cadrefine_session import Failure

SIZE = (1400, 900)
DECADES = 4  # Of the colour scale, downwards from the largest error.


def check_display():
    """A picture needs an X server, which VTK does not do without gracefully."""
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


def screenshot(mesh, path, focus=None):
    """Writes a picture of `mesh`, whose cells have the array GeometricError."""
    shown = cells_on_cad(mesh)
    view = simple.CreateView("RenderView")
    view.ViewSize = SIZE
    view.OrientationAxesVisibility = 1
    view.UseColorPaletteForBackground = 0
    view.Background = (1.0, 1.0, 1.0)
    view.OrientationAxesLabelColor = (0.0, 0.0, 0.0)
    display = simple.Show(shown, view)
    display.SetRepresentationType("Surface With Edges")
    display.EdgeColor = (0.15, 0.15, 0.15)
    display.Ambient = 0.3
    colour_by_error(mesh, display, view)
    simple.Render(view)  # The first rendering sets a camera of its own.
    look_at(view, shown, focus)
    simple.SaveScreenshot(path, view, ImageResolution=SIZE)
    simple.Delete(view)
    if not os.path.exists(path):
        session.raise_errors(path)
        raise Failure(f"{path}: could not be written")


def cells_on_cad(mesh):
    """The boundary triangles whose corners all lie on the CAD; of a mesh of triangles all of them."""
    surface = simple.ExtractSurface(Input=mesh)
    surface.UpdatePipeline()
    if flat(mesh):
        return surface
    chosen = simple.Threshold(Input=surface)
    chosen.Scalars = ["POINTS", "CADDimension"]
    chosen.LowerThreshold, chosen.UpperThreshold = 0, 2  # Only now: choosing the array resets them.
    chosen.AllScalars = 1
    chosen.UpdatePipeline()
    return chosen if chosen.GetDataInformation().GetNumberOfCells() else surface


def flat(mesh):
    bounds = mesh.GetDataInformation().GetBounds()
    return bounds[4] == bounds[5]


def colour_by_error(mesh, display, view):
    simple.ColorBy(display, ("CELLS", "GeometricError"))
    array = mesh.CellData["GeometricError"]
    largest = array.GetRange(0)[1] if array else 0.0
    colours = simple.GetColorTransferFunction("GeometricError")
    colours.ApplyPreset("Viridis (matplotlib)", True)
    if largest > 0:
        colours.RescaleTransferFunction(largest * 10.0**-DECADES, largest)
        colours.MapControlPointsToLogSpace()
        colours.UseLogScale = 1
    bar = simple.GetScalarBar(colours, view)
    bar.Title = "local geometric error"
    bar.ComponentTitle = ""
    bar.TitleColor = bar.LabelColor = (0.0, 0.0, 0.0)
    display.SetScalarBarVisibility(view, True)


def look_at(view, shown, focus):
    """From ahead, the side and above onto a body; straight down on a mesh in the plane."""
    bounds = focus or shown.GetDataInformation().GetBounds()
    centre = [(bounds[2 * i] + bounds[2 * i + 1]) / 2 for i in range(3)]
    size = max(sum((bounds[2 * i + 1] - bounds[2 * i]) ** 2 for i in range(3)) ** 0.5, 1e-300)
    direction, up = ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)) if bounds[4] == bounds[5] else ((-0.6, -0.64, 0.48), (0, 0, 1))
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = centre
    view.CameraPosition = [c + 3 * size * d for c, d in zip(centre, direction)]
    view.CameraViewUp = up
    view.CameraParallelScale = size / 2
