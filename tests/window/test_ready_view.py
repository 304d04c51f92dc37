"""The button Show CAD Facets of the real ParaView window: after Adapt To CAD of the air round an aeroplane, the facets on
the aeroplane alone, in colour, as large as they fit; of a cavity in a CAD block its face alone; in the plane the cells
that carry error. With --server the first alone, on two ranks too.

usage: test_ready_view.py PLUGIN DATA OUTPUT [--server]
"""

import os
import sys

import gmsh
import numpy as np

from test_client_server import Server, write
from test_session import read_json
from test_window import APPLY, PANEL, choose_from_menu, open_file
from window import Window, check, event, python

TIMEOUT = 200
RANKS = 2
BUTTON = "CAD Refinement/1QToolButton0"
SHOW = event(BUTTON, "activate")
VIEW_AREA = (310, 210, 940, 1060)  # Beside the chart.

# Runs in the window first: note(name) keeps what the render view shows then.
HELPERS = """
import json
from paraview import servermanager, simple

notes = {}

def visible_in(view):
    shown = [item.Input for item in view.Representations if hasattr(item, "Input") and item.Visibility]
    return [key[0] for key, source in simple.GetSources().items() if any(each == source for each in shown)]

def note(name):
    view, source = simple.GetActiveView(), simple.GetActiveSource()
    display = simple.GetDisplayProperties(source, view)
    colours = display.LookupTable.RGBPoints
    notes[name] = {
        "type": source.GetXMLName(), "visible": visible_in(view), "sources": len(simple.GetSources()),
        "faces": [str(face) for face in getattr(source, "Faces", [])],
        "bounds": source.GetDataInformation().GetBounds(), "cells": source.GetDataInformation().GetNumberOfCells(),
        "colour": list(display.ColorArrayName), "log": display.LookupTable.UseLogScale,
        "scale": [colours[0], colours[-4]], "farthest": source.CellData["GeometricDistance"].GetRange()[1],
        "largest": source.FieldData["MaximumGeometricDistance"].GetRange()[0],
        "eye": list(view.CameraPosition), "focus": list(view.CameraFocalPoint), "angle": view.CameraViewAngle,
        "size": list(view.ViewSize)}
"""


def note(name):
    return python(f"note({name!r})")


def adapt(cad, mesh):
    return [*open_file(cad), APPLY, *open_file(mesh), APPLY, *choose_from_menu("AdaptToCAD"),
            event(PANEL + "MaximumSteps/LineEdit0", "set_string", "1"), APPLY]


def make_cavity(folder):
    """A ball is cut out of a block that is 20 times as wide."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    block, ball = gmsh.model.occ.addBox(-10, -10, -10, 20, 20, 20), gmsh.model.occ.addSphere(0, 0, 0, 1)
    gmsh.model.occ.cut([(3, block)], [(3, ball)])
    gmsh.model.occ.synchronize()
    files = [os.path.join(folder, name) for name in ("cavity.step", "cavity.vtk")]
    gmsh.write(files[0])
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 12)
    gmsh.model.mesh.generate(3)
    gmsh.write(files[1])
    gmsh.finalize()
    return files


def play_aeroplane(window, data):
    window.play(python(f"exec(open({write(window.path('helpers.py'), HELPERS)!r}).read(), globals())"),
                *adapt(*(os.path.join(data, name) for name in ("aeroplane.igs", "aeroplane_coarse.vtu"))),
                check(BUTTON, "enabled", "true"))
    window.picture("adapted")
    window.play(SHOW)
    window.picture("ready")
    window.play(note("aeroplane"), SHOW, note("again"), python("simple.SetActiveSource(simple.FindSource('aeroplane.igs'))"),
                check(BUTTON, "enabled", "false"))


def play_others(window, data):
    window.play(python("simple.ResetSession()"), *adapt(*make_cavity(window.folder)), SHOW)
    window.picture("cavity")
    window.play(note("cavity"), python("simple.ResetSession()"),
                *adapt(*(os.path.join(data, name) for name in ("three_arcs.igs", "three_arcs_coarse.vtu"))), SHOW)
    window.picture("plane")
    window.play(note("plane"))


def run(window, *options):
    result = window.path("output", "notes.json")
    window.play(python(f"json.dump(notes, open({result!r}, 'w'))"))
    pictures = window.run_well(TIMEOUT, *options)
    return read_json(result), pictures


def corners_of(bounds):
    lower, upper = np.array(bounds).reshape(3, 2).T
    return np.array([np.where([number >> k & 1 for k in range(3)], upper, lower) for number in range(8)])


def part_of_view(seen):
    """How large what is shown is at least and at most, in parts of the view's smaller side."""
    eye, focus = np.array(seen["eye"]), np.array(seen["focus"])
    distance = np.linalg.norm(focus - eye)
    diagonal = np.ptp(corners_of(seen["bounds"]), axis=0)
    side = 2 * distance * np.tan(np.radians(seen["angle"]) / 2) * min(1, seen["size"][0] / seen["size"][1])
    return np.linalg.norm(diagonal) / side


def check_scale(seen):
    """It is that of what is shown, which has the largest of all distances."""
    assert seen["colour"] == ["CELLS", "GeometricDistance"] and seen["log"] == 1, seen
    assert abs(seen["scale"][1] / seen["farthest"] - 1) < 1e-9 and seen["farthest"] == seen["largest"] > 0, seen


def check_aeroplane(notes, pictures):
    seen = notes["aeroplane"]
    check_scale(seen)
    assert seen["type"] == "CADBoundary" and seen["visible"] == ["CADBoundary1"] and seen["faces"] == ["*"], seen
    box = np.array([0, 2, -0.95, 0.95, -0.1906, 0.45])  # Of the aeroplane; the air reaches from -2 to 5.
    assert np.abs(np.array(seen["bounds"]) - box).max() < 1e-3, seen
    assert 0.7 < part_of_view(seen) < 1.6, (part_of_view(seen), seen)
    assert notes["again"] == seen, notes["again"]
    before, after = (pictures[name].colors(VIEW_AREA) for name in ("adapted", "ready"))
    assert 5 * before < after, f"{before} colours of the far field, {after} of the aeroplane"


def check_others(notes):
    cavity, plane = notes["cavity"], notes["plane"]
    check_scale(cavity)
    assert len(cavity["faces"]) == 1 and np.abs(cavity["bounds"]).max() < 1.001, cavity
    check_scale(plane)
    assert plane["type"] == "AdaptToCAD" and plane["visible"] == ["AdaptToCAD1"], plane
    assert plane["eye"][2] > 1 and plane["eye"][:2] == plane["focus"][:2], plane


def main():
    plugin, data, output = map(os.path.abspath, sys.argv[1:4])
    with_server = sys.argv[4:] == ["--server"]
    alone = Window(plugin, output)
    play_aeroplane(alone, data)
    if not with_server:
        play_others(alone, data)
    notes, pictures = run(alone)
    check_aeroplane(notes, pictures)
    if not with_server:
        check_others(notes)
    else:
        client = Window(plugin, alone.path("client"))
        play_aeroplane(client, data)
        with Server(client, RANKS) as server:
            remote, pictures = run(client, "--server-url", f"cs://localhost:{server.port}")
        check_aeroplane(remote, pictures)
        assert remote["aeroplane"]["cells"] == notes["aeroplane"]["cells"], remote
    print(f"the pictures are in {output}")


if __name__ == "__main__":
    main()
