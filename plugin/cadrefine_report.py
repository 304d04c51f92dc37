"""What the driver tells: the table on standard output, the report and the convergence plot."""

import collections
import json
import math
import os
import re

import cadrefine_session as session
from cadrefine_session import Failure

COLUMNS = (  # Heading, key of the step, format.
    ("step", "step", "4d"),
    ("vertices", "vertices", "8d"),
    ("cells", "cells", "8d"),
    ("on CAD", "cad_vertices", "8d"),
    ("projected", "projected_points", "8d"),
    ("global error", "global_error", "10.4e"),
    ("largest dist", "maximum_distance", "10.4e"),
    ("invalid", "invalid_cells", "7d"),
    ("off CAD", "unprojected_vertices", "7d"),
    ("min quality", "minimum_quality", "5.3f"),
)

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
    def __init__(self, options):
        self.options = options
        self.input = {}
        self.steps = []
        self.stopped = None
        self.seconds = {}
        self.measured = {}

    def describe_input(self, pipeline):
        cad = pipeline.cad_values()
        counts = {name: pipeline.count_cad(name.capitalize()) for name in ("faces", "edges", "vertices")}
        facts = cad_facts(cad)
        self.input = {"ranks": session.ranks(), "mesh": self.options.mesh,
                      "cad": {"file": self.options.cad, **counts, **facts}}
        self.seconds = {name: pipeline.seconds[name] for name in ("read_cad", "read_mesh")}
        self.say(f"CAD: {counts['faces']} faces, {counts['edges']} edges, {counts['vertices']} vertices, "
                 f"unit {facts['unit'] or 'unknown'}, read in {self.seconds['read_cad']:.2f} s")
        for line in fact_lines(facts):
            self.say(f"CAD: {line}")
        self.say("".join(f"{head:>{column_width(head, style)}}" for head, _, style in COLUMNS) + "  seconds  method")

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
        cells = "".join(table_entry(step[key], head, style) for head, key, style in COLUMNS)
        self.say(f"{cells}{sum(step['seconds'].values()):9.2f}  {method}")
        if step.get("conflicts"):
            self.say(f"Vertices in conflict (CADConflict is 1): {step['conflicts']}")

    def finish(self, pipeline, total):
        self.seconds["total"] = total
        self.measured = {"dimension": pipeline.values["MeshDimension"],
                         "error_measure": ERROR_MEASURES[pipeline.values["GeometricErrorDimension"]],
                         "recursion_depth": self.options.recursion_depth}
        if self.stopped:
            last = [step["step"] for step in self.steps if step["method"] != "quadratic"][-1]
            self.say(f"Stopped after step {last}: {self.stopped}")

    def say(self, line):
        if not self.options.quiet and session.speaks():
            print(line, flush=True)

    def write(self):
        if not session.speaks():
            return
        report = {**self.input, **self.measured, "no_cad": self.options.no_cad, "steps": self.steps,
                  "stopped": self.stopped, "seconds": self.seconds}
        if self.options.report:
            write_whole(self.options.report, json.dumps(finite(report), indent=2) + "\n")
        if self.options.plot:
            plot(report, self.options)


def table_entry(value, heading, style):
    width = column_width(heading, style)
    return f"{'-':>{width}}" if value is None else f"{value:{width}{style.lstrip('0123456789')}}"


def column_width(heading, style):
    width = int(re.match(r"\d+", style).group())
    return max(width, len(heading)) + 2


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


def write_whole(path, text):
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(path + ".part", path)


def load_report(path):
    try:
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
        report["steps"][0]["vertices"], report["steps"][0]["global_error"]
        return report
    except (ValueError, KeyError, IndexError, TypeError):
        raise Failure(f"{path}: is no report of this driver") from None


def plot(report, options):
    """Global error over the number of vertices, with the slope of second order."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    runs = [report] + ([load_report(options.compare_report)] if options.compare_report else [])
    figure, axes = pyplot.subplots(figsize=(7.2, 5.0), layout="constrained")
    for run, color in zip(runs, ("tab:blue", "tab:orange")):
        label = "new vertices stay off the CAD" if run.get("no_cad") else "new vertices on the CAD"
        draw_run(axes, run["steps"], color, label)
    draw_slope(axes, report["steps"], -2.0 / report["dimension"])
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("vertices of the mesh")
    axes.set_ylabel(f"{report['error_measure']} between mesh and CAD")
    axes.set_title(f"{os.path.basename(report['mesh'])} on {os.path.basename(report['cad']['file'])}")
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend()
    figure.savefig(options.plot + ".part", format="png", dpi=150)
    pyplot.close(figure)
    os.replace(options.plot + ".part", options.plot)


def draw_run(axes, steps, color, label):
    """The run's line, its steps marked by their method."""
    shown = [step for step in steps if step["global_error"] and step["global_error"] > 0]
    axes.plot([s["vertices"] for s in shown], [s["global_error"] for s in shown], color=color, label=label)
    for method, marker in (("projection", "D"), ("uniform", "s"), ("longest-edge", "o"), ("quadratic", "^")):
        chosen = [s for s in shown if s.get("method") == method]
        axes.plot([s["vertices"] for s in chosen], [s["global_error"] for s in chosen], marker, color=color,
                  markersize=5, label=None)


def draw_slope(axes, steps, exponent):
    """What second order would do from the first step on."""
    first, last = steps[0], steps[-1]
    if not first["global_error"] or first["vertices"] == last["vertices"]:
        return
    vertices = [first["vertices"], last["vertices"]]
    errors = [first["global_error"], first["global_error"] * (vertices[1] / vertices[0]) ** exponent]
    axes.plot(vertices, errors, "k:", linewidth=1, label="second order")
