"""Pictures of a mesh: what lies on the CAD, coloured by its local geometric error.

The boundary triangles are gathered on rank 0, which draws them alone. (Drawing on all ranks would want a display on
each of them, and ParaView 5.11 was seen to hang there when a rank has nothing to draw.)
"""

import itertools

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (vtkActor, vtkColorTransferFunction, vtkDataSetMapper, vtkRenderer,
                                         vtkRenderWindow, vtkWindowToImageFilter)

from cadrefine import session
from cadrefine.input import local_output
from cadrefine.output import gathered
from cadrefine.pipeline import field_values

SIZE = (1400, 900)
BAR_SHARE = 0.16  # Of the picture's width, on the left, for the colour bar.
ASPECT = SIZE[0] * (1 - BAR_SHARE) / SIZE[1]  # Of what is beside it.
MARGIN = 0.04  # Around what is shown, in parts of its size.
EDGE_COLOUR, EDGE_WIDTH = (0.15, 0.15, 0.15), 1.5
DECADES = 6  # Of the colour scale, downwards from the largest error.
# From small errors to large ones: light blue, yellow, red (after ColorBrewer's RdYlBu), so that edges show on all.
COLOURS = ((0.57, 0.75, 0.86), (0.88, 0.95, 0.97), (1.0, 1.0, 0.75), (1.0, 0.88, 0.56), (0.99, 0.55, 0.35),
           (0.84, 0.19, 0.15))
CELL_TYPES = {2: (5, 22), 3: (10, 24)}  # Of a mesh's dimension, VTK's types of simplices, linear and quadratic.
QUADRATIC_TRIANGLE = 22
LEVEL = 3  # Quadratic triangles are drawn by 4^LEVEL flat ones each.

# Runs on every rank: the facets of these types of cells; quadratic ones stay quadratic.
TAKE_FACETS = """
from vtkmodules.vtkFiltersExtraction import vtkExtractCellsByType
from vtkmodules.vtkFiltersGeometry import vtkUnstructuredGridGeometryFilter
last = vtkExtractCellsByType()
last.SetInputData(self.GetInputDataObject(0, 0))
for cell_type in {types}:
    last.AddCellType(cell_type)
if self.GetInputDataObject(0, 0).IsA("vtkUnstructuredGrid"):
    last, chosen = vtkUnstructuredGridGeometryFilter(), last
    last.SetInputConnection(chosen.GetOutputPort())
last.Update()
self.GetOutputDataObject(0).ShallowCopy(last.GetOutput())
"""


def largest_error(mesh):
    return mesh.CellData["GeometricError"].GetRange(0)[1]


def screenshot(mesh, path, options, largest):
    """Writes a picture of `mesh`, whose cells have the array GeometricError; `largest` is the scale's upper end."""
    shown = gathered(cells_on_cad(mesh))
    if session.speaks():
        draw(shown, largest, path, options)


def cells_on_cad(mesh):
    """The facets whose corners all lie on the CAD; of a mesh of triangles all of them. Cells of lower dimension, which
    carry tags, have no error and would hide the facets."""
    types = CELL_TYPES[field_values(local_output(mesh))["MeshDimension"]]
    surface = simple.ProgrammableFilter(Input=mesh, Script=TAKE_FACETS.format(types=types))
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


def draw(shown, largest, path, options):
    import vtkmodules.vtkRenderingFreeType  # noqa: F401  (these two make drawing work at all)
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401

    colours = error_colours(largest)
    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    quadratic = quadratic_triangles(shown)
    renderer.AddActor(surface_actor(shown, colours, edges=not len(quadratic)))
    renderer.AddActor(curved_edges(shown, quadratic))
    renderer.SetViewport(BAR_SHARE, 0.0, 1.0, 1.0)
    look_at(renderer, shown, options.focus, options.view)
    legend = vtkRenderer()
    legend.SetBackground(1.0, 1.0, 1.0)
    legend.SetViewport(0.0, 0.0, BAR_SHARE, 1.0)
    legend.AddActor2D(colour_bar(colours))
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    window.AddRenderer(legend)
    window.Render()
    picture = vtkWindowToImageFilter()
    picture.SetInput(window)
    picture.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputConnection(picture.GetOutputPort())
    writer.Write()
    window.Finalize()
    session.raise_errors(path)


def error_colours(largest):
    """Logarithmic colours over the last DECADES decades; smaller errors have the first colour."""
    ramp = vtkColorTransferFunction()
    for index, colour in enumerate(COLOURS):
        ramp.AddRGBPoint(index / (len(COLOURS) - 1), *colour)
    colours = vtkLookupTable()
    colours.SetNumberOfTableValues(256)
    for index in range(256):
        colours.SetTableValue(index, *ramp.GetColor(index / 255), 1.0)
    top = largest if largest > 0 else 1.0
    colours.SetTableRange(top * 10.0**-DECADES, top)
    colours.SetScaleToLog10()
    return colours


def quadratic_triangles(shown):
    """Their six nodes each; none where the cells are linear."""
    cell = shown.GetCell(0)
    if cell is None or cell.GetCellType() != QUADRATIC_TRIANGLE:
        return np.empty((0, 6), dtype=int)
    return vtk_to_numpy(shown.GetCells().GetConnectivityArray()).reshape(-1, 6)


def curved_edges(shown, triangles):
    """The edges of quadratic triangles, as lines of 2^LEVEL pieces."""
    nodes = np.vstack([triangles[:, [0, 3, 1]], triangles[:, [1, 4, 2]], triangles[:, [2, 5, 0]]])
    t = np.linspace(0, 1, 2**LEVEL + 1)
    shape = np.array([(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)])
    corners = np.einsum("nt,enx->etx", shape, vtk_to_numpy(shown.GetPoints().GetData())[nodes]).reshape(-1, 3)
    starts = np.delete(np.arange(len(corners)).reshape(-1, len(t)), -1, axis=1).ravel()
    points, lines, edges = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(numpy_to_vtk(corners, deep=True))
    lines.SetData(2, numpy_to_vtkIdTypeArray(np.column_stack([starts, starts + 1]).ravel(), deep=True))
    edges.SetPoints(points)
    edges.SetLines(lines)
    mapper = vtkDataSetMapper()
    mapper.SetInputData(edges)
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-1, -1)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*EDGE_COLOUR)
    actor.GetProperty().SetLineWidth(EDGE_WIDTH)
    actor.GetProperty().LightingOff()
    return actor


def surface_actor(shown, colours, edges):
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(shown)
    surface.SetNonlinearSubdivisionLevel(LEVEL)
    mapper = vtkDataSetMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray("GeometricError")
    mapper.SetLookupTable(colours)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetEdgeVisibility(edges)
    actor.GetProperty().SetEdgeColor(*EDGE_COLOUR)
    actor.GetProperty().SetLineWidth(EDGE_WIDTH)
    actor.GetProperty().SetInterpolationToFlat()
    actor.GetProperty().SetAmbient(0.6)
    actor.GetProperty().SetDiffuse(0.4)
    return actor


def colour_bar(colours):
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor

    bar = vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle("local error")
    bar.SetNumberOfLabels(DECADES + 1)
    bar.SetLabelFormat("%.0e")
    bar.SetUnconstrainedFontSize(True)
    for text, size in ((bar.GetTitleTextProperty(), 28), (bar.GetLabelTextProperty(), 28)):
        text.SetColor(0.0, 0.0, 0.0)
        text.SetFontSize(size)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
    bar.SetPosition(0.1, 0.04)
    bar.SetWidth(0.88)
    bar.SetHeight(0.5)
    return bar


def look_at(renderer, shown, focus, view):
    """Shows the box `focus`, or all of `shown`, as large as it fits."""
    direction, right, up = camera_axes(view or default_view(shown.GetBounds()))
    points = box_corners(focus) if focus else vtk_to_numpy(shown.GetPoints().GetData())
    across, upwards = points @ right, points @ up
    height = max(np.ptp(upwards), np.ptp(across) / ASPECT, 1e-300) * (1 + MARGIN)
    centre = (across.min() + np.ptp(across) / 2) * right + (upwards.min() + np.ptp(upwards) / 2) * up
    centre += (points @ direction).mean() * direction
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + shown.GetLength() * direction))
    camera.SetViewUp(*up)
    camera.SetParallelScale(height / 2)
    renderer.ResetCameraClippingRange()


def default_view(bounds):
    """From ahead, the side and above onto a body; straight down on a mesh in the plane."""
    return (0.0, 0.0, 1.0) if flat(bounds) else (-0.6, -0.64, 0.48)


def camera_axes(view):
    """Unit vectors towards the eye, which is in the direction `view`, to the right and up (z is up where it can be)."""
    direction = np.array(view) / np.abs(view).max()  # Squares of very small numbers are 0.
    direction /= np.linalg.norm(direction)
    upright = (0.0, 0.0, 1.0) if abs(direction[2]) < 0.999 else (0.0, 1.0, 0.0)
    right = np.cross(upright, direction)
    right /= np.linalg.norm(right)
    return direction, right, np.cross(direction, right)


def box_corners(box):
    return np.array(list(itertools.product(box[0:2], box[2:4], box[4:6])))
