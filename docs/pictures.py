"""Makes the pictures of the pages of filters and of the tutorial:

    xvfb-run -a pvpython docs/pictures.py [NAME...]

Runs from the repository's root after `make build`; `make pictures` does it.
"""

import contextlib
import glob
import math
import os
import subprocess
import sys
import tempfile

from paraview.simple import *
from PIL import Image

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
IMAGES = os.path.join(ROOT, "docs", "images")
ROD = "/usr/share/opencascade/data/step/linkrods.step"
CRANK = "/usr/share/opencascade/data/occ/CrankArm.brep"
TETRAHEDRA = """
import sys, gmsh
gmsh.initialize()
gmsh.model.occ.importShapes(sys.argv[1])
gmsh.model.occ.synchronize()
gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)])
gmsh.option.setNumber("Mesh.MeshSizeMin", float(sys.argv[2]))
gmsh.option.setNumber("Mesh.MeshSizeMax", float(sys.argv[2]))
gmsh.model.mesh.generate(3)
gmsh.write(sys.argv[3])
"""
BEARING = "/usr/share/opencascade/data/iges/bearing.iges"
GREY, DARK, EDGE = (0.9, 0.91, 0.93), (0.15, 0.15, 0.2), (0.3, 0.3, 0.36)
HEAT = ((0.96, 0.96, 0.96), (0.98, 0.7, 0.25), (0.7, 0.05, 0.1))
DECADES = 4  # Of a logarithmic scale.


def data(name):
    return OpenDataFile(os.path.join(ROOT, "data", name))


def load_plugin(names):
    """Its filters go into `names`, as globals() of a module."""
    plugins = glob.glob(os.path.join(ROOT, "build", "release", "lib", "*", "CADRefine", "CADRefine.so"))
    LoadPlugin(plugins[0], remote=True, ns=names)


class Scene:
    """A view without decoration; `direction` is from what is looked at to the eye."""

    def __init__(self, size, direction, up=(0, 0, 1)):
        self.view = CreateView("RenderView", ViewSize=list(size))
        self.view.UseColorPaletteForBackground = 0
        self.view.Background = [1, 1, 1]
        self.view.OrientationAxesVisibility = 0
        self.direction, self.up = direction, up

    def show(self, source, kind="Surface", color=GREY, **settings):
        display = Show(source, self.view)
        display.SetRepresentationType(kind)
        display.ColorArrayName = [None, ""]
        display.AmbientColor = display.DiffuseColor = list(color)
        display.EdgeColor = list(EDGE)
        display.Ambient, display.Diffuse = 0.6, 0.45
        for name, value in settings.items():
            setattr(display, name, value)
        return display

    def color(self, display, association, name, heat=None, logarithmic=False, categories=None, title=None, bar=True):
        """Colours by an array: from white to red over the range `heat`, by `categories` (value, text, colour), or over
        the array's range."""
        colors = GetColorTransferFunction(name)
        colors.UseLogScale = 0
        ColorBy(display, (association, name))
        colors.InterpretValuesAsCategories = 1 if categories else 0
        if categories:
            colors.Annotations = [text for value, label, _ in categories for text in (str(value), label)]
            colors.IndexedColors = [part for _, _, color in categories for part in color]
        elif heat:
            middle = math.sqrt(heat[0] * heat[1]) if logarithmic else sum(heat) / 2
            colors.RGBPoints = [part for value, color in zip((heat[0], middle, heat[1]), HEAT) for part in (value, *color)]
        else:
            colors.ApplyPreset("Viridis (matplotlib)", True)
        colors.UseLogScale = 1 if logarithmic else 0
        display.SetScalarBarVisibility(self.view, bar)
        if bar:
            legend = GetScalarBar(colors, self.view)
            legend.Title, legend.ComponentTitle = title or name, ""
            legend.TitleColor = legend.LabelColor = [0, 0, 0]
            legend.TitleFontSize, legend.LabelFontSize = 16, 14
            legend.WindowLocation, legend.Position, legend.ScalarBarLength = "Any Location", [0.1, 0.05], 0.38
            if logarithmic:
                legend.AutomaticLabelFormat, legend.LabelFormat = 0, "%.0e"
                legend.UseCustomLabels, legend.AddRangeLabels = 1, 0
                legend.CustomLabels = [heat[1] * 10.0**-i for i in range(DECADES + 1)]

    def image(self, closer=1.0, centre=None):
        """What the view shows; `centre`: what it looks at, of all that is shown by default."""
        self.view.CameraParallelProjection = 1
        self.view.CameraFocalPoint, self.view.CameraViewUp = [0, 0, 0], list(self.up)
        self.view.CameraPosition = list(self.direction)
        ResetCamera(self.view)
        if centre:
            shift = [c - f for c, f in zip(centre, self.view.CameraFocalPoint)]
            self.view.CameraFocalPoint = list(centre)
            self.view.CameraPosition = [p + s for p, s in zip(self.view.CameraPosition, shift)]
        self.view.CameraParallelScale /= closer
        return self.picture()

    def picture(self):
        """What the view shows, from where its camera is."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "view.png")
            SaveScreenshot(path, self.view, ImageResolution=self.view.ViewSize, OverrideColorPalette="")
            return Image.open(path).convert("RGB")


def save(name, *images):
    """Images side by side."""
    whole = Image.new("RGB", (sum(image.width for image in images), max(image.height for image in images)), "white")
    left = 0
    for image in images:
        whole.paste(image, (left, 0))
        left += image.width
    path = os.path.join(IMAGES, name + ".png")
    whole.save(path, optimize=True)
    print(f"{path}: {os.path.getsize(path)} bytes", flush=True)


def blocks(cad):
    """Faces and edges of a CAD Reader."""
    return (ExtractBlock(Input=cad, Selectors=["/Root/Faces"]), ExtractBlock(Input=cad, Selectors=["/Root/Edges"]))


def on_cad(mesh):
    """The facets whose corners lie on the CAD."""
    chosen = Threshold(Input=ExtractSurface(Input=mesh))
    chosen.Scalars = ["POINTS", "CADDimension"]
    chosen.LowerThreshold, chosen.UpperThreshold = 0, 2
    return chosen


def largest(mesh, name="GeometricError"):
    mesh.UpdatePipeline()
    return mesh.CellData[name].GetRange(0)[1]


DIMENSIONS = ((-1, "none", (0.85, 0.85, 0.85)), (0, "vertex", (0.84, 0.15, 0.16)), (1, "edge", (1.0, 0.6, 0.1)),
              (2, "face", (0.2, 0.5, 0.75)))


def cad_reader():
    cad = CADReader(FileName=BEARING)
    faces, edges = blocks(cad)
    scene = Scene((800, 480), (0.5, -1.0, 0.7))
    colors = ((0.75, 0.82, 0.92), (0.93, 0.8, 0.7), (0.78, 0.9, 0.78), (0.9, 0.78, 0.88), (0.95, 0.93, 0.72),
              (0.72, 0.9, 0.9))
    shown = scene.show(faces)
    scene.color(shown, "CELLS", "CADEntity", bar=False,
                categories=[(number, str(number), colors[number % len(colors)]) for number in range(213)])
    scene.show(edges, color=DARK, LineWidth=1.5)
    save("cad_reader", scene.image(1.35))


def project_onto_cad():
    cad, mesh = CADReader(FileName=os.path.join(ROOT, "data", "naca0012_sharp.igs")), data("naca0012_coarse.vtu")
    projected = ProjectOntoCAD(Input=mesh, CAD=cad, UseRegion=1, Region=[-0.3, 3.3, -1, 3, -0.6, 0.6])
    inside = Calculator(Input=ExtractSurface(Input=mesh), ResultArrayName="inside",
                        Function="(abs(coordsX - 1.5) < 1.8) * (abs(coordsZ) < 0.6)")
    before = Threshold(Input=inside)
    before.Scalars = ["POINTS", "inside"]
    before.LowerThreshold, before.UpperThreshold = 0.5, 1.5
    images = []
    for wing in (before, on_cad(projected)):
        scene = Scene((620 if images else 460, 360), (-0.75, -0.5, 0.45))
        scene.show(blocks(cad)[0], color=(0.55, 0.75, 0.55), Opacity=0.5)
        scene.show(wing, "Surface With Edges")
        if images:
            balls = Glyph(Input=wing, GlyphType="Sphere", GlyphMode="All Points", ScaleFactor=0.06)
            balls.ScaleArray = balls.OrientationArray = ["POINTS", "No scale array"]
            scene.color(scene.show(balls), "POINTS", "CADDimension", categories=DIMENSIONS)
        images.append(scene.image(1.3))
    save("project_onto_cad", *images)


def three_arcs():
    cad = CADReader(FileName=os.path.join(ROOT, "data", "three_arcs.igs"))
    return cad, ProjectOntoCAD(Input=data("three_arcs_coarse.vtu"), CAD=cad)


def cad_geometric_error():
    cad, projected = three_arcs()
    error = CADGeometricError(Input=projected, CAD=cad, RecursionDepth=4)
    scene = Scene((640, 440), (0, 0, 1), (0, 1, 0))
    shown = scene.show(error, "Surface With Edges")
    scene.color(shown, "CELLS", "GeometricError", heat=(0.0, largest(error)), title="GeometricError (area)")
    scene.show(blocks(cad)[1], color=(0.9, 0.1, 0.1), LineWidth=3)
    save("cad_geometric_error", scene.image(1.35))


def refine_with_cad():
    cad, projected = three_arcs()
    images = []
    for mesh in (projected, RefineWithCAD(Input=projected, CAD=cad, Method="Uniform Bisection", Levels=2)):
        scene = Scene((440, 440), (0, 0, 1), (0, 1, 0))
        scene.show(mesh, "Surface With Edges")
        scene.show(blocks(cad)[1], color=(0.9, 0.1, 0.1), LineWidth=3)
        images.append(scene.image(1.4))
    save("refine_with_cad", *images)


def coarsen_with_cad():
    """Behind a front at half the chord."""
    cad, mesh = CADReader(FileName=os.path.join(ROOT, "data", "naca0012_sharp.igs")), data("naca0012_coarse.vtu")
    fine = RefineWithCAD(Input=ProjectOntoCAD(Input=mesh, CAD=cad), CAD=cad, Method="Uniform Bisection", Levels=3)
    marked = PointDatatoCellData(Input=Calculator(Input=fine, ResultArrayName="before", Function="-coordsX"),
                                 PassPointData=1)
    coarse = CoarsenWithCAD(Input=marked, CAD=cad, MarkingArray="before", Threshold=-1.5, TargetError=0.004, Levels=3)
    images = []
    for shown in (fine, coarse):
        scene = Scene((620, 360), (-0.2, -1.0, 0.4))
        scene.show(ExtractSurface(Input=shown), "Surface With Edges", LineWidth=0.6)
        images.append(scene.image(8.0, [1.5, 0.0, 0.0]))
    save("coarsen_with_cad", *images)


def adapt_to_cad():
    cad = CADReader(FileName=os.path.join(ROOT, "data", "cylinder.brep"))
    images, top = [], None
    for steps in (0, 12):
        mesh = AdaptToCAD(Input=data("cylinder_coarse.vtu"), CAD=cad, ErrorMarking="Bulk", ErrorFraction=0.3,
                          MaximumSteps=steps)
        top = top or largest(mesh)
        scene = Scene((480 if images else 640, 440), (0.6, -0.8, 0.55))
        shown = scene.show(ExtractSurface(Input=mesh), "Surface With Edges")
        scene.color(shown, "CELLS", "GeometricError", heat=(top * 10.0**-DECADES, top), logarithmic=True,
                    bar=not images)
        images.append(scene.image(1.1))
    save("adapt_to_cad", *images)


def mesh_validity():
    cut = Clip(Input=MeshValidity(Input=data("part_coarse.vtu")), Crinkleclip=1)
    cut.ClipType.Origin, cut.ClipType.Normal = bounds_centre(cut.Input), [0.0, 1.0, 0.0]
    cut.Invert = 0
    scene = Scene((760, 440), (0.5, -1.0, 0.45))
    scene.color(scene.show(cut, "Surface With Edges"), "CELLS", "CellQuality")
    save("mesh_validity", scene.image(1.15))


def bounds_centre(source):
    source.UpdatePipeline()
    bounds = source.GetDataInformation().GetBounds()
    return [(bounds[2 * axis] + bounds[2 * axis + 1]) / 2 for axis in range(3)]


def quadratic_ball():
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "ball.brep")
        subprocess.run(["/usr/bin/python3", os.path.join(ROOT, "data", "solid_mesh.py"), "ball", "--cad", file,
                        os.path.join(folder, "ball.vtu")], check=True, stdout=subprocess.DEVNULL)
        cad = CADReader(FileName=file)
        projected = ProjectOntoCAD(Input=data("ball_coarse.vtu"), CAD=cad)
        images = []
        for mesh in (projected, RefineWithCAD(Input=projected, CAD=cad, Levels=0, QuadraticCells=1)):
            scene = Scene((400, 400), (0.6, -0.8, 0.4))
            scene.show(mesh, "Surface With Edges", NonlinearSubdivisionLevel=4)
            images.append(scene.image(1.5))
        save("quadratic_ball", *images)


def quadratic_crank():
    """With the nodes that stop on the way to the CAD, and with cells cut so that none does. The mesh has tetrahedra
    alone: ParaView 5.11 crashes where it subdivides quadratic lines."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "crank.vtk")
        subprocess.run(["/usr/bin/python3", "-c", TETRAHEDRA, CRANK, "15.4", file], check=True,
                       stdout=subprocess.DEVNULL)
        cad = CADReader(FileName=CRANK)
        images = []
        for operations in ("Cut only", "All"):
            projected = ProjectOntoCAD(Input=OpenDataFile(file), CAD=cad)
            curved = RefineWithCAD(Input=projected, CAD=cad, Levels=0, QuadraticCells=1, Operations=operations)
            scene = Scene((640, 300), (-0.1, -0.75, 0.65))
            scene.show(ExtractSurface(Input=curved, NonlinearSubdivisionLevel=3), Ambient=0.25, Diffuse=0.75)
            images.append(scene.image(1.9))
        save("quadratic_crank", *images)


@contextlib.contextmanager
def rod_of_the_tutorial():
    """The rod as the tutorial meshes it (its first block)."""
    sys.path.insert(0, os.path.join(ROOT, "tests", "docs"))
    import pages

    block = next(b for b in pages.Page(os.path.join(ROOT, "docs", "tutorial.md")).blocks if b.language == "bash")
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["bash", "-e", "-c", "\n".join(block.lines)], cwd=folder, check=True)
        yield OpenDataFile(os.path.join(folder, "rod.vtk")), CADReader(FileName=ROD)


def cad_boundary():
    with rod_of_the_tutorial() as (mesh, cad):
        boundary = CADBoundary(Input=ProjectOntoCAD(Input=mesh, CAD=cad), CAD=cad)
        scene = Scene((760, 420), (0.5, -0.6, 0.75))
        ColorBy(scene.show(boundary, "Surface With Edges"), ("CELLS", "CADEntity"))
        save("cad_boundary", scene.image(1.3))


def tutorial_meshes():
    """Projected, and after six steps."""
    with rod_of_the_tutorial() as (mesh, cad):
        images, top = [], None
        for steps in (0, 6):
            adapted = AdaptToCAD(Input=mesh, CAD=cad, ErrorMarking="Bulk", MaximumSteps=steps)
            top = top or largest(adapted)
            scene = Scene((640, 480), (0.5, -0.6, 0.75))
            shown = scene.show(ExtractSurface(Input=adapted), "Surface With Edges", LineWidth=0.6)
            scene.color(shown, "CELLS", "GeometricError", heat=(top * 10.0**-DECADES, top), logarithmic=True,
                        bar=not images)
            images.append(scene.image(1.3))
        save("tutorial_meshes", *images)


PICTURES = (cad_reader, project_onto_cad, cad_geometric_error, refine_with_cad, coarsen_with_cad, adapt_to_cad,
            cad_boundary, mesh_validity, quadratic_ball, quadratic_crank, tutorial_meshes)


def main():
    load_plugin(globals())
    wanted = sys.argv[1:] or [picture.__name__ for picture in PICTURES]
    for picture in PICTURES:
        if picture.__name__ in wanted:
            picture()


if __name__ == "__main__":
    main()
