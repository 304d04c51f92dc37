"""What the driver tells of a run: lines and the table on standard output, and the report."""

import collections
import math
import re
import time

from cadrefine import session, table
from cadrefine.session import Failure

STEP_VALUES = {  # Key of the step, field data of the mesh.
    "vertices": "GlobalVertices",
    "cells": "GlobalCells",
    "cad_vertices": "CADVertices",
    "projected_points": "ProjectedPoints",
    "global_error": "GlobalGeometricError",
    "maximum_distance": "MaximumGeometricDistance",
    "invalid_cells": "InvalidCells",
    "unprojected_vertices": "UnprojectedVertices",
    "minimum_quality": "MinimumQuality",
    "maximum_chord_error": "MaximumChordError",
    "maximum_normal_angle": "MaximumNormalAngle",
}

ERROR_MEASURES = {2: "area", 3: "volume"}
AUTOMATIC_DEPTH = 2  # Of the filters, where RecursionDepth is 0; they extrapolate it.

PROJECTION_VALUES = {"conflicts": "ClassificationConflicts"}  # Refinement leaves these as they are.

UNREAD = re.compile(r"(?:(?:DE|#)\s*(?P<entity>\d+):\s*)?(?P<type>.*?):\s+(?P<reason>.*)")


class Report:
    def __init__(self, options, terminal, started):
        self.options = options
        self.terminal = terminal
        self.input = {}
        self.steps = []
        self.stopped = None
        self.started = started
        self.seconds = {}
        self.warnings_told = 0
        self.fit = None  # Not known of a mesh that an earlier run projected.
        self.fit_lines = []

    def describe_input(self, pipeline):
        cad = pipeline.cad_values()
        vertices, edges, faces = cad["CADCounts"]
        facts = cad_facts(cad)
        self.input = {"ranks": session.ranks(), "mesh": self.options.mesh,
                      "cad": {"file": self.options.cad, "faces": faces, "edges": edges, "vertices": vertices,
                              **facts}}
        self.seconds = {name: pipeline.seconds[name] for name in ("read_cad", "read_mesh")}
        self.terminal.say(f"CAD: {faces} faces, {edges} edges, {vertices} vertices, unit {facts['unit'] or 'unknown'}, "
                          f"read in {self.seconds['read_cad']:.2f} s")
        for line in left_out_lines(facts):
            self.terminal.say(f"CAD: {line}")
        for line in fault_lines(facts):
            self.refuse_if_strict(self.options.cad, line)
            self.terminal.say(f"CAD: {line}")
        for line in table.headings(self.terminal.style):
            self.terminal.say(line)

    def add_step(self, method, pipeline):
        step = {"step": len(self.steps), "method": method}
        wanted = {**STEP_VALUES, **PROJECTION_VALUES} if method == "projection" else STEP_VALUES
        for key, array in wanted.items():
            if array not in pipeline.values:
                raise Failure(f"{self.options.mesh}: the filters left no field data {array}")
            step[key] = pipeline.values[array]
        step["costs"] = pipeline.costs
        step["seconds"] = {name: pipeline.seconds[name] for name in ("project", "error", "refine")}
        self.steps.append(step)
        if method == "projection":
            self.fit, self.fit_lines = fit_of(pipeline.values), pipeline.fit_report.splitlines()
        for warning in session.messages.warnings[self.warnings_told:]:
            self.refuse_if_strict(self.options.mesh, warning)

    def tell_step(self):
        step = self.steps[-1]
        self.terminal.say(table.row(step, self.terminal.style))
        if step["method"] == "projection":
            for line in self.fit_lines:
                self.terminal.say(f"Fit: {line}")
        for warning in session.messages.warnings[self.warnings_told:]:
            self.terminal.say(self.terminal.style(f"Warning: {warning}", "yellow"))
            self.warnings_told += 1

    def refuse_if_strict(self, path, warning):
        if self.options.strict:
            raise Failure(f"{path}: {warning} (--strict)")

    def end_steps(self, reason):
        """`reason` is that of Adapt To CAD, which names its own properties."""
        last = self.last_step()
        if last["step"] == self.options.uniform_steps + self.options.steps:
            return
        options = {"(MaximumCells)": f"there would be more than {self.options.maximum_cells} cells",
                   "(TargetError)": f"the global error {last['global_error']:.3g} has reached the target"}
        self.stopped = options.get(reason.rpartition(" ")[2], reason)

    def last_step(self):
        return [step for step in self.steps if step["method"] != "quadratic"][-1]

    def tell_why_stopped(self):
        if self.stopped:
            self.terminal.say(f"Stopped after step {self.last_step()['step']}: {self.stopped}")

    def content(self, pipeline, stopped):
        """The report as one JSON object."""
        measured = {"dimension": pipeline.values["MeshDimension"],
                    "error_measure": ERROR_MEASURES[pipeline.values["GeometricErrorDimension"]],
                    "recursion_depth": self.options.recursion_depth or AUTOMATIC_DEPTH,
                    "extrapolated": self.options.recursion_depth == 0}
        return finite({**self.input, **measured, "fit": self.fit, "no_cad": self.options.no_cad, "steps": self.steps,
                       "stopped": stopped, "warnings": session.messages.warnings,
                       "seconds": {**self.seconds, "total": time.perf_counter() - self.started}})


def as_list(value):
    return value if isinstance(value, list) else [] if value is None else [value]


def cad_facts(cad):
    """What the reader's field data tell of the CAD file."""
    gaps = cad.get("CADGaps")
    return {
        "unread": [parse_unread(line) for line in as_list(cad.get("CADUnread"))],
        "left_out": [parse_unread(line) for line in as_list(cad.get("CADLeftOut"))],
        "repairs": as_list(cad.get("CADRepairs")),
        "unit": "".join(as_list(cad.get("CADUnit"))),
        "sewing_tolerance": cad.get("CADSewingTolerance"),
        "inexact": as_list(cad.get("CADInexact")),
        "trim_deviation": cad.get("CADTrimDeviation"),
        "gaps": [{"width": row[0], "point": row[1:4], "edges": [int(e) for e in row[4:6]]} for row in rows_of(gaps, 6)],
    }


def fit_of(values):
    """What the projection found of how mesh and CAD fit together."""
    return {
        "mesh_box": values["MeshBox"],
        "cad_box": values["CADBox"],
        "boundary_on_cad": values["BoundaryOnCAD"],
        "boundary_in_box": values["BoundaryInBox"],
        "cad_covered": values.get("CADCovered"),
        "vertices_off_cad": values["VerticesOffCAD"],
        "farthest": [{"point": row[:3], "distance": row[3]} for row in rows_of(values.get("FarthestVertices"), 4)],
        "bridging_facets": values["BridgingFacets"],
        "bridges": rows_of(values.get("BridgingFacetCentroids"), 3),
        "conflicts": rows_of(values.get("ConflictPoints"), 3),
    }


def rows_of(numbers, length):
    return [numbers[i:i + length] for i in range(0, len(numbers or []), length)]


def left_out_lines(facts):
    for (kind, reason), count in collections.Counter(
            (item["type"], item["reason"]) for item in facts["left_out"]).items():
        yield f"left out: {count} of {kind}: {reason}"


def fault_lines(facts):
    for item in facts["unread"]:
        yield f"not read: {describe(item)}: {item['reason']}"
    for repair in facts["repairs"]:
        yield f"repaired: {repair}"
    for line in facts["inexact"]:
        yield f"inexact: {line}"
    if facts["gaps"]:
        widest = facts["gaps"][0]
        yield (f"{len(facts['gaps'])} gaps wider than {facts['sewing_tolerance']:.3g}, the widest of "
               f"{widest['width']:.3g} near {tuple(widest['point'])}")


def describe(item):
    return (f"entity {item['entity']}, " if item["entity"] else "") + item["type"]


def parse_unread(line):
    """'DE 15: IGES 128 (rational B-spline surface): reason' as an object; entity 0 is the file itself."""
    match = UNREAD.fullmatch(line.strip())
    if not match:
        return {"entity": 0, "type": "", "reason": line.strip()}
    return {"entity": int(match["entity"] or 0), "type": match["type"], "reason": match["reason"]}


def finite(value):
    """JSON knows no NaN and no infinity: null stands for both."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
