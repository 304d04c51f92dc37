#!/usr/bin/python3
"""How many cells adaptive refinement needs for the global geometric error of uniform refinement.

    tests/benchmarks/adaptivity.py [--plots FOLDER] [CASE ...]

Adapt To CAD with bulk marking, against its uniform method on the same mesh.
"""

import argparse
import json
import os

from refinement import HERE, ROOT, run

DATA = os.path.join(ROOT, "data")
NOSE = {"UseRegion": 1, "Region": [0.05, 0.2, -0.25, 0.25, -0.2, 0.2]}
CASES = {  # CAD, mesh, uniform steps, properties.
    "naca": ("naca0012_sharp.igs", "naca0012_coarse.vtu", 5, {}),
    "nose": ("aeroplane.igs", "aeroplane_coarse.vtu", 2, NOSE),
    "cylinder": ("cylinder.brep", "cylinder_coarse.vtu", 5, {}),
}
BULK = {"ErrorMarking": "Bulk", "ErrorFraction": 0.3, "MaximumSteps": 100, "MaximumCells": 0}
UNIFORM = {"Method": "Uniform Bisection", "MaximumCells": 0}
WANTED = 1 / 3


def adapt(case, **properties):
    cad, mesh, _, own = CASES[case]
    files = [os.path.join(DATA, name) for name in (cad, mesh)]
    return run(["pvpython", os.path.join(HERE, "adaptivity_ours.py"), *files, json.dumps({**own, **properties})], 1)


def compare(case):
    """Prints a row a uniform level, and returns the steps of both."""
    uniform = adapt(case, MaximumSteps=CASES[case][2], **UNIFORM)
    adaptive = adapt(case, TargetError=uniform["steps"][-1]["GlobalGeometricError"], **BULK)
    for level in uniform["steps"][1:]:
        step = next(s for s in adaptive["steps"] if s["GlobalGeometricError"] <= level["GlobalGeometricError"])
        print(f"| {case} | {level['Step']:.0f} | {level['GlobalGeometricError']:.2e} | {level['GlobalCells']:,.0f} "
              f"| {step['Step']:.0f} | {step['GlobalCells']:,.0f} | {step['GlobalCells'] / level['GlobalCells']:.2f} |",
              flush=True)
    last = adaptive["steps"][-1]
    print(f"{case}: uniform {uniform['seconds']:.1f} s, adaptive {adaptive['seconds']:.1f} s in {last['Step']:.0f} steps, "
          f"{last['InvalidCells']:.0f} invalid cells, {last['UnprojectedVertices']:.0f} of {last['CADVertices']:.0f} "
          f"vertices off the CAD, least quality {last['MinimumQuality']:.3g}", flush=True)
    return uniform["steps"], adaptive["steps"]


def plot(case, uniform, adaptive, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(5.4, 4.0), layout="constrained")
    for steps, marker, label in ((uniform, "s", "uniform"), (adaptive, "o", "adaptive")):
        axes.loglog([s["GlobalCells"] for s in steps], [s["GlobalGeometricError"] for s in steps], marker + "-",
                    markersize=4, label=label)
    axes.set_xlabel("cells")
    axes.set_ylabel("volume between mesh and CAD")
    axes.set_title(case)
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plots", metavar="FOLDER", help="draw error over cells")
    parser.add_argument("cases", metavar="CASE", nargs="*", default=list(CASES), help=", ".join(CASES))
    arguments = parser.parse_args()
    print(f"Cells for the same global error; wanted: at most {WANTED:.2f}\n")
    print("| case | level | error | cells, uniform | step | cells, adaptive | ratio |\n|---|---|---|---|---|---|---|")
    for case in arguments.cases:
        steps = compare(case)
        if arguments.plots:
            plot(case, *steps, os.path.join(arguments.plots, f"economy_{case}.png"))


if __name__ == "__main__":
    main()
