#!/usr/bin/python3
"""Runs the cases of docs/gallery.md, all of them or those that are named.

    /usr/bin/python3 docs/gallery/gallery.py [CASE ...]

The commands of a case stand in its section of that page and nowhere else; here is only how it is looked at. Each leaves
its mesh, its report and its pictures in build/gallery/CASE.
"""

import argparse
import json
import os
import shlex
import subprocess
import sys

import page

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = os.path.join("build", "gallery")  # As the page names it.
DRIVER = "plugin/cadrefine.py"

VIEWS = {  # Case: the driver's options for its pictures, where its own are not the best.
    "naca": "--view -0.45 -0.85 0.3 --focus 0 0.55 0 0.3 -0.16 0.16",
    "bow": "--view -0.5 0.7 0.3",
    "layers": "--view -0.45 -0.85 0.3",
}
FURTHER_PICTURES = {  # Case: commands in its folder that draw more.
    "tee": "pvpython {here}/groups.py mesh.vtu gmsh:physical groups.png -0.55 -0.7 0.45 "
           "1=inlet 2=outlet 3=branch 4=wall",
    "layers": "pvpython {here}/section.py 0 -1 0 -0.06 0.16 -0.08 0.08 coarse.vtu=before.png mesh.vtu=after.png",
}


class Run:
    """One run of a case: what is made of the page's commands, and where its results go."""

    def __init__(self, case, options):
        self.case = case
        self.options = options
        self.folder = os.path.join(os.path.relpath(options.output, page.ROOT), case.name)

    def path(self, name):
        return os.path.join(page.ROOT, self.folder, name)

    def commands(self):
        """The page's commands as lists of words, in this run's folder."""
        for command in self.case.commands:
            words = [word.replace(f"{FOLDER}/{self.case.name}", self.folder) for word in shlex.split(command)]
            yield self.with_results(words) if DRIVER in words else words

    def with_results(self, words):
        """The driver's command with a report, fewer steps if wanted, and pictures."""
        words = words + ["--report", self.path("report.json")]
        if self.options.steps is not None:
            words += ["--steps", str(min(self.options.steps, int(words[words.index("--steps") + 1])))]
        if not self.options.pictures:
            return words
        return words + ["--screenshot-start", self.path("first.png"), "--screenshot", self.path("last.png"),
                        *VIEWS.get(self.case.name, "").split()]

    def run(self):
        """Returns the report."""
        os.makedirs(self.path(""), exist_ok=True)
        print(f"\n{self.case.name}: {self.case.title}", flush=True)
        for words in self.commands():
            self.execute(words, page.ROOT)
        if self.options.pictures:
            page.side_by_side(self.path("first.png"), self.path("last.png"), self.path("both.png"))
        if self.options.pictures and self.case.name in FURTHER_PICTURES:
            self.execute(shlex.split(FURTHER_PICTURES[self.case.name].format(here=HERE)), self.path(""))
        with open(self.path("report.json"), encoding="utf-8") as file:
            return json.load(file)

    def execute(self, words, folder):
        print(f"$ {shlex.join(words)}", flush=True)
        status = subprocess.run(words, cwd=folder, env=environment(), check=False).returncode
        if status != 0:
            sys.exit(f"gallery: {self.case.name}: exit status {status}")


def processor_seconds(case, options):
    """What the case costs without pictures."""
    before = os.times()
    Run(case, argparse.Namespace(**{**vars(options), "pictures": False})).run()
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def environment():
    """As Open MPI wants it of root."""
    as_root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"} if os.geteuid() == 0 else {}
    return {**as_root, **os.environ}


def parse(arguments, names):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", metavar="CASE", nargs="*", help=f"{', '.join(names)} (default: all)")
    parser.add_argument("--output", default=os.path.join(page.ROOT, FOLDER), help=f"folder (default {FOLDER})")
    parser.add_argument("--steps", type=int, metavar="N", help="at most so many adaptive steps (default: the page's)")
    parser.add_argument("--no-pictures", dest="pictures", action="store_false", help="draw nothing")
    parser.add_argument("--publish", action="store_true", help="put pictures and figures into the page")
    options = parser.parse_args(arguments)
    for name in options.cases:
        if name not in names:
            parser.error(f"{name} is none of {', '.join(names)}")
    if options.publish and (options.steps is not None or not options.pictures):
        parser.error("--publish is for whole cases with pictures")
    return options


def main():
    cases = page.cases()
    options = parse(sys.argv[1:], list(cases))
    if options.pictures and not os.environ.get("DISPLAY"):
        os.execvp("xvfb-run", ["xvfb-run", "--auto-servernum", "--server-args=-screen 0 1280x1024x24 -noreset", sys.executable, *sys.argv])
    for name in options.cases or cases:
        run = Run(cases[name], options)
        seconds = processor_seconds(cases[name], options) if options.publish else None
        report = run.run()
        if options.publish:
            page.publish(run, report, seconds)
        print(f"Results in {run.folder}/: {', '.join(sorted(os.listdir(run.path(''))))}")


if __name__ == "__main__":
    main()
