"""Makes a mesh follow its CAD geometry: projects it, measures the geometric error, refines it.

    mpirun -np N pvbatch plugin/cadrefine.py MESH CAD [options]
    pvpython plugin/cadrefine.py MESH CAD [options]

MESH is any file with triangles or tetrahedra that ParaView reads, CAD an IGES, STEP or BREP file. See --help.
"""

import argparse
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import cadrefine_pictures as pictures
import cadrefine_report as reporting
import cadrefine_session as session
from cadrefine_pipeline import Pipeline
from cadrefine_session import Failure

METHODS = {"longest-edge": "Longest Edge Bisection", "uniform": "Uniform Bisection"}


class OptionParser(argparse.ArgumentParser):
    def error(self, message):
        raise Failure(message)


def option_parser():
    parser = OptionParser(prog="cadrefine.py", description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("mesh", metavar="MESH", help="the mesh: .vtu .pvtu .vtk .vtp ...")
    parser.add_argument("cad", metavar="CAD", help="the CAD model: .igs .iges .stp .step .brep")
    parser.add_argument("--output", metavar="FILE", help="write the last mesh, .vtu or .pvtu")

    steps = parser.add_argument_group("steps")
    steps.add_argument("--uniform-steps", type=natural, default=0, metavar="N", help="uniform steps before the others")
    steps.add_argument("--steps", type=natural, default=3, metavar="N", help="refinement steps (default 3)")
    steps.add_argument("--method", choices=list(METHODS), default="longest-edge",
                       help="of --steps: bisect the marked cells at their longest edge (default), or all cells")
    steps.add_argument("--threshold", type=float, metavar="E",
                       help="longest-edge: mark cells whose geometric error is larger (default: all cells)")
    steps.add_argument("--indicator", metavar="ARRAY", help="longest-edge: mark cells by this cell array too")
    steps.add_argument("--indicator-threshold", type=float, metavar="E", help="those whose value is larger")
    steps.add_argument("--maximum-cells", type=natural, metavar="N", help="stop before there are more cells")
    steps.add_argument("--target-error", type=float, metavar="E", help="stop at this global geometric error")

    geometry = parser.add_argument_group("geometry")
    geometry.add_argument("--region", type=float, nargs=6, metavar=("X0", "X1", "Y0", "Y1", "Z0", "Z1"),
                          help="project only vertices inside this box")
    geometry.add_argument("--maximum-distance", type=float, default=0.0, metavar="D",
                          help="leave vertices that are farther from the CAD (default 0: automatic)")
    geometry.add_argument("--recursion-depth", type=natural, default=1, metavar="K", help="of the error (default 1)")
    geometry.add_argument("--no-cad", action="store_true",
                          help="project the mesh, then refine straight: new vertices stay off the CAD, to compare")

    results = parser.add_argument_group("results")
    results.add_argument("--report", metavar="FILE.json", help="write what the table says, and more")
    results.add_argument("--plot", metavar="FILE.png", help="draw the global error over the number of vertices")
    results.add_argument("--compare-report", metavar="FILE.json", help="draw another run's report into the plot")
    results.add_argument("--screenshot", metavar="FILE.png", help="picture of the last mesh (needs a display)")
    results.add_argument("--screenshot-start", metavar="FILE.png", help="the same of the projected mesh")
    results.add_argument("--focus", type=float, nargs=6, metavar=("X0", "X1", "Y0", "Y1", "Z0", "Z1"),
                         help="box that the pictures show (default: all that lies on the CAD)")
    results.add_argument("--quiet", action="store_true", help="print nothing but errors")
    return parser


def natural(text):
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text} is not a number of 0 or more")
    return int(text)


def check_options(options):
    """Finds what is wrong before any work is done."""
    if (options.indicator is None) != (options.indicator_threshold is None):
        raise Failure("--indicator and --indicator-threshold go together")
    for path in (options.mesh, options.cad, options.compare_report):
        if path:
            session.check_readable(path)
    endings = {"output": (".vtu", ".pvtu"), "report": (".json",), "plot": (".png",), "screenshot": (".png",),
               "screenshot_start": (".png",)}
    for name, allowed in endings.items():
        if getattr(options, name):
            session.check_writable(getattr(options, name), allowed)
    if options.screenshot or options.screenshot_start:
        pictures.check_display()


def planned_methods(options):
    return ["uniform"] * options.uniform_steps + [options.method] * options.steps


def reason_to_stop(options, method, last, pipeline):
    """Why the next step must not be taken, or None."""
    if options.target_error is not None and last["global_error"] <= options.target_error:
        return f"the global error {last['global_error']:.3g} has reached the target"
    if options.maximum_cells is not None:
        growth = pipeline.children_per_cell() if method == "uniform" else 1
        if last["cells"] * growth > options.maximum_cells or last["cells"] == options.maximum_cells:
            return f"there would be more than {options.maximum_cells} cells"
    if method == "longest-edge" and not pipeline.marks_anything(options):
        return "no cell is marked"
    return None


def run(options, started):
    """Project once; then error, mark, refine. Returns the report."""
    report = reporting.Report(options)
    pipeline = Pipeline()
    pipeline.read_mesh(options.mesh)
    pipeline.read_cad(options.cad)
    report.describe_input(pipeline)
    pipeline.project(options)
    pipeline.measure(options)
    report.add_step("projection", pipeline)
    largest = pictures.largest_error(pipeline.mesh)  # Both pictures have the same colours.
    if options.screenshot_start:
        pictures.screenshot(pipeline.mesh, options.screenshot_start, options.focus, largest)

    for method in planned_methods(options):
        report.stopped = reason_to_stop(options, method, report.steps[-1], pipeline)
        if report.stopped:
            break
        pipeline.refine(options, method, METHODS[method])
        pipeline.measure(options)
        report.add_step(method, pipeline)
    report.finish(pipeline, time.perf_counter() - started)

    if options.output:
        pipeline.write(options.output)
    if options.screenshot:
        pictures.screenshot(pipeline.mesh, options.screenshot, options.focus, largest)
    report.write()
    return report


def main(arguments):
    started = time.perf_counter()
    try:
        session.start()
        options = option_parser().parse_args(arguments)
        check_options(options)
        session.load_plugin()
        run(options, started)
    except Failure as failure:
        session.fail(str(failure))
    except Exception:  # A fault of the driver: say where, and end all ranks as for any other failure.
        session.fail_with_traceback()


if __name__ == "__main__":
    main(sys.argv[1:])
