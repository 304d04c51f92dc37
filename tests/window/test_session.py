"""A session of work in the real ParaView window: filters that are grey where the input does not fit, the region
dragged in the view, undo and redo, properties copied from filter to filter, colours, state files of both kinds, and a
trace, which is played in pvbatch.

usage: test_session.py PLUGIN DATA OUTPUT
"""

import json
import os
import subprocess
import sys

from test_window import APPLY, PANEL, PROPERTIES, choose_from_menu, open_file, panel
from window import Display, Window, event, python

TIMEOUT = 200

VIEW = ("centralwidget/MultiViewWidget/CoreWidget/qt_tabwidget_stackedwidget/MultiViewWidget1/Container/Frame.0/"
        "CentralWidgetFrame/Viewport")
BUTTONS = PROPERTIES + "scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/PropertiesButtons/"
UNDO, REDO = (event("MainControlsToolbar/" + name, "activate") for name in ("actionUndo", "actionRedo"))

# Runs in the window first: note(name) keeps what the pipeline is then.
HELPERS = """
import json
from paraview import servermanager, simple, smtrace

notes = {}

def values(source):
    return {"region": list(source.Region), "use": source.UseRegion, "distance": source.MaximumDistance,
            "points": source.FieldData["ProjectedPoints"].GetRange(0)[0]}

def filters():
    return [source for key, source in sorted(simple.GetSources().items()) if source.GetXMLName() == "ProjectOntoCAD"]

def note(name):
    for source in filters():
        source.UpdatePipeline()
    notes[name] = [values(source) for source in filters()]

def fitting(file):
    # The filters whose input may be this file as ParaView sees it.
    source = simple.FindSource(file)
    fit = []
    for name in ("ProjectOntoCAD", "CADGeometricError", "RefineWithCAD", "AdaptToCAD", "CADBoundary",
                 "MeshValidity"):
        prototype = servermanager.ProxyManager().SMProxyManager.GetPrototypeProxy("filters", name)
        property = prototype.GetProperty("Input")
        property.RemoveAllUncheckedProxies()
        property.AddUncheckedInputConnection(source.SMProxy, 0)
        if property.IsInDomains():
            fit.append(name)
        property.RemoveAllUncheckedProxies()
    return fit

def colours(name):
    table = simple.GetColorTransferFunction(name)
    points = table.RGBPoints
    return {"log": table.UseLogScale, "categories": table.InterpretValuesAsCategories,
            "range": [points[0], points[-4]], "labels": list(table.Annotations)[:8]}

"""


def note(name):
    return python(f"note({name!r})")


def look_along_z():
    """A view in which 4 units of length are as high as the view, with (0, 0) in the middle."""
    return [python(f"view = simple.GetActiveView(); {line}; simple.Render()") for line in (
        "view.CameraParallelProjection = 1",
        "view.CameraFocalPoint = (0, 0, 1); view.CameraPosition = (0, 0, 20); view.CameraViewUp = (0, 1, 0)",
        "view.CameraParallelScale = 2")]


def drag(start, end):
    """The left button from a place of the view to another one, in parts of its width and height."""
    middle = tuple((a + b) / 2 for a, b in zip(start, end))
    return [event(VIEW, "mousePress", f"({start[0]},{start[1]},1,1,0)"),
            *(event(VIEW, "mouseMove", f"({x},{y},1,0,0)") for x, y in (start, middle, end)),
            event(VIEW, "mouseRelease", f"({end[0]},{end[1]},1,0,0)")]


def state_file(action, dialog, path):
    return [event("menubar", "activate", "menu_File"), event("menubar/menu_File", "activate", action),
            event(dialog, "filesSelected", path)]


def save_state(path):
    ok = [event("/StateOptionsDialog/widget/OKButton", "activate")] if path.endswith(".py") else []
    return [*state_file("actionFileSaveServerState", "FileSaveServerStateDialog", path), *ok]


def load_state(path):
    ok = [event("/LoadStateOptionsDialog/widget/OKButton", "activate")] if path.endswith(".pvsm") else []
    return [*state_file("actionFileLoadServerState", "FileLoadServerStateDialog", path), *ok]


def set_up(window):
    """The helpers are in the window, and what it does from now on is traced."""
    helpers = window.path("helpers.py")
    with open(helpers, "w", encoding="utf-8") as file:
        file.write(HELPERS)
    window.play(python(f"exec(open({helpers!r}).read(), globals())"), python("smtrace.start_trace()"))


def play_inputs(window, data):
    """Opens a CAD file and a mesh. The entry Mesh Validity is grey for the one: nothing comes of it."""
    window.play(*open_file(os.path.join(data, "cylinder.brep")), APPLY, *choose_from_menu("MeshValidity"))
    window.picture("cad")
    window.play(python("notes['of CAD'] = [source.GetXMLName() for source in simple.GetSources().values()]"),
                *open_file(os.path.join(data, "cylinder_coarse.vtu")), APPLY,
                python("notes['fitting'] = fitting('cylinder_coarse.vtu')"))
    window.picture("mesh")


def play_region(window):
    window.play(*choose_from_menu("ProjectOntoCAD"),
                *panel(("CADRegion", "visible", "false")), APPLY, note("whole"),
                event(PANEL + "UseRegion/CheckBox", "set_boolean", "true"),
                *panel(("CADRegion", "visible", "true"), ("CADRegion/ShowBox", "checked", "true")),
                *look_along_z())
    window.picture("box")
    window.play(*drag((0.5, 0.25), (0.5, 0.375)))
    window.picture("dragged")
    window.play(APPLY, note("dragged"))
    window.picture("projected")


def play_undo(window):
    """The Python of the window must not be asked in between: it empties the undo stack."""
    distance = "MaximumDistance/DoubleLineEdit0"
    window.play(event(PANEL + distance, "set_string", "0.25"), APPLY, UNDO, *panel((distance, "text", "0")),
                REDO, *panel((distance, "text", "0.25")), APPLY, note("redone"))


def play_copies(window):
    """Not traced: ParaView leaves pasted properties out of its traces."""
    window.play(python("simple.SetActiveSource(simple.FindSource('ProjectOntoCAD1'))"),
                event(BUTTONS + "PropertiesCopy", "activate"),
                python("simple.SetActiveSource(simple.FindSource('cylinder_coarse.vtu'))"),
                *choose_from_menu("ProjectOntoCAD"),
                event(BUTTONS + "PropertiesPaste", "activate"),
                *panel(("UseRegion/CheckBox", "checked", "true"), ("MaximumDistance/DoubleLineEdit0", "text", "0.25")),
                APPLY, note("copied"))
    window.picture("copied")


def play_error(window):
    window.play(*choose_from_menu("CADGeometricError"), APPLY,
                note_colours("error"),
                python("notes['error'] = simple.GetActiveSource().CellData['GeometricError'].GetRange()[1]"),
                python(f"open({window.path('trace.py')!r}, 'w').write(smtrace.stop_trace())"))
    window.picture("error")


def play_states(window):
    """Leaves state.py and state.pvsm, and loads each of them anew."""
    for name in ("state.pvsm", "state.py"):
        window.play(*save_state(window.path(name)))
    for name in ("state.pvsm", "state.py"):
        window.play(python("simple.ResetSession()"), *load_state(window.path(name)), note(name), note_colours(name))
        window.picture("loaded_" + name.partition(".")[2])


def note_colours(name):
    return python(f"notes[{name!r} + ' colours'] = [colours(name) for name in ('CADEntity', 'GeometricError')]")


def check_inputs(notes):
    assert notes["of CAD"] == ["CADReader"], "a filter took CAD for a mesh: " + str(notes["of CAD"])
    assert notes["fitting"] == ["ProjectOntoCAD", "RefineWithCAD", "AdaptToCAD", "MeshValidity"], notes["fitting"]


def check_region(notes):
    """The upper face was dragged from 1 to a half; nothing else has changed."""
    dragged = notes["dragged"][0]
    assert dragged["use"] == 1 and abs(dragged["region"][3] - 0.5) < 0.01, dragged
    for i, bound in ((0, -1), (1, 1), (2, -0.996), (4, 0), (5, 2)):
        assert abs(dragged["region"][i] - bound) < 1e-3, dragged
    assert 0 < dragged["points"] < notes["whole"][0]["points"], dragged


def check_copies(notes):
    redone = {**notes["dragged"][0], "distance": 0.25}
    assert notes["redone"] == [redone], notes["redone"]
    assert notes["copied"] == [redone, redone], notes["copied"]


def check_colours(notes):
    entities, error = notes["error colours"]
    assert entities["categories"] == 1 and entities["labels"][:4] == ["0", "0", "1", "1"], entities
    largest = notes["error"]
    assert error["log"] == 1 and abs(error["range"][1] / largest - 1) < 1e-9, (error, largest)
    assert abs(error["range"][0] / largest - 1e-4) < 1e-9, error


def check_states(notes):
    for name in ("state.pvsm", "state.py"):
        assert notes[name] == notes["copied"], (name, notes[name])
        assert notes[name + " colours"] == notes["error colours"], (name, notes[name + " colours"])


REPLAY = """
import sys
from paraview import simple
simple.LoadPlugin(sys.argv[1], remote=True, ns=globals())
exec(open(sys.argv[2]).read())
exec(open(sys.argv[3]).read())
note("replayed")
json.dump(notes, open(sys.argv[4], "w"))
"""


def check_trace(window, notes):
    """Played in pvbatch, which has no window, the trace makes the same."""
    script, result = window.path("replay.py"), window.path("replayed.json")
    with open(script, "w", encoding="utf-8") as file:
        file.write(REPLAY)
    with Display(window.path("display")) as display:
        subprocess.run(["pvbatch", script, window.plugin, window.path("trace.py"), window.path("helpers.py"), result],
                       env=window.environment(display), check=True, timeout=100)
    replayed = read_json(result)["replayed"]
    assert replayed == notes["redone"], replayed


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def main():
    plugin, data, output = map(os.path.abspath, sys.argv[1:])
    window = Window(plugin, output)
    set_up(window)
    play_inputs(window, data)
    play_region(window)
    play_undo(window)
    play_error(window)
    play_copies(window)
    play_states(window)
    result = window.path("output", "notes.json")
    window.play(python(f"json.dump(notes, open({result!r}, 'w'))"))
    window.run_well(TIMEOUT)
    notes = read_json(result)
    check_inputs(notes)
    check_region(notes)
    check_copies(notes)
    check_colours(notes)
    check_states(notes)
    check_trace(window, notes)
    print(f"{len(window.events)} events played; pictures are in {output}")


if __name__ == "__main__":
    main()
