"""The chain of filters that the driver runs: readers, projection, error, refinement.

Each step adds two filters to the chain, and every filter keeps its output. The memory is therefore that of all
meshes together: uniform steps cost 1/7 more than the last mesh alone, longest edge steps at most their number
times the last mesh.
"""

import json
import time

from paraview import simple

import cadrefine_session as session
from cadrefine_input import local_output, open_mesh
from cadrefine_session import Failure

# Names on the command line, and those of the filters.
METHODS = {"longest-edge": "Longest Edge Bisection", "uniform": "Uniform Bisection"}
STRATEGIES = {"threshold": "Threshold", "fraction": "Fraction of Largest", "bulk": "Bulk"}
TITLES = {"project": "projecting", "error": "measuring the error", "refine": "refining"}

# paraview.simple names the filters after their labels: ProjectOntoCAD, "Project onto CAD", is ProjectontoCAD there.


class Pipeline:
    def __init__(self, terminal):
        self.terminal = terminal
        self.mesh = None  # The last filter of the chain.
        self.cad = None
        self.values = {}  # Field data of the last mesh: what was counted over all ranks.
        self.seconds = {}  # Of the last step and of reading.
        self.costs = {}  # Of the last step: what its filters tell of their run, by phase.
        self.mesh_path = ""

    def read_mesh(self, path):
        self.mesh_path = path
        self.mesh = self.timed("read_mesh", lambda: open_mesh(path, self.terminal))

    def check(self, options):
        """Finds what cannot be done with the mesh before any work is."""
        if options.indicator is not None:
            self.largest(options.indicator)
        if options.quadratic and local_output(self.mesh).IsA("vtkPolyData"):
            raise Failure(f"{self.mesh_path}: poly data cannot hold quadratic cells (--quadratic); use a .vtu file")

    def read_cad(self, path):
        self.cad = simple.CADReader(FileName=path)
        self.timed("read_cad", lambda: self.update(self.cad, path, "reading the CAD"))

    def project(self, options):
        self.start_step()
        self.mesh = simple.ProjectontoCAD(Input=self.mesh, CAD=self.cad, MaximumDistance=options.maximum_distance)
        if options.region:
            self.mesh.UseRegion = 1
            self.mesh.Region = options.region
        self.run("project")

    def take_projected(self):
        """Takes the mesh as an earlier run left it, with its places on the CAD."""
        self.start_step()
        if self.mesh.PointData["CADDimension"] is None:
            raise Failure(f"{self.mesh_path}: there is no point array CADDimension: the mesh was not projected")
        validity = simple.MeshValidity(Input=self.mesh)
        session.update(validity, self.mesh_path)
        self.values.update(field_values(local_output(validity)))
        simple.Delete(validity)

    def measure(self, options):
        self.mesh = simple.CADGeometricError(Input=self.mesh, CAD=self.cad, RecursionDepth=options.recursion_depth)
        self.run("error")

    def refine(self, options, method):
        """Returns False, and leaves the mesh as it was, where that makes more than --maximum-cells."""
        before, values = self.mesh, dict(self.values)
        self.start_step()
        self.mesh = simple.RefinewithCAD(Input=self.mesh, CAD=self.cad, MarkingArray="None", IndicatorArray="None")
        self.mesh.Method = METHODS[method]
        self.mesh.ProjectNewVertices = 0 if options.no_cad else 1
        if method == "longest-edge":
            self.mark(options)
        self.run("refine")
        if options.maximum_cells is None or self.values["GlobalCells"] <= options.maximum_cells:
            return True
        simple.Delete(self.mesh)
        self.mesh, self.values = before, values
        return False

    def make_quadratic(self, options):
        """Gives the last mesh its mid-edge nodes; it is not refined further."""
        self.start_step()
        self.mesh = simple.RefinewithCAD(Input=self.mesh, CAD=self.cad, Levels=0, QuadraticCells=1)
        self.mesh.ProjectNewVertices = 0 if options.no_cad else 1
        self.run("refine")

    def start_step(self):
        self.seconds.update(project=0.0, error=0.0, refine=0.0)
        self.costs = {}

    def mark(self, options):
        """Sets by what the last filter, a refinement, marks cells."""
        mesh = self.mesh
        if options.threshold is not None:
            mesh.MarkingArray = "GeometricError"
            mesh.Marking = STRATEGIES[options.marking]
            mesh.Threshold = options.threshold
            mesh.Fraction = options.threshold
        if options.indicator is not None:
            mesh.IndicatorArray = options.indicator
            mesh.IndicatorMarking = STRATEGIES[options.indicator_marking]
            mesh.IndicatorThreshold = options.indicator_threshold
            mesh.IndicatorFraction = options.indicator_threshold
        mesh.ChordTolerance = options.chord_tolerance
        mesh.NormalAngle = options.normal_angle
        mesh.CutFacets = int(options.cut_facets)

    def marks_anything(self, options):
        """False where every cell of the last mesh is below the thresholds."""
        criteria = [(name, bound if strategy == "threshold" else 0.0)
                    for name, strategy, bound in (
                        ("GeometricError", options.marking, options.threshold),
                        (options.indicator, options.indicator_marking, options.indicator_threshold),
                        ("ChordError", "threshold", options.chord_tolerance or None),
                        ("NormalAngle", "threshold", options.normal_angle or None))
                    if bound is not None]
        return not criteria or any(self.largest(name) > bound for name, bound in criteria)

    def largest(self, name):
        """Of a cell array of the last mesh, over all ranks."""
        array = self.mesh.CellData[name]
        if array is None:
            raise Failure(f"{self.mesh_path}: there is no cell array {name}")
        return array.GetRange(0)[1]

    def children_per_cell(self):
        return 2 ** self.values["MeshDimension"]

    def run(self, phase):
        """Runs the last filter, adds its time to `phase` and takes over what it counted."""
        self.timed(phase, lambda: self.update(self.mesh, self.mesh_path, TITLES[phase]))
        self.values.update(field_values(local_output(self.mesh)))
        self.mesh.UpdatePipelineInformation()
        self.costs[phase] = json.loads(self.mesh.SMProxy.GetProperty("RunStatistics").GetElement(0))

    def update(self, proxy, path, title):
        with self.terminal.following(proxy.GetClientSideObject(), title):
            session.update(proxy, path)

    def timed(self, phase, work):
        started = time.perf_counter()
        result = work()
        self.seconds[phase] = self.seconds.get(phase, 0.0) + time.perf_counter() - started
        return result

    def cad_values(self):
        return field_values(local_output(self.cad))

    def count_cad(self, part):
        """Number of CAD entities drawn in this part of the reader's output, over all ranks."""
        information = self.cad.SMProxy.GetOutputPort(0).GetSubsetDataInformation("/Root/" + part, "Hierarchy")
        array = information.GetCellDataInformation().GetArrayInformation("CADEntity")
        return int(array.GetComponentRange(0)[1]) + 1 if array and information.GetNumberOfCells() else 0


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
