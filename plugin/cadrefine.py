"""Makes a mesh follow its CAD geometry: projects it, measures the geometric error, refines it.

    mpirun -np N pvbatch plugin/cadrefine.py MESH CAD [options]
    pvpython plugin/cadrefine.py MESH CAD [options]

MESH is any file with triangles or tetrahedra that ParaView reads, CAD an IGES, STEP or BREP file. See --help.
"""

import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import cadrefine_options
import cadrefine_pictures as pictures
import cadrefine_report as reporting
import cadrefine_session as session
from cadrefine_pipeline import Pipeline
from cadrefine_session import Failure


def planned_methods(options):
    return ["uniform"] * options.uniform_steps + [options.method] * options.steps


def too_many_cells(options):
    return f"there would be more than {options.maximum_cells} cells"


def reason_to_stop(options, method, last, pipeline):
    """Why the next step must not be taken, or None."""
    if options.target_error is not None and last["global_error"] <= options.target_error:
        return f"the global error {last['global_error']:.3g} has reached the target"
    if options.maximum_cells is not None:
        growth = pipeline.children_per_cell() if method == "uniform" else 1
        if last["cells"] * growth > options.maximum_cells or last["cells"] == options.maximum_cells:
            return too_many_cells(options)
    if method == "longest-edge" and not pipeline.marks_anything(options):
        return "no cell is marked"
    return None


def run(options, started):
    """Project once, unless an earlier run did; then error, mark, refine; quadratic cells at the end."""
    report = reporting.Report(options)
    pipeline = Pipeline()
    pipeline.read_mesh(options.mesh)
    pipeline.check(options)
    pipeline.read_cad(options.cad)
    report.describe_input(pipeline)
    if options.projected:
        pipeline.take_projected()
    else:
        pipeline.project(options)
    pipeline.measure(options)
    report.add_step("input" if options.projected else "projection", pipeline)
    largest = pictures.largest_error(pipeline.mesh)  # Both pictures have the same colours.
    if options.screenshot_start:
        pictures.screenshot(pipeline.mesh, options.screenshot_start, options, largest)

    for method in planned_methods(options):
        report.stopped = reason_to_stop(options, method, report.steps[-1], pipeline)
        if report.stopped:
            break
        if not pipeline.refine(options, method):
            report.stopped = too_many_cells(options)
            break
        pipeline.measure(options)
        report.add_step(method, pipeline)
    if options.quadratic:
        pipeline.make_quadratic(options)
        pipeline.measure(options)
        report.add_step("quadratic", pipeline)
    report.finish(pipeline, time.perf_counter() - started)

    if options.output:
        pipeline.write(options.output)
    if options.screenshot:
        pictures.screenshot(pipeline.mesh, options.screenshot, options, largest)
    report.write()
    return report


def main(arguments):
    started = time.perf_counter()
    try:
        session.start()
        options = cadrefine_options.parse(arguments, __doc__.splitlines()[0])
        session.load_plugin()
        run(options, started)
    except Failure as failure:
        session.fail(str(failure))
    except Exception:  # A fault of the driver: say where, and end all ranks as for any other failure.
        session.fail_with_traceback()


if __name__ == "__main__":
    main(sys.argv[1:])
