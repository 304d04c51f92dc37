"""RefineWithCAD's time in pvpython or, on several ranks, in pvbatch. Prints a JSON object on rank 0.

    refinement_ours.py box uniform|marked EDGES [--balance 0|1] [--shape tetrahedra|hexahedra]
    refinement_ours.py wing cad|straight MESH [--levels N]

`seconds` is the processor time of the filter alone, `wall` its wall clock time. `peak_bytes` is what the process held
more at its peak than before, when it held the input.
"""

import argparse
import json
import os
import resource
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
PLUGIN_FOLDER = os.path.join(HERE, "..", "..", "plugin")
DATA = os.path.join(HERE, "..", "..", "data")
sys.path.insert(0, PLUGIN_FOLDER)

from cadrefine import session
from paraview import simple

REPETITIONS = 3

# Runs on every rank: its layers of the unit box, and the marks of the cells near its axis along z.
BOX = """
import sys
sys.path.insert(0, {here!r})
import refinement_box
refinement_box.fill(self.GetOutput(), {edges}, {shape!r})
"""


def box(edges, shape):
    source = simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid")
    source.Script = BOX.format(here=HERE, edges=edges, shape=shape)
    source.UpdatePipeline()
    return source


def wing(mesh, projected):
    reader = simple.OpenDataFile(mesh)
    cad = simple.CADReader(FileName=os.path.join(DATA, "naca0012_sharp.igs"))
    source = simple.ProjectOntoCAD(Input=reader, CAD=cad) if projected else reader
    source.UpdatePipeline()
    return source, cad


def resident_bytes():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


def measure(source, cad, **properties):
    """The fastest of a few runs; the peak is that of the first."""
    best = None
    source.UpdatePipeline()
    before = resident_bytes()
    peak = 0
    for _ in range(REPETITIONS):
        refined = simple.RefineWithCAD(Input=source, CAD=cad, **properties)
        started = time.process_time(), time.perf_counter()
        refined.UpdatePipeline()
        seconds, wall = time.process_time() - started[0], time.perf_counter() - started[1]
        peak = peak or 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
        if best is None or seconds < best["seconds"]:
            cells = int(refined.GetClientSideObject().GetOutputDataObject(0).GetFieldData().GetArray("GlobalCells")
                        .GetValue(0))
            refined.UpdatePipelineInformation()
            costs = json.loads(refined.SMProxy.GetProperty("RunStatistics").GetElement(0))
            best = {"made": cells, "seconds": seconds, "wall": wall, "costs": costs}
        simple.Delete(refined)
        del refined
    return {**best, "peak_bytes": peak}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("case", choices=("box", "wing"))
    parser.add_argument("method")
    parser.add_argument("input")
    parser.add_argument("--balance", type=int, default=1)
    parser.add_argument("--levels", type=int, default=1)
    parser.add_argument("--shape", choices=("tetrahedra", "hexahedra"), default="tetrahedra")
    options = parser.parse_args()
    session.start()
    session.load_plugin()
    if options.case == "box":
        source = box(int(options.input), options.shape)
        cad = simple.CADReader(FileName=os.path.join(DATA, "three_arcs.igs"))
        marked = options.method == "marked"
        properties = {"Method": "Longest Edge Bisection" if marked else "Uniform Bisection",
                      "MarkingArray": "Marked" if marked else "None", "ProjectNewVertices": 0,
                      "Balance": options.balance}
    else:
        with_cad = options.method == "cad"
        source, cad = wing(options.input, with_cad)
        properties = {"Method": "Uniform Bisection", "Levels": options.levels, "ProjectNewVertices": int(with_cad)}
    cad.UpdatePipeline()
    print(json.dumps(measure(source, cad, **properties)), flush=True)


if __name__ == "__main__":
    main()
