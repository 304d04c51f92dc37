"""Runs the driver many times in one process, which saves the start of ParaView.

    pvpython many_runs.py RUNS.json RESULTS.json

RUNS is a list of {"arguments": [...], and, if wanted, "fails": "module.function", which then raises OSError, and
"without": a module that cannot be imported}; RESULTS gets the line of each failure, or null.
"""

import errno
import importlib
import json
import os
import sys
import unittest.mock

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "plugin"))

import cadrefine.cli
import cadrefine.options
from cadrefine import session
from cadrefine.results import Results
from cadrefine.terminal import Terminal


def run(arguments):
    """The line of the failure, or None."""
    results = Results()
    try:
        options = cadrefine.options.parse(arguments)
        cadrefine.cli.run(options, results, Terminal(options.quiet), 0.0)
    except session.Failure as failure:
        results.discard()
        return str(failure)
    return None


def run_as_told(told):
    with unittest.mock.patch.dict(sys.modules):
        if "without" in told:
            for name in [name for name in sys.modules if name.split(".")[0] == told["without"]]:
                del sys.modules[name]
            sys.modules[told["without"]] = None
        if "fails" not in told:
            return run(told["arguments"])
        module, _, function = told["fails"].rpartition(".")
        full = OSError(errno.ENOSPC, "No space left on device")
        with unittest.mock.patch.object(importlib.import_module(module), function, side_effect=full):
            return run(told["arguments"])


def main(runs_path, results_path):
    session.start()
    session.load_plugin()
    with open(runs_path, encoding="utf-8") as file:
        results = [run_as_told(told) for told in json.load(file)]
    if session.speaks():
        with open(results_path, "w", encoding="utf-8") as file:
            json.dump(results, file)


if __name__ == "__main__":
    main(*sys.argv[1:])
