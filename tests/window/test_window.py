"""Uses the plugin in the real ParaView window, as a person would: File > Open, Filters > CAD Refinement, the panels,
which have the only CAD chosen, Apply. ParaView's own test player presses the buttons and compares the panels'
fields; what came out is asked of the window's Python.

usage: test_window.py PLUGIN DATA OUTPUT
"""

import json
import os
import sys

from window import Window, check, event, python

TIMEOUT = 150

PROPERTIES = "propertiesDock/propertiesPanel/"
PANEL = PROPERTIES + "scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/PropertiesFrame/ProxyPanel/"
APPLY = event(PROPERTIES + "Accept", "activate")
CAD = ("CAD/1QComboBox0", "currentText", "NACA.IGS")  # Chosen, as it is the only one.
RENDER_AREA = (310, 210, 1590, 1060)

# Runs in the window at the end: what its pipeline holds, as JSON.
REPORT = """
import json
from paraview import simple, servermanager

def definition(group, name):
    hints = servermanager.ProxyManager().SMProxyManager.GetPrototypeProxy(group, name).GetHints()
    menu = hints.FindNestedElementByName("ShowInMenu") if hints else None
    return menu.GetAttribute("category") if menu else None

def describe(source):
    source.UpdatePipeline()
    information = source.GetDataInformation()
    return {"type": source.GetXMLName(), "label": source.GetXMLLabel(), "cells": information.GetNumberOfCells(),
            "properties": {name: text(source, name) for name in source.ListProperties()},
            "cell_arrays": source.CellData.keys(),
            "fields": {name: source.FieldData[name].GetRange(0)[0] for name in source.FieldData.keys()}}

def text(source, name):
    return str(source.GetPropertyValue(name)).strip("'") if name not in ("Input", "CAD") else ""

def charts():
    # Of each line chart: what it draws, and the series that are shown.
    return [{"type": item.Input.GetXMLName(), "port": item.Input.Port, "series": list(item.SeriesVisibility),
             "over": str(item.XArrayName).strip("'"), "log": [int(view.LeftAxisLogScale), int(view.BottomAxisLogScale)],
             "titles": [str(view.LeftAxisTitle), str(view.BottomAxisTitle)]}
            for view in simple.GetViews() if view.GetXMLName() == "XYChartView" for item in view.Representations]

def display_of_cad():
    reader = [source for source in simple.GetSources().values() if source.GetXMLName() == "CADReader"][0]
    view = [view for view in simple.GetViews() if view.GetXMLName() == "RenderView"][0]
    display = simple.GetDisplayProperties(reader, view)
    return {"array": list(display.ColorArrayName), "mapped": display.MapScalars, "blocks": list(display.BlockColors)}

adapted = [source for source in simple.GetSources().values() if source.GetXMLName() == "AdaptToCAD"][0]
report = {"scale": list(simple.GetColorTransferFunction("GeometricError").RGBPoints)[0::4],
          "largest": adapted.CellData["GeometricError"].GetRange()[1], "cad": display_of_cad(), "charts": charts(),
          "sources": {key[0]: describe(source) for key, source in simple.GetSources().items()},
          "menu": {name: definition("filters", name) for name in FILTERS},
          "functions": [name for name in FUNCTIONS if hasattr(simple, name)], "help": simple.AdaptToCAD.__doc__}
with open(FILE, "w") as file:
    json.dump(report, file)
"""

FILTERS = {"ProjectOntoCAD": "Project Onto CAD", "CADGeometricError": "CAD Geometric Error",
           "RefineWithCAD": "Refine With CAD", "CADBoundary": "CAD Boundary", "MeshValidity": "Mesh Validity",
           "AdaptToCAD": "Adapt To CAD"}
FUNCTIONS = ["CADReader", "MeshReader"] + [label.replace(" ", "") for label in FILTERS.values()]
FUNCTIONS += ["ProjectontoCAD", "RefinewithCAD", "AdapttoCAD"]  # The old names.


def open_file(path):
    return [event("menubar/menu_File", "activate", "actionFileOpen"), event("FileOpenDialog", "filesSelected", path)]


def choose_from_menu(name):
    return [event("menubar", "activate", "menuFilters"),
            event("menubar/menuFilters/CAD Refinement", "activate", name)]


def panel(*fields):
    """The fields of the panel and what they must hold: (name, Qt property, value)."""
    return [check(PANEL + name, qt_property, value) for name, qt_property, value in fields]


def chosen_marking(strategy, threshold, fraction):
    """Chooses how the error marks cells, and looks whether its threshold and its fraction are shown."""
    return [event(PANEL + "ErrorMarking/ComboBox", "activated", strategy),
            *panel(("ErrorThreshold", "visible", threshold), ("ErrorFraction", "visible", fraction))]


def use(window, name, *actions):
    """Makes a filter from the menu, looks at its panel, changes it, and applies it."""
    window.play(*choose_from_menu(name))
    if name != "MeshValidity":
        window.play(*panel(CAD))
    window.play(*actions)
    window.picture("panel_" + name)
    window.play(APPLY)
    window.picture("applied_" + name)


def coloured_copy(source, target):
    """Copies an IGES file and gives its surfaces colours: a number in the second line of a directory entry."""
    with open(source, encoding="ascii") as file:
        lines = file.readlines()
    surfaces = [i for i, line in enumerate(lines) if line[72] == "D" and line.startswith("     128")]
    for count, i in enumerate(surfaces[1::2]):
        lines[i] = lines[i][:16] + f"{2 + count // 2 % 6:8}" + lines[i][24:]
    with open(target, "w", encoding="ascii") as file:
        file.writelines(lines)
    return target


def play_all(window, data):
    cad = coloured_copy(os.path.join(data, "naca0012_sharp.igs"), window.path("NACA.IGS"))
    window.play(*open_file(cad),
                event(PROPERTIES + "SearchBox/AdvancedButton", "set_boolean", "true"),
                *panel(("TessellationTolerance/DoubleRangeWidget/DoubleLineEdit", "text", "0.001")), APPLY)
    window.picture("cad")
    window.play(*open_file(os.path.join(data, "naca0012_coarse.vtu")), APPLY,
                event("cameraToolbar/actionResetCamera", "activate"))
    window.picture("mesh")
    window.play(event("menubar", "activate", "menuFilters"),
                event("menubar/menuFilters", "activate", "CAD Refinement"))
    window.picture("menu")
    use(window, "ProjectOntoCAD",
        *panel(("UseRegion/CheckBox", "checked", "false"), ("MaximumDistance/DoubleLineEdit0", "text", "0")),
        event(PANEL + "UseRegion/CheckBox", "set_boolean", "true"),
        event(PANEL + "CADRegion/Bound1", "set_string", "6.5"),
        event(PANEL + "CADRegion/Bound5", "set_string", "4.25"),
        *panel(("CADRegion", "visible", "true"), ("CADRegion/Bound1", "text", "6.5"), ("CADRegion/Bound5", "text", "4.25")))
    use(window, "CADGeometricError",
        *panel(("RecursionDepth/IntRangeWidget/LineEdit", "text", "1")),
        event(PANEL + "RecursionDepth/IntRangeWidget/LineEdit", "set_string", "2"))
    use(window, "RefineWithCAD",
        *panel(("Method/ComboBox", "currentText", "Longest Edge Bisection"), ("Method/ComboBox", "count", "2"),
               ("Levels/IntRangeWidget/LineEdit", "text", "1"), ("MarkingArray/ComboBox", "currentText", "None"),
               ("Threshold", "visible", "false"), ("Fraction", "visible", "false"),
               ("ProjectNewVertices/CheckBox", "checked", "true"),
               ("Balance/CheckBox", "checked", "true")),
        event(PANEL + "Method/ComboBox", "activated", "Uniform Bisection"),
        *panel(("MarkingArray", "visible", "false"), ("ChordTolerance", "visible", "false")),
        event(PANEL + "Method/ComboBox", "activated", "Longest Edge Bisection"),
        event(PANEL + "MarkingArray/ComboBox", "activated", "GeometricError"),
        *panel(("Threshold", "visible", "true"), ("Threshold/DoubleLineEdit0", "text", "0"),
               ("Fraction", "visible", "false")),
        event(PANEL + "Threshold/DoubleLineEdit0", "set_string", "1e-5"))
    use(window, "MeshValidity")
    use(window, "CADBoundary")
    window.play(python("from paraview import simple"),
                python("simple.SetActiveSource(simple.FindSource('naca0012_coarse.vtu'))"))
    use(window, "AdaptToCAD",
        *panel(("MaximumSteps/LineEdit0", "text", "5"), ("MaximumCells/LineEdit0", "text", "10000000"),
               ("ErrorMarking/ComboBox", "currentText", "Automatic"),
               ("ErrorThreshold", "visible", "true"), ("ErrorFraction", "visible", "true")),
        *chosen_marking("Threshold", "true", "false"), *chosen_marking("Off", "false", "false"),
        *chosen_marking("Fraction of Largest", "false", "true"),
        event(PANEL + "MaximumSteps/LineEdit0", "set_string", "3"))


def play_two_cads(window, data):
    """With a second CAD in the pipeline, a projected mesh keeps its own; a mesh that was not waits for a choice."""
    delete = event(PROPERTIES + "Delete", "activate")
    window.play(*open_file(os.path.join(data, "cylinder.brep")), APPLY,
                python("simple.SetActiveSource(simple.FindSource('RefineWithCAD1'))"),
                *choose_from_menu("CADGeometricError"), *panel(CAD), delete,
                python("simple.SetActiveSource(simple.FindSource('naca0012_coarse.vtu'))"),
                *choose_from_menu("ProjectOntoCAD"), *panel((*CAD[:2], "(none)"), ("CAD/1QComboBox0", "count", "3")),
                delete, python("simple.Delete(simple.FindSource('cylinder.brep'))"))


def report_of(window):
    """Has the window write its report after all other events; returns the report's path."""
    path = window.path("output", "report.json")
    script = window.path("report.py")
    with open(script, "w", encoding="utf-8") as file:
        file.write(f"FILTERS, FUNCTIONS, FILE = {list(FILTERS)!r}, {FUNCTIONS!r}, {path!r}\n{REPORT}")
    window.play(python(f"exec(open({script!r}).read(), {{}})"), event("", "file_exists", path))
    return path


def by_type(report, name):
    found = [source for source in report["sources"].values() if source["type"] == name]
    assert len(found) == 1, f"{len(found)} of {name} in the pipeline: {list(report['sources'])}"
    return found[0]


def check_registered(report):
    for name, label in FILTERS.items():
        assert by_type(report, name)["label"] == label
        assert report["menu"][name] == "CAD Refinement", f"{name} is in the menu {report['menu'][name]}"
    assert by_type(report, "CADReader")["label"] == "CAD Reader"
    assert report["functions"] == FUNCTIONS, f"paraview.simple has only {report['functions']}"
    for name in set(by_type(report, "AdaptToCAD")["properties"]) - {"FitReport", "RunStatistics", "StepStatistics"}:
        assert f"* {name}:" in report["help"], f"help() does not list {name}: {report['help']}"


def check_cad(report):
    """Faces are drawn in the colours of the file, edges and vertices dark."""
    assert report["cad"]["array"] == ["CELLS", "Color"] and report["cad"]["mapped"] == 0, report["cad"]
    assert [text for text in report["cad"]["blocks"] if "/" in text] == ["/Root/Edges", "/Root/Vertices"], report["cad"]


def check_results(report):
    project = by_type(report, "ProjectOntoCAD")
    assert project["properties"]["UseRegion"] == "1", project["properties"]
    assert "6.5" in project["properties"]["Region"] and "4.25" in project["properties"]["Region"], project["properties"]
    error = by_type(report, "CADGeometricError")
    assert error["properties"]["RecursionDepth"] == "2", error["properties"]
    assert {"GeometricError", "GeometricDistance"} <= set(error["cell_arrays"])
    assert error["fields"]["GlobalGeometricError"] > 0
    refine = by_type(report, "RefineWithCAD")
    assert refine["properties"]["MarkingArray"] == "GeometricError", refine["properties"]
    assert float(refine["properties"]["Threshold"]) == 1e-5, refine["properties"]
    assert refine["cells"] > project["cells"] > 0
    validity = by_type(report, "MeshValidity")
    assert {"CellValidity", "CellQuality"} <= set(validity["cell_arrays"])
    assert validity["fields"]["InvalidCells"] == 0 and validity["cells"] == refine["cells"]


def check_adaptation(report):
    """The mesh that Adapt To CAD made, and the line chart of its steps."""
    adapt = by_type(report, "AdaptToCAD")
    assert adapt["properties"]["MaximumSteps"] == "3" and adapt["properties"]["ErrorMarking"] == "Fraction of Largest"
    assert {"GeometricError", "ChordError", "NormalAngle"} <= set(adapt["cell_arrays"])
    assert adapt["cells"] > by_type(report, "ProjectOntoCAD")["cells"]
    assert len(report["charts"]) == 1, report["charts"]
    assert report["charts"][0] == {"type": "AdaptToCAD", "port": 1, "series": ["GlobalGeometricError"],
                                   "over": "GlobalCells", "log": [1, 1],
                                   "titles": ["Global geometric error (area or volume)", "Cells"]}, report["charts"]
    ends = report["scale"][0] / report["largest"], report["scale"][-1] / report["largest"]
    assert abs(ends[0] - 1e-4) < 1e-9 and abs(ends[1] - 1) < 1e-9, f"the scale has {ends} of the largest error"


def check_pictures(pictures):
    """No picture is empty, and each shows something else than the one before it."""
    expected = {"cad", "mesh", "menu"} | {f"{kind}_{name}" for name in FILTERS for kind in ("panel", "applied")}
    assert expected <= set(pictures), f"no pictures {expected - set(pictures)}"
    for name, picture in pictures.items():
        assert picture.colors() > 100, f"the picture {name} has {picture.colors()} colours"
    assert pictures["cad"].colors(RENDER_AREA) > 20, "the CAD is not drawn"
    for name in FILTERS:
        before, after = pictures["panel_" + name], pictures["applied_" + name]
        assert (before.pixels != after.pixels).any(), f"nothing changed when {name} was applied"


def main():
    plugin, data, output = map(os.path.abspath, sys.argv[1:])
    window = Window(plugin, output)
    play_all(window, data)
    play_two_cads(window, data)
    report_path = report_of(window)
    pictures = window.run_well(TIMEOUT)
    with open(report_path, encoding="utf-8") as file:
        report = json.load(file)
    check_registered(report)
    check_cad(report)
    check_results(report)
    check_adaptation(report)
    check_pictures(pictures)
    print(f"{len(window.events)} events played and {len(pictures)} pictures taken; they are in {output}")


if __name__ == "__main__":
    main()
