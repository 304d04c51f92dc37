"""Draws facets with VTK: their colours, the lines between them, the scale beside them."""

import math

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkExtractCells, vtkExtractEdges
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (vtkActor, vtkColorTransferFunction, vtkDataSetMapper, vtkPolyDataMapper,
                                         vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter)

from cadrefine.formats.grid import to_vtk

SIZE = (1400, 900)
BAR_SHARE = 0.16  # Of the picture's width, on the left, for the colour bar.
ASPECT = SIZE[0] * (1 - BAR_SHARE) / SIZE[1]  # Of what is beside it.
MARGIN = 0.04  # Around what is shown, in parts of its size.
EDGE_COLOUR, EDGE_WIDTH = (38, 38, 38), 1.5
LONG_EDGE = 32.0  # Pixels from which on an edge is drawn in full: where edges are dense, colours shine through.
FAINTEST = 0.12
DECADES = 4  # The colour scale's most.
LOGARITHMIC = 10.0  # How many times the smallest value the largest is, from which on the scale is logarithmic.
SMALLEST = 5  # Percentile at the end that the colour scale begins at.
# From small errors to large ones: blue, yellow, red (after ColorBrewer's RdYlBu), so that edges show on all.
COLOURS = ((0.36, 0.60, 0.80), (0.67, 0.85, 0.91), (0.90, 0.96, 0.90), (1.0, 0.93, 0.62), (0.99, 0.68, 0.38),
           (0.93, 0.39, 0.24), (0.80, 0.13, 0.13))
VALUES = "values"  # Name of the array that colours.
QUADRATIC = (22, 23)  # Types of facets.
GREY = (0.87, 0.88, 0.90, 1.0)  # Of what has no value.
LEVEL = 3  # Quadratic facets are drawn by 4^LEVEL flat ones each.


class Colours:
    """One scale for the values of both pictures; what is NaN is grey."""

    def __init__(self, first, last):
        first, last = first[~np.isnan(first)], last[~np.isnan(last)]
        largest = round_up(max(first.max(initial=0.0), last.max(initial=0.0)) or 1.0)
        smallest = max(np.percentile(last, SMALLEST) if len(last) else 0.0, largest * 10.0**-DECADES)
        self.logarithmic = largest > LOGARITHMIC * smallest
        decades = math.ceil(math.log10(largest / smallest) - 1e-9)
        if self.logarithmic:
            self.labels = [largest * 10.0**-decade for decade in range(decades + 1)]
        else:
            self.labels = list(np.linspace(largest, 0.0, 6))
        self.table = vtkLookupTable()
        self.table.SetNumberOfTableValues(256)
        ramp = vtkColorTransferFunction()
        for index, colour in enumerate(COLOURS):
            ramp.AddRGBPoint(index / (len(COLOURS) - 1), *colour)
        for index in range(256):
            self.table.SetTableValue(index, *ramp.GetColor(index / 255), 1.0)
        self.table.SetNanColor(*GREY)
        self.table.SetTableRange(self.labels[-1], largest)
        if self.logarithmic:
            self.table.SetScaleToLog10()


def round_up(value):
    """To 1, 2 or 5 times a power of ten."""
    power = 10.0**math.floor(math.log10(value))
    return next((digit * power for digit in (1, 2, 5) if value <= digit * power * (1 + 1e-9)), 10 * power)


class Camera:
    """Looks from the direction `view` at `points`, as large as they fit."""

    def __init__(self, view, points):
        self.direction, self.right, self.up = axes(view)
        across, upwards = points @ self.right, points @ self.up
        self.height = max(np.ptp(upwards), np.ptp(across) / ASPECT, 1e-300) * (1 + MARGIN)
        self.centre = (across.min() + np.ptp(across) / 2) * self.right
        self.centre += (upwards.min() + np.ptp(upwards) / 2) * self.up
        self.centre += (points @ self.direction).mean() * self.direction

    def pixels(self, vectors):
        """How long they are in the picture."""
        return np.hypot(vectors @ self.right, vectors @ self.up) * SIZE[1] / self.height

    def look(self, renderer, distance):
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(*self.centre)
        camera.SetPosition(*(self.centre + distance * self.direction))
        camera.SetViewUp(*self.up)
        camera.SetParallelScale(self.height / 2)
        renderer.ResetCameraClippingRange()


def axes(view):
    """Unit vectors towards the eye, which is in the direction `view`, to the right and up (z is up where it can be)."""
    direction = np.array(view) / np.abs(view).max()  # Squares of very small numbers are 0.
    direction /= np.linalg.norm(direction)
    upright = (0.0, 0.0, 1.0) if abs(direction[2]) < 0.999 else (0.0, 1.0, 0.0)
    right = np.cross(upright, direction)
    right /= np.linalg.norm(right)
    return direction, right, np.cross(direction, right)


def draw(grid, values, camera, colours, title, path):
    """Writes a picture of `grid`, coloured by `values` of its cells; grey where they are NaN."""
    import vtkmodules.vtkRenderingFreeType  # noqa: F401  (these two make drawing work at all)
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401

    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    renderer.AddActor(surface(grid, values, colours))
    renderer.AddActor(edges(grid, camera))
    renderer.SetViewport(BAR_SHARE, 0.0, 1.0, 1.0)
    camera.look(renderer, grid.GetLength())
    legend = vtkRenderer()
    legend.SetBackground(1.0, 1.0, 1.0)
    legend.SetViewport(0.0, 0.0, BAR_SHARE, 1.0)
    legend.AddActor2D(colour_bar(colours, title))
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


def surface(grid, values, colours):
    grid.GetCellData().AddArray(to_vtk(VALUES, values))
    flat = vtkDataSetSurfaceFilter()
    flat.SetInputData(grid)
    flat.SetNonlinearSubdivisionLevel(LEVEL)
    mapper = vtkDataSetMapper()
    mapper.SetInputConnection(flat.GetOutputPort())
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray(VALUES)
    mapper.SetLookupTable(colours.table)
    mapper.UseLookupTableScalarRangeOn()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(2, 2)  # The edges are drawn before it.
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetInterpolationToFlat()
    actor.GetProperty().SetAmbient(0.8)
    actor.GetProperty().SetDiffuse(0.2)
    return actor


def edges(grid, camera):
    """The edges of the facets, faint where they are short in the picture."""
    ends, points = curved_edges(grid) if is_quadratic(grid) else straight_edges(grid)
    pixels = camera.pixels(points[ends[:, 1]] - points[ends[:, 0]])
    if is_quadratic(grid):
        pixels *= 2**LEVEL
    shown = np.clip(pixels / LONG_EDGE, FAINTEST, 1.0)
    colours = np.empty((len(ends), 4), dtype=np.uint8)
    colours[:, :3], colours[:, 3] = EDGE_COLOUR, 255 * shown
    lines, cells, corners = vtkPolyData(), vtkCellArray(), vtkPoints()
    corners.SetData(numpy_to_vtk(points, deep=True))
    cells.SetData(2, numpy_to_vtkIdTypeArray(ends.ravel().astype(np.int64), deep=True))
    lines.SetPoints(corners)
    lines.SetLines(cells)
    lines.GetCellData().SetScalars(numpy_to_vtk(colours, deep=True))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(lines)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetLineWidth(EDGE_WIDTH)
    actor.GetProperty().LightingOff()
    return actor


def is_quadratic(grid):
    return grid.GetNumberOfCells() > 0 and grid.GetCellType(0) in QUADRATIC


def straight_edges(grid):
    """Their ends, and the points that these are numbers of."""
    extraction = vtkExtractEdges()
    extraction.SetInputData(grid)
    extraction.Update()
    found = extraction.GetOutput()
    return (vtk_to_numpy(found.GetLines().GetConnectivityArray()).reshape(-1, 2),
            vtk_to_numpy(found.GetPoints().GetData()))


def curved_edges(grid):
    """The same of quadratic facets, each edge in 2^LEVEL pieces."""
    numbers, starts = (vtk_to_numpy(array) for array in (
        grid.GetCells().GetConnectivityArray(), grid.GetCells().GetOffsetsArray()))
    nodes = np.vstack([
        numbers[starts[:-1][np.diff(starts) == 2 * corners, np.newaxis] + [k, corners + k, (k + 1) % corners]]
        for corners in (3, 4) for k in range(corners)])
    t = np.linspace(0, 1, 2**LEVEL + 1)
    shape = np.array([(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)])
    points = np.einsum("nt,enx->etx", shape, vtk_to_numpy(grid.GetPoints().GetData())[nodes]).reshape(-1, 3)
    starts = np.delete(np.arange(len(points)).reshape(-1, len(t)), -1, axis=1).ravel()
    return np.column_stack([starts, starts + 1]), points


def cells_of(grid, chosen):
    """Those of its cells that the mask `chosen` takes."""
    extraction = vtkExtractCells()
    extraction.SetInputData(grid)
    numbers = np.flatnonzero(chosen)
    extraction.SetCellIds(numbers, len(numbers))
    extraction.Update()
    return extraction.GetOutput()


def colour_bar(colours, title):
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor

    bar = vtkScalarBarActor()
    bar.SetLookupTable(colours.table)
    bar.SetTitle(title)
    bar.SetVerticalTitleSeparation(14)
    bar.SetNumberOfLabels(len(colours.labels))
    bar.SetLabelFormat("%.3g")
    bar.SetUnconstrainedFontSize(True)
    for text, size in ((bar.GetTitleTextProperty(), 26), (bar.GetLabelTextProperty(), 26)):
        text.SetColor(0.0, 0.0, 0.0)
        text.SetFontSize(size)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
    bar.SetPosition(0.1, 0.04)
    bar.SetWidth(0.88)
    bar.SetHeight(0.5)
    return bar
