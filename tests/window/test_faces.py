"""CAD faces are selected in the view of the real ParaView window, by a frame or a click, and put into the list Faces of
a filter by the buttons below it; in the plane CAD edges. With --server the first on two ranks.

usage: test_faces.py PLUGIN DATA OUTPUT [--server]
"""

import os
import sys

from test_client_server import Server, write
from test_session import VIEW, drag, read_json
from test_window import APPLY, PANEL, choose_from_menu, open_file, panel
from window import Window, event, python

TIMEOUT = 150
RANKS = 2
FRAME = VIEW.rpartition("CentralWidgetFrame")[0]
ADD, EXCLUDE = (event(PANEL + f"Faces/{name}Selected", "activate") for name in ("Add", "Exclude"))
EMPTY = event(PANEL + "Faces/ScalarValueList/RemoveAll", "activate")
TOP = "4"  # Number of the CAD face at the upper end of the cylinder.
ARC = "2"  # Number of the arc on the left.

# Runs in the window first: note(name) keeps what the active filter is told, and the CAD faces that its points lie on.
HELPERS = """
import json
import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

notes = {}

def note(name):
    source = simple.GetActiveSource()
    mesh = servermanager.Fetch(source)
    dimension, entity = (vtk_to_numpy(mesh.GetPointData().GetArray(name)) for name in ("CADDimension", "CADEntity"))
    wanted = 2 if 2 in dimension else 1
    notes[name] = {"faces": [str(face) for face in source.Faces], "on": sorted(set(entity[dimension == wanted].tolist()))}

def show_alone(*names):
    for source in simple.GetSources().values():
        simple.Hide(source)
    for name in names:
        simple.Show(simple.FindSource(name))
    simple.Render()
"""


def note(name):
    return python(f"note({name!r})")


def show_alone(*names):
    return python(f"show_alone(*{names!r})")


def activate(name):
    return python(f"simple.SetActiveSource(simple.FindSource({name!r}))")


def look_at(point):
    """A view along z in which 4 units of length are as high as the view, with `point` in the middle."""
    x, y, z = point
    return [python(f"view = simple.GetActiveView(); {line}; simple.Render()") for line in (
        f"view.CameraFocalPoint = {point}; view.CameraPosition = {(x, y, z + 20)}; view.CameraViewUp = (0, 1, 0)",
        "view.CameraParallelProjection = 1; view.CameraParallelScale = 2")]


def select(start, end):
    """The cells that are seen in a frame of the view: its corners, in parts of its width and height."""
    return [event(FRAME + "actionSelectSurfaceCells", "set_boolean", "true"), *drag(start, end)]


def says(text):
    return panel(("Faces/Message", "text", text))


MIDDLE = (0.47, 0.47), (0.53, 0.53)
NOTHING = ("Nothing is selected: select cells of the CAD in the view (key S), choose this filter again in the Pipeline "
           "Browser, then press the button.")
NO_EDGE = ("The selected cells lie on no CAD edge: select cells of the edges that the CAD Reader draws, or of CAD "
           "Boundary.")
OTHER_CAD = "The selection in cylinder.brep belongs to another CAD than this filter's: select faces of its own CAD."


def add_to(name):
    """A view's selection makes its source the active one."""
    return [activate(name), ADD]


def play_cad(window, data):
    """The upper end of a cylinder, seen from above, on the CAD itself."""
    window.play(python(f"exec(open({write(window.path('helpers.py'), HELPERS)!r}).read(), globals())"),
                *open_file(os.path.join(data, "cylinder.brep")), APPLY,
                *open_file(os.path.join(data, "cylinder_coarse.vtu")), APPLY, *choose_from_menu("ProjectOntoCAD"),
                ADD, *says(NOTHING), show_alone("cylinder.brep"), *look_at((0, 0, 2)), *select(*MIDDLE),
                *add_to("ProjectOntoCAD1"), *panel(("Faces/Message", "visible", "false")))
    window.picture("selected")
    window.play(APPLY, note("added"), ADD, EXCLUDE, APPLY, note("excluded"))


def play_meshes(window):
    """The same on meshes that know their CAD faces: the boundary's cells have an array, the projected mesh's points."""
    window.play(EMPTY, APPLY, *choose_from_menu("CADBoundary"), APPLY, show_alone("CADBoundary1"), *select(*MIDDLE),
                *add_to("ProjectOntoCAD1"), APPLY, note("on the boundary"),
                EMPTY, APPLY, show_alone("ProjectOntoCAD1"), *select(*MIDDLE), ADD, APPLY, note("on the mesh"))


def play_plane(window, data):
    """Arcs in the plane; what was selected before is of another CAD, and of no CAD edge."""
    window.play(*open_file(os.path.join(data, "three_arcs.igs")), APPLY,
                *open_file(os.path.join(data, "three_arcs_coarse.vtu")), APPLY, *choose_from_menu("ProjectOntoCAD"),
                event(PANEL + "CAD/1QComboBox0", "activated", "three_arcs.igs"),
                show_alone("cylinder.brep"), *look_at((0, 0, 2)), *select(*MIDDLE), *add_to("ProjectOntoCAD2"),
                *says(OTHER_CAD), show_alone("three_arcs_coarse.vtu"), *look_at((-2, -2, 0)), *select(*MIDDLE),
                *add_to("ProjectOntoCAD2"), *says(NO_EDGE),
                show_alone("three_arcs.igs"), *look_at((-0.5, 1.5, 0)), *select(*MIDDLE), *add_to("ProjectOntoCAD2"))
    window.picture("plane")
    window.play(APPLY, note("in the plane"))


def notes_of(window, *options):
    result = window.path("output", "notes.json")
    window.play(python(f"json.dump(notes, open({result!r}, 'w'))"))
    window.run_well(TIMEOUT, *options)
    return read_json(result)


def check_cylinder(notes):
    assert notes["added"] == {"faces": [TOP], "on": [int(TOP)]}, notes
    assert notes["excluded"]["faces"] == ["!" + TOP], notes
    assert notes["excluded"]["on"] and int(TOP) not in notes["excluded"]["on"], notes
    assert notes["on the boundary"] == notes["on the mesh"] == notes["added"], notes


def main():
    plugin, data, output = map(os.path.abspath, sys.argv[1:4])
    window = Window(plugin, output)
    play_cad(window, data)
    play_meshes(window)
    if sys.argv[4:] == ["--server"]:
        with Server(window, RANKS) as server:
            notes = notes_of(window, "--server-url", f"cs://localhost:{server.port}")
    else:
        play_plane(window, data)
        notes = notes_of(window)
        assert notes["in the plane"] == {"faces": [ARC], "on": [int(ARC)]}, notes["in the plane"]
    check_cylinder(notes)
    print(f"the pictures are in {output}")


if __name__ == "__main__":
    main()
