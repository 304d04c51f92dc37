"""The filters that the driver runs: readers, and Adapt To CAD, which makes all steps."""

import json
import math
import time

from paraview import simple

from cadrefine import second_order, session
from cadrefine.input import local_output, open_mesh
from cadrefine.session import Failure
from cadrefine.steps import Following

# Names on the command line, and those of the filters.
METHODS = {"longest-edge": "Longest Edge Bisection", "uniform": "Uniform Bisection"}
OPERATIONS = {"all": "All", "cut-only": "Cut only"}
STRATEGIES = {"threshold": "Threshold", "fraction": "Fraction of Largest", "bulk": "Bulk"}
MOST_OF_AN_INT = 2**31 - 1


class Pipeline:
    def __init__(self, terminal):
        self.terminal = terminal
        self.mesh = None  # The source or filter whose output it is.
        self.cad = None
        self.values = {}  # Field data of the last mesh: what was counted over all ranks.
        self.seconds = {}  # Of the last step and of reading.
        self.costs = {}  # Of the last step: what its phases tell of their run, by their names.
        self.mesh_path = ""
        self.fit_report = ""
        self.second_order = False  # What was read had quadratic cells.

    def read_mesh(self, path):
        self.mesh_path = path
        self.mesh = self.timed("read_mesh", lambda: open_mesh(path, self.terminal))
        corners = second_order.with_corners_alone(self.mesh)
        if corners is not None:
            self.mesh, self.second_order = corners, True
            session.update(corners, path)

    def check(self, options):
        """Finds what cannot be done with the mesh before any work is."""
        wanted = [] if options.indicator is None else [(options.indicator, "--indicator")]
        for array, option in wanted + [(name, "--conserve") for name in options.conserve]:
            if self.mesh.CellData[array] is None:
                names = ", ".join(self.mesh.CellData.keys()) or "none"
                raise Failure(f"{self.mesh_path}: the mesh has no cell array {array} ({option}); its cell "
                              f"arrays: {names}")
        if options.quadratic and local_output(self.mesh).IsA("vtkPolyData"):
            raise Failure(f"{self.mesh_path}: poly data cannot hold quadratic cells (--quadratic); use a .vtu file")

    def read_cad(self, path, unit):
        self.cad = simple.CADReader(FileName=path, Drawing=0)
        if unit:
            self.cad.Unit = unit
        with self.terminal.following(self.cad.GetClientSideObject(), "reading the CAD"):
            self.timed("read_cad", lambda: session.update(self.cad, path))

    def adapt(self, options, end_step):
        """Projects the mesh, unless an earlier run did, and adapts it. `end_step(kind)` is called after each step, when
        `mesh`, `values`, `seconds` and `costs` are those of the step. Returns why there was no further one."""
        if options.projected and self.mesh.PointData["CADDimension"] is None:
            raise Failure(f"{self.mesh_path}: the mesh has no point array CADDimension; --projected needs a mesh "
                          "that an earlier run wrote")
        adaptation = simple.AdaptToCAD(Input=self.mesh, CAD=self.cad, **adaptation_properties(options))

        def take_step(mesh):
            self.mesh = mesh
            self.values = field_values(local_output(mesh))
            adaptation.SMProxy.UpdatePropertyInformation()
            self.fit_report = told(adaptation, "FitReport")
            step = json.loads(told(adaptation, "StepStatistics"))
            self.seconds.update(step["seconds"])
            self.costs = step["costs"]
            end_step(step["kind"])

        following = Following(adaptation, take_step)
        parts = 1 + options.uniform_steps + options.steps + int(options.quadratic)
        try:
            with self.terminal.following(adaptation.GetClientSideObject(), parts=parts):
                session.update(adaptation, self.mesh_path)
        finally:
            following.raise_failure()
        self.mesh = adaptation
        table = adaptation.GetClientSideObject().GetOutputDataObject(1)
        return table.GetFieldData().GetAbstractArray("StopReason").GetValue(0)

    def timed(self, phase, work):
        started = time.perf_counter()
        result = work()
        self.seconds[phase] = self.seconds.get(phase, 0.0) + time.perf_counter() - started
        return result

    def cad_values(self):
        return field_values(local_output(self.cad))


def adaptation_properties(options):
    """Of Adapt To CAD, whose 0 stands for no limit."""
    properties = {"StartProjected": int(options.projected), "MaximumDistance": options.maximum_distance,
                  "RecursionDepth": options.recursion_depth, "UniformSteps": options.uniform_steps,
                  "MaximumSteps": options.steps, "Method": METHODS[options.method], "IndicatorArray": "None",
                  "ProjectNewVertices": int(not options.no_cad), "Operations": OPERATIONS[options.operations],
                  "MinimumQuality": options.minimum_quality,
                  "KeepLayers": int(options.keep_layers), "QuadraticCells": int(options.quadratic), "MaximumCells": 0, "TargetError": 0,
                  "Faces": options.faces, "ConservedArrays": options.conserve,
                  "BoundaryCells": int(bool(options.output and options.boundary_cells))}
    if options.region:
        properties.update(UseRegion=1, Region=options.region)
    if options.maximum_cells is not None:
        most = max(options.maximum_cells, 1)
        properties["MaximumCells" if most <= MOST_OF_AN_INT else "LargeMaximumCells"] = most
    if options.target_error is not None:
        properties["TargetError"] = max(options.target_error, math.ulp(0.0))
    if options.method == "longest-edge":
        properties.update(marking_properties(options))
    return properties


def marking_properties(options):
    """By what cells are marked."""
    properties = {"ChordTolerance": options.chord_tolerance, "NormalAngle": options.normal_angle,
                  "CutFacets": int(options.cut_facets is not False),
                  "CoarseningFraction": options.coarsening_fraction}
    properties.update(criterion("Error", *error_marking(options)))
    if options.indicator is not None:
        properties["IndicatorArray"] = options.indicator
        properties.update(criterion("Indicator", options.indicator_marking, options.indicator_threshold))
    return properties


def error_marking(options):
    """How the geometric error marks cells: the strategy, and its threshold or part."""
    others = options.indicator is not None or options.chord_tolerance or options.normal_angle
    strategy = options.marking or ("threshold" if options.threshold is not None else "off" if others else "bulk")
    return strategy, 0.5 if options.threshold is None else options.threshold


def criterion(name, strategy, value):
    """The properties that say how the geometric error ("Error") or the indicator marks cells."""
    if strategy == "off":
        return {name + "Marking": "Off"}
    return {name + "Marking": STRATEGIES[strategy],
            name + ("Threshold" if strategy == "threshold" else "Fraction"): value}


def told(proxy, name):
    """A text that a filter tells of its run."""
    return proxy.SMProxy.GetProperty(name).GetElement(0)


def field_values(data):
    """Field data arrays by name: a number, a list of numbers, or a list of strings. Bytes are left out."""
    values = {}
    arrays = data.GetFieldData()
    for index in range(arrays.GetNumberOfArrays()):
        array = arrays.GetAbstractArray(index)
        if array.GetDataTypeSize() == 1 and array.GetDataTypeAsString() != "string":
            continue
        items = [array.GetValue(i) for i in range(min(array.GetNumberOfValues(), 10000))]
        single = len(items) == 1 and not isinstance(items[0], str)
        values[array.GetName()] = items[0] if single else items
    return values
