"""What the driver tells of a run: lines and the table on standard output, and the report."""

import collections
import math
import re

import cadrefine_session as session
import cadrefine_table as table
from cadrefine_session import Failure

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

PROJECTION_VALUES = {"conflicts": "ClassificationConflicts"}  # Refinement leaves these as they are.

UNREAD = re.compile(r"(?:(?:DE|#)\s*(?P<entity>\d+):\s*)?(?P<type>.*?):\s+(?P<reason>.*)")


class Report:
    def __init__(self, options, terminal):
        self.options = options
        self.terminal = terminal
        self.input = {}
        self.steps = []
        self.stopped = None
        self.seconds = {}
        self.measured = {}
        self.warnings = []

    def describe_input(self, pipeline):
        cad = pipeline.cad_values()
        counts = {name: pipeline.count_cad(name.capitalize()) for name in ("faces", "edges", "vertices")}
        facts = cad_facts(cad)
        self.input = {"ranks": session.ranks(), "mesh": self.options.mesh,
                      "cad": {"file": self.options.cad, **counts, **facts}}
        self.seconds = {name: pipeline.seconds[name] for name in ("read_cad", "read_mesh")}
        self.terminal.say(f"CAD: {counts['faces']} faces, {counts['edges']} edges, {counts['vertices']} vertices, "
                          f"unit {facts['unit'] or 'unknown'}, read in {self.seconds['read_cad']:.2f} s")
        for line in fact_lines(facts):
            self.terminal.say(f"CAD: {line}")
        for line in table.headings(self.terminal.style):
            self.terminal.say(line)

    def add_step(self, method, pipeline):
        step = {"step": len(self.steps), "method": method}
        wanted = {**STEP_VALUES, **PROJECTION_VALUES} if method == "projection" else STEP_VALUES
        for key, array in wanted.items():
            if array not in pipeline.values and method != "input":
                raise Failure(f"{self.options.mesh}: the filters left no field data {array}")
            step[key] = pipeline.values.get(array)  # None: not known of a mesh that an earlier run projected.
        step["costs"] = pipeline.costs
        step["seconds"] = {name: pipeline.seconds[name] for name in ("project", "error", "refine")}
        self.steps.append(step)
        self.terminal.say(table.row(step, self.terminal.style))
        if step.get("conflicts"):
            self.terminal.say(f"Vertices in conflict (CADConflict is 1): {step['conflicts']}")
        for warning in session.messages.warnings[len(self.warnings):]:
            self.terminal.say(self.terminal.style(f"Warning: {warning}", "yellow"))
            self.warnings.append(warning)

    def finish(self, pipeline, total):
        self.seconds["total"] = total
        self.measured = {"dimension": pipeline.values["MeshDimension"],
                         "error_measure": ERROR_MEASURES[pipeline.values["GeometricErrorDimension"]],
                         "recursion_depth": self.options.recursion_depth}
        if self.stopped:
            last = [step["step"] for step in self.steps if step["method"] != "quadratic"][-1]
            self.terminal.say(f"Stopped after step {last}: {self.stopped}")

    def content(self):
        """The report as one JSON object."""
        return finite({**self.input, **self.measured, "no_cad": self.options.no_cad, "steps": self.steps,
                       "stopped": self.stopped, "warnings": self.warnings, "seconds": self.seconds})


def as_list(value):
    return value if isinstance(value, list) else [] if value is None else [value]


def cad_facts(cad):
    """What the reader's field data tell of the CAD file."""
    gaps = cad.get("CADGaps")
    rows = [gaps[i:i + 6] for i in range(0, len(gaps) - 5, 6)] if isinstance(gaps, list) else []
    return {
        "unread": [parse_unread(line) for line in as_list(cad.get("CADUnread"))],
        "left_out": [parse_unread(line) for line in as_list(cad.get("CADLeftOut"))],
        "repairs": as_list(cad.get("CADRepairs")),
        "unit": "".join(as_list(cad.get("CADUnit"))),
        "sewing_tolerance": cad.get("CADSewingTolerance"),
        "gaps": [{"width": row[0], "point": row[1:4], "edges": [int(e) for e in row[4:6]]} for row in rows],
    }


def fact_lines(facts):
    for item in facts["unread"]:
        yield f"not read: {describe(item)}: {item['reason']}"
    for (kind, reason), count in collections.Counter(
            (item["type"], item["reason"]) for item in facts["left_out"]).items():
        yield f"left out: {count} of {kind}: {reason}"
    for repair in facts["repairs"]:
        yield f"repaired: {repair}"
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
