"""Mesh files of other programs in the real ParaView window: File > Open of .inp and .msh files, also damaged, Adapt To
CAD, and File > Save Data to a .msh file. Their groups are there, also those of CAD faces.

usage: test_mesh_files.py PLUGIN DATA OUTPUT
"""

import json
import os
import sys

import meshio
from test_window import APPLY, PANEL, PROPERTIES, choose_from_menu, open_file
from window import Window, event, python

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "pvbatch"))
import meshes  # noqa: E402

TIMEOUT = 150

# Runs in the window at its end.
REPORT = """
import json
from paraview import servermanager, simple
readers = [source for source in simple.GetSources().values() if source.GetXMLLabel() == "Mesh Reader"]
whole = simple.FindSource("gmsh4binary.msh")
json.dump({"readers": len(readers), "cells": whole.GetDataInformation().GetNumberOfCells(),
           "fields": whole.FieldData.keys(), "arrays": whole.CellData.keys(), "help": simple.MeshReader.__doc__},
          open(FILE, "w"))
"""


def save_data(path):
    return [event("menubar", "activate", "menu_File"), event("menubar/menu_File", "activate", "actionFileSaveData"),
            event("FileSaveDialog", "filesSelected", path),
            event("/WriterSettingsDialog/widget/OKButton", "activate")]


def damaged(path, target):
    with open(path, "rb") as file, open(target, "wb") as result:
        result.write(file.read()[:9000])
    return target


def check_error(log, cut):
    """One line tells of the damaged file. The other, of VTK's pipeline, the plugin keeps out of the window's messages,
    see pqErrorLines."""
    errors = [line for line in log.splitlines() if "ERR|" in line and "returned failure for request" not in line]
    assert len(errors) == 1 and f"): {cut}: the section Elements has no end" in errors[0], errors


def check_report(path):
    with open(path, encoding="utf-8") as file:
        report = json.load(file)
    assert report["readers"] == 3 and report["cells"] > 0, report
    assert sorted(report["fields"]) == sorted(meshes.GROUPS) and "gmsh:physical" in report["arrays"], report
    assert "* FileName:" in report["help"], f"help() does not list FileName: {report['help']}"


def check_saved(path):
    mesh = meshio.gmsh.read(path)
    assert set(meshes.GROUPS) < set(mesh.field_data), mesh.field_data
    assert any(name.startswith("Face ") for name in mesh.field_data), mesh.field_data
    assert {"tetra", "triangle"} <= set(mesh.cells_dict), mesh


def main():
    plugin, data, output = map(os.path.abspath, sys.argv[1:])
    window = Window(plugin, output)
    meshes.write_gmsh(os.path.join(data, "cylinder.brep"), output)
    saved, report = window.path("saved.msh"), window.path("output", "report.json")
    script = window.path("report.py")
    with open(script, "w", encoding="utf-8") as file:
        file.write(f"FILE = {report!r}\n{REPORT}")
    cut = damaged(window.path("gmsh2text.msh"), window.path("cut.msh"))
    window.play(*open_file(os.path.join(data, "cylinder.brep")), APPLY,
                *open_file(window.path("gmsh.inp")), APPLY,  # No dialog asks for AVS UCD's reader or this one.
                *open_file(window.path("gmsh4binary.msh")), APPLY, *choose_from_menu("AdaptToCAD"),
                event(PROPERTIES + "SearchBox/AdvancedButton", "set_boolean", "true"),
                event(PANEL + "BoundaryCells/CheckBox", "set_boolean", "true"), APPLY)
    window.picture("adapted")
    window.play(*save_data(saved), *open_file(cut), APPLY)
    window.picture("damaged")
    window.play(python(f"exec(open({script!r}).read())"))
    status = window.run(TIMEOUT)
    window.pictures()
    assert status == 0, f"the window ended with {status}; pictures and log are in {output}"
    check_error(window.log(), cut)
    check_report(report)
    check_saved(saved)
    print(f"{len(window.events)} events played; pictures are in {output}")


if __name__ == "__main__":
    main()
