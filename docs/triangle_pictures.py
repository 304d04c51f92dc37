"""Makes the pictures of docs/how_it_works.md: xvfb-run -a pvpython docs/triangle_pictures.py

What the filters make of one triangle at the leading edge of the bundled wing section, step by step. Runs from the
repository's root after `make build`; `make pictures` does it.
"""

import os
import sys

import numpy as np
from paraview.simple import *
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pictures import DARK, ROOT, Scene, blocks, data, load_plugin, save

load_plugin(globals())

TRIANGLE = ((0.0, 0.75, 0.0), (0.15, 0.75, 0.107), (0.0, 0.0, 0.0))  # Its corners on the CAD, to a thousandth.
THRESHOLD = 4e-4  # Of the error: the triangles at the leading edge have more.
SIZE, EYE, MIDDLE, HALF_HEIGHT = (640, 420), (-0.3, -1.0, 0.24), (0.1, 0.36, 0.03), 0.24
MESH, MARKED, CAD, WAY = (0.92, 0.93, 0.95), (1.0, 0.68, 0.3), (0.3, 0.65, 0.4), (0.85, 0.1, 0.1)
BALL = 0.009


class Facets:
    """The triangles on the CAD of what a filter gives: points with their global ids, and triangles."""

    def __init__(self, mesh, cad):
        boundary = servermanager.Fetch(CADBoundary(Input=mesh, CAD=cad))
        self.points = vtk_to_numpy(boundary.GetPoints().GetData())
        self.ids = vtk_to_numpy(boundary.GetPointData().GetArray("GlobalPointIds"))
        cells = boundary.GetCellData()
        on_cad = vtk_to_numpy(cells.GetArray("CADDimension")) == 2
        self.triangles = vtk_to_numpy(boundary.GetCells().GetConnectivityArray()).reshape(-1, 3)[on_cad]
        self.errors = vtk_to_numpy(cells.GetArray("GeometricError"))[on_cad]

    def find(self, corners):
        """The triangle of these corners, as a mask."""
        distance = np.linalg.norm(self.points[self.triangles][:, :, None] - np.array(corners), axis=-1)
        return (distance.min(axis=1) < 1e-3).all(axis=1)

    def inside(self, corners):
        """Triangles that are parts of the one of these corners, as a mask."""
        corner, sides = corners[0], (corners[1:] - corners[0]).T
        offset = self.points[self.triangles].mean(axis=1) - corner
        shares = np.linalg.lstsq(sides, offset.T, rcond=None)[0]
        off = np.linalg.norm(offset.T - sides @ shares, axis=0)
        return (off < 1e-9) & (shares > 0).all(axis=0) & (shares.sum(axis=0) < 1)

    def same(self, other, chosen):
        """Which triangles have the ids of those `chosen` of `other`."""
        wanted = {frozenset(ids) for ids in other.ids[other.triangles[chosen]].tolist()}
        return np.array([frozenset(ids) in wanted for ids in self.ids[self.triangles].tolist()])


def source(points, triangles=(), lines=()):
    result, places = vtkPolyData(), vtkPoints()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=float), deep=True))
    result.SetPoints(places)
    for size, cells, take in ((3, triangles, result.SetPolys), (2, lines, result.SetLines)):
        array = vtkCellArray()
        array.SetData(size, numpy_to_vtkIdTypeArray(np.asarray(cells, dtype=np.int64).ravel(), deep=True))
        take(array)
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(result)
    return producer


def nearest(points, cad):
    """Their nearest points on the CAD, by the filter that projects meshes."""
    cloud = MaskPoints(Input=source(points), OnRatio=1, MaximumNumberofPoints=len(points), GenerateVertices=1,
                       SingleVertexPerCell=1)
    return vtk_to_numpy(servermanager.Fetch(ProjectOntoCAD(Input=cloud, CAD=cad, MaximumDistance=0.1)).GetPoints().GetData())


def halved(corners):
    """The triangle of these corners with the middles of its sides, as four triangles."""
    middles = (corners + np.roll(corners, -1, axis=0)) / 2
    return np.vstack([corners, middles]), np.array([(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)])


class Stage(Scene):
    """The front of the wing: its CAD in green, triangles of the mesh, of which some are orange."""

    def __init__(self, cad):
        super().__init__(SIZE, EYE)
        front = Clip(Input=blocks(cad)[0], ClipType="Box", Exact=1)
        front.ClipType.Position, front.ClipType.Length = [-0.1, -0.1, -0.3], [0.46, 0.86, 0.6]
        self.show(front, color=CAD, Opacity=0.22)

    def mesh(self, points, triangles, orange):
        for chosen, color in ((~orange, MESH), (orange, MARKED)):
            if chosen.any():
                self.show(source(points, triangles[chosen]), "Surface With Edges", color=color, LineWidth=2)

    def balls(self, points, color=DARK):
        balls = Glyph(Input=source(points), GlyphType="Sphere", GlyphMode="All Points", ScaleFactor=BALL)
        balls.ScaleArray = balls.OrientationArray = ["POINTS", "No scale array"]
        self.show(balls, color=color)

    def ways(self, starts, ends):
        pairs = np.arange(2 * len(starts)).reshape(2, -1).T
        self.show(source(np.vstack([starts, ends]), lines=pairs), "Wireframe", color=WAY, LineWidth=6,
                  RenderLinesAsTubes=1)

    def save(self, name):
        direction = np.array(EYE) / np.linalg.norm(EYE)
        self.view.CameraParallelProjection = 1
        self.view.CameraFocalPoint, self.view.CameraViewUp = list(MIDDLE), [0, 0, 1]
        self.view.CameraPosition = list(np.array(MIDDLE) + 5 * direction)
        self.view.CameraParallelScale = HALF_HEIGHT
        save("triangle_" + name, self.picture())


class Story:
    """What the filters give."""

    def __init__(self):
        self.cad = CADReader(FileName=os.path.join(ROOT, "data", "naca0012_sharp.igs"))
        coarse = data("naca0012_coarse.vtu")
        measured = self.measured(ProjectOntoCAD(Input=coarse, CAD=self.cad))
        self.first = Facets(measured, self.cad)
        self.straight, self.moved = (Facets(self.measured(RefineWithCAD(
            Input=measured, CAD=self.cad, MarkingArray="GeometricError", Threshold=THRESHOLD, CutFacets=1,
            ProjectNewVertices=on)), self.cad) for on in (0, 1))
        self.one = self.first.find(TRIANGLE)
        self.triangle = self.first.triangles[self.one][0]
        self.corners = self.first.points[self.triangle]
        ids = vtk_to_numpy(servermanager.Fetch(measured).GetPointData().GetArray("GlobalPointIds"))
        place = {number: index for index, number in enumerate(ids.tolist())}
        points = vtk_to_numpy(servermanager.Fetch(coarse).GetPoints().GetData())
        self.before = points[[place[number] for number in self.first.ids.tolist()]]

    def measured(self, mesh):
        return CADGeometricError(Input=mesh, CAD=self.cad)

    def tell(self):
        first, straight, moved = self.first, self.straight, self.moved
        stage = Stage(self.cad)
        stage.mesh(self.before, first.triangles, self.one)
        stage.balls(self.before[self.triangle])
        stage.save("coarse")

        stage = Stage(self.cad)
        stage.mesh(first.points, first.triangles, self.one)
        stage.ways(self.before[self.triangle], self.corners)
        stage.balls(self.corners)
        stage.save("projected")

        stage = Stage(self.cad)
        stage.mesh(first.points, first.triangles, self.one)
        flat, four = halved(self.corners)
        roof = nearest(flat, self.cad)
        stage.show(source(roof, four), "Surface With Edges", color=MARKED, Opacity=0.6, LineWidth=2)
        stage.ways(flat[3:], roof[3:])
        stage.balls(roof[3:])
        stage.save("measured")

        stage = Stage(self.cad)
        stage.mesh(first.points, first.triangles, first.errors > THRESHOLD)
        stage.save("marked")

        children = straight.inside(self.corners)
        new = [point for point in np.unique(straight.triangles[children]) if straight.ids[point] not in first.ids]
        stage = Stage(self.cad)
        stage.mesh(straight.points, straight.triangles, children)
        stage.balls(straight.points[new])
        stage.save("cut")

        stage = Stage(self.cad)
        stage.mesh(moved.points, moved.triangles, moved.same(straight, children))
        ends = moved.points[[np.flatnonzero(moved.ids == straight.ids[point])[0] for point in new]]
        stage.ways(straight.points[new], ends)
        stage.balls(ends)
        stage.save("moved")
        print(f"{first.errors[self.one][0]:.2e} of the triangle's cell, {np.sum(first.errors > THRESHOLD)} triangles "
              f"marked, {children.sum()} children; all {first.errors.sum():.2e}, then {moved.errors.sum():.2e}")


Story().tell()
