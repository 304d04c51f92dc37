"""Makes a mesh follow its CAD geometry: projects it, measures the geometric error, refines it.

    mpirun -np N pvbatch plugin/cadrefine.py MESH CAD [options]
    pvpython plugin/cadrefine.py MESH CAD [options]

MESH is any file with triangles or tetrahedra that ParaView reads, CAD an IGES, STEP or BREP file. See --help.
"""

import json
import os
import signal
import sys
import time

for ending in (signal.SIGINT, signal.SIGTERM):  # At once; VTK's own handlers print pages, and may hang.
    signal.signal(ending, signal.SIG_DFL)
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import cadrefine_options
import cadrefine_output
import cadrefine_pictures as pictures
import cadrefine_plot
import cadrefine_report as reporting
import cadrefine_session as session
from cadrefine_files import Results
from cadrefine_pipeline import Pipeline
from cadrefine_session import Failure
from cadrefine_terminal import Terminal


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


def adapt(options, pipeline, report):
    """Error, mark, refine, until it is enough; quadratic cells at the end."""
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


def run(options, results, terminal, started):
    """Project once, unless an earlier run did; then adapt; then write what is wanted."""
    for line in cadrefine_options.remarks(options):
        terminal.say(line)
    results.claim(cadrefine_options.results(options))
    other = cadrefine_plot.load_report(options.compare_report) if options.compare_report else None
    report = reporting.Report(options, terminal)
    pipeline = Pipeline(terminal)
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
        pictures.screenshot(pipeline.mesh, results.path(options.screenshot_start), options, largest)
    adapt(options, pipeline, report)
    report.finish(pipeline, time.perf_counter() - started)

    if options.output:
        path = results.path(options.output, cadrefine_output.companions(options.output))
        cadrefine_output.write(pipeline.mesh, path, options.output)
    if options.screenshot:
        pictures.screenshot(pipeline.mesh, results.path(options.screenshot), options, largest)
    write_report(options, report.content(), other, results)
    results.keep()
    for line in cadrefine_output.remarks(options.output):
        terminal.say(line)


def write_report(options, content, other, results):
    def report(path):
        with open(path, "w", encoding="utf-8") as file:
            file.write(json.dumps(content, indent=2) + "\n")

    for place, write in ((options.report, report),
                         (options.plot, lambda path: cadrefine_plot.plot(content, path, other))):
        if place and session.speaks():
            try:
                write(results.path(place))
            except OSError as error:
                raise Failure(f"{place}: {error.strerror}") from None


def main(arguments):
    started = time.perf_counter()
    results = Results()
    try:
        session.start()
        options = cadrefine_options.parse(arguments)
        if options is None:  # The help was wanted.
            return
        session.load_plugin()
        run(options, results, Terminal(options.quiet), started)
    except Failure as failure:
        results.discard()
        session.fail(str(failure))
    except Exception:  # A fault of the driver: say where, and end all ranks as for any other failure.
        results.discard()
        session.fail_with_traceback()


if __name__ == "__main__":
    main(sys.argv[1:])
