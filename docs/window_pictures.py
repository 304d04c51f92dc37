#!/usr/bin/python3
"""Takes the pictures of the ParaView window for the tutorial: docs/window_pictures.py

Goes through the tutorial's steps in a window of its own (tests/window/window.py), after `make build`.
"""

import glob
import os
import subprocess
import sys
import tempfile

from PIL import Image

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "tests", "window"))
sys.path.insert(0, os.path.join(ROOT, "tests", "docs"))

import pages
from test_window import APPLY, PANEL, PROPERTIES, choose_from_menu, open_file
from window import Window, event, python

IMAGES = os.path.join(ROOT, "docs", "images")
STEP = "/usr/share/opencascade/data/step/linkrods.step"
WIDTH = 900  # Of a saved picture.
TIMEOUT = 300


def make_mesh(folder):
    """Runs the first block of the tutorial, which makes rod.vtk."""
    page = pages.Page(os.path.join(ROOT, "docs", "tutorial.md"))
    block = next(block for block in page.blocks if block.language == "bash")
    subprocess.run(["bash", "-e", "-c", "\n".join(block.lines)], cwd=folder, check=True)
    return os.path.join(folder, "rod.vtk")


# What the toolbar and the eyes of the Pipeline Browser would do, in the window's Python.
SHOW = """
from paraview import simple
view = simple.FindView("RenderView1")
simple.SetActiveView(view)
for (name, _), source in simple.GetSources().items():
    simple.Hide(source, view)
shown = simple.FindSource({name!r})
display = simple.Show(shown, view)
simple.ColorBy(display, ({association!r}, {array!r}))
display.SetRepresentationType({representation!r})
display.EdgeColor = [0.25, 0.25, 0.25]
display.LineWidth = 0.5
display.SetScalarBarVisibility(view, True)
simple.SetActiveSource(shown)
simple.ResetCamera(view)
simple.Render(view)
"""


def select(name):
    return [python("from paraview import simple"), python(f"simple.SetActiveSource(simple.FindSource({name!r}))")]


def show(window, name, association, array, representation):
    script = window.path(f"show_{array}.py")
    with open(script, "w", encoding="utf-8") as file:
        file.write(SHOW.format(name=name, association=association, array=array, representation=representation))
    return python(f"exec(open({script!r}).read(), {{}})")


def play(window, mesh):
    window.play(*open_file(STEP), APPLY, event("cameraToolbar/actionResetCamera", "activate"))
    window.picture("tutorial_cad")
    window.play(*open_file(mesh), APPLY, *choose_from_menu("ProjectOntoCAD"))
    window.picture("tutorial_inputs")
    window.play(APPLY, show(window, "ProjectOntoCAD1", "POINTS", "CADDimension", "Surface With Edges"))
    window.picture("tutorial_projected")
    window.play(*select("rod.vtk"), *choose_from_menu("AdaptToCAD"),
                event(PANEL + "MaximumSteps/LineEdit0", "set_string", "6"), APPLY,
                show(window, "AdaptToCAD1", "CELLS", "GeometricError", "Surface"))  # Its edges would hide the colours.
    window.picture("tutorial_adapted")


def save(name, path):
    image = Image.open(path).convert("RGB")
    image = image.resize((WIDTH, image.height * WIDTH // image.width), Image.Resampling.LANCZOS)
    path = os.path.join(IMAGES, name + ".png")
    image.save(path, optimize=True)
    print(f"{path}: {os.path.getsize(path)} bytes")


def main():
    plugin = glob.glob(os.path.join(ROOT, "build", "release", "lib", "*", "CADRefine", "CADRefine.so"))[0]
    with tempfile.TemporaryDirectory() as folder:
        window = Window(plugin, os.path.join(folder, "window"))
        play(window, make_mesh(folder))
        if window.run(TIMEOUT) != 0:
            sys.exit("the window failed:\n" + window.log())
        if "Traceback" in window.log():
            sys.exit("the window's Python failed:\n" + window.log())
        for name in window.pictures():
            save(name, window.path(name + ".png"))


main()
