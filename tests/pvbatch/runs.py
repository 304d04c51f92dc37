"""Runs the driver many times in one process, which saves the start of ParaView.

    pvpython runs.py

Each line on standard input is a run, in JSON: {"arguments": [...]} and, if wanted, "fails": "module.function", which then
raises OSError, and "without": a module that cannot be imported. On standard output follow what the run prints, a line
that says that this was all, and the line of the failure, or null.
"""

import errno
import importlib
import json
import os
import sys
import unittest.mock

import driver

sys.path.insert(0, os.path.join(driver.ROOT, "plugin"))

import cadrefine.cli
import cadrefine.options
from cadrefine import session
from cadrefine.results import Results
from cadrefine.terminal import Terminal

FORGET = "from cadrefine import messages\nmessages.errors.clear()\nmessages.warnings.clear()"  # Of the run before.


def run(arguments):
    """The line of the failure, or None."""
    session.run_on_all_ranks(FORGET)
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


def main():
    session.start()
    session.load_plugin()
    for line in open(0, encoding="utf-8"):  # sys.stdin is an object of ParaView here, with fewer methods
        failure = run_as_told(json.loads(line))
        if session.speaks():
            print(driver.END + json.dumps(failure), flush=True)


if __name__ == "__main__":
    main()
