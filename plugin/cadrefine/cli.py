"""The run of the driver: read, project, adapt, write."""

import json
import time

import cadrefine.options
from cadrefine import output, plot
from cadrefine import report as reporting
from cadrefine import session
from cadrefine.pictures import Pictures
from cadrefine.pipeline import Pipeline
from cadrefine.results import Results
from cadrefine.session import Failure
from cadrefine.terminal import Terminal


class Steps:
    """What becomes of each step of the adaptation."""

    def __init__(self, options, pipeline, report, results):
        self.options = options
        self.pipeline = pipeline
        self.report = report
        self.results = results
        self.pictures = Pictures(options)

    def end(self, kind):
        """Writes the mesh, and the report up to here: the last ones become the results, also where a signal ends the
        run. Then the step is told of."""
        self.report.add_step(kind, self.pipeline)
        if self.options.output:
            self.write()
        self.report.tell_step()
        self.pictures.begin(self.pipeline)

    def write(self):
        place = self.options.output
        path = self.results.path(place, output.companions(place))
        output.write(self.pipeline.mesh, path, self.options)
        write_report(self.options, self.report.content(self.pipeline, "ended by a signal"), self.results)
        self.results.keep_on_signal([result for result in (place, self.options.report) if result],
                                    f"the mesh after step {self.report.steps[-1]['step']}")


def run(options, results, terminal, started):
    """Read, adapt, write what is wanted."""
    for line in cadrefine.options.remarks(options):
        terminal.say(line)
    results.claim(cadrefine.options.results(options))
    other = plot.load_report(options.compare_report) if options.compare_report else None
    report = reporting.Report(options, terminal, started)
    pipeline = Pipeline(terminal)
    pipeline.read_mesh(options.mesh)
    if pipeline.second_order:
        options.quadratic = output.takes_quadratic(options.output)
        terminal.say(f"{options.mesh}: quadratic cells are read as linear ones, and " + (
            "made quadratic again at the end" if options.quadratic else
            f"stay linear in {options.output}, whose format has no quadratic cells"))
    pipeline.check(options)
    pipeline.read_cad(options.cad, options.cad_unit)
    report.describe_input(pipeline)
    steps = Steps(options, pipeline, report, results)
    report.end_steps(pipeline.adapt(options, steps.end))
    report.tell_why_stopped()

    content = report.content(pipeline, report.stopped)
    steps.pictures.draw(pipeline, results)
    write_report(options, content, results)
    write_file(options.plot, lambda path: plot.plot(content, path, other), results)
    results.keep()
    for line in output.remarks(options.output):
        terminal.say(line)


def write_report(options, content, results):
    def report(path):
        with open(path, "w", encoding="utf-8") as file:
            file.write(json.dumps(content, indent=2) + "\n")

    write_file(options.report, report, results)


def write_file(place, write, results):
    """`write` is a function that writes to a path, on the rank that speaks. Without a place it does nothing."""
    if not place:
        return
    path = results.path(place)
    try:
        if session.speaks():
            write(path)
    except OSError as error:
        raise Failure(f"{place}: {error.strerror}") from None


def main(arguments):
    started = time.perf_counter()
    results = Results()
    try:
        session.start()
        options = cadrefine.options.parse(arguments)
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
