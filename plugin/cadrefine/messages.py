"""What VTK says on each rank: errors, and warnings of the filters. Every rank has this module, also those that run no
script."""

import contextlib
import ctypes
import io
import os
import re
import sys

from vtkmodules.util.misc import calldata_type
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow, vtkUnsignedCharArray
from vtkmodules.vtkParallelCore import vtkMultiProcessController

# The filter whose warnings are for the user. (What the CAD Reader warns of is in its field data.)
WARNING = ("vtkAdaptToCAD",)
# VTK writes ranges of arrays into its files, and cannot read them where they are infinite; the arrays it can.
HARMLESS = "Error reading InformationKey element for vtkDataArray::"
# What the filters say of their properties, and what it is called here.
WORDINGS = ((r"\(Region\)", "(--region)"), (r"\(Faces\)", "(--faces)"), (r"\(ConservedArrays\)", "(--conserve)"),
            (r"\bMaximumDistance\b", "--maximum-distance"), (r"\bchoose Quadratic Cells\b", "give --quadratic"),
            (r"set Unit of the CAD Reader to \w+ \(driver: (--cad-unit \w+)\)", r"give \1"))
errors = []  # Of this rank since they were last taken.
warnings = []  # Of this rank, each once.
everywhere = []  # Errors of all ranks, after share().


def observe():
    """From now on errors are collected, and told once; no rank prints them."""

    @calldata_type("string0")
    def collect(_window, _event, text):
        errors.append(text)

    @calldata_type("string0")
    def collect_warning(_window, _event, text):
        if any(f"\n{name} (" in text for name in WARNING) and reason_of(text) not in warnings:
            warnings.append(reason_of(text))

    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    vtkOutputWindow.GetInstance().AddObserver("ErrorEvent", collect)
    vtkOutputWindow.GetInstance().AddObserver("WarningEvent", collect_warning)


def take():
    """This rank's errors, as lines; they are forgotten."""
    lines = reasons(errors)
    errors.clear()
    return lines


def reasons(texts):
    """VTK's errors as lines, without those that only follow from others."""
    lines = [reason_of(text) for text in texts if text.strip() and HARMLESS not in text]
    return [line for line in lines if "returned failure for request" not in line] or lines


@contextlib.contextmanager
def silence():
    """Libraries write their own warnings and errors, from Python and from C; ours is one line. What VTK says is wrong
    goes to the list that is given, and to nobody else."""
    said = []

    @calldata_type("string0")
    def collect(_window, _event, text):
        said.append(text)

    flush()
    window, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    window.AddObserver("ErrorEvent", collect)
    kept = {number: os.dup(number) for number in (1, 2)}
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        vtkOutputWindow.SetInstance(window)
        for number in kept:
            os.dup2(nowhere, number)
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            yield said
    finally:
        flush()
        for number, copy in kept.items():
            os.dup2(copy, number)
            os.close(copy)
        os.close(nowhere)
        vtkOutputWindow.SetInstance(before)


def flush():
    """What was printed goes out now: Python's, and C's, in whose buffer flush() of ParaView 5.13 leaves it where
    standard output is no terminal. A process that a signal ends would lose it."""
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL(None).fflush(None)


def share():
    """Takes the errors of all ranks, those of rank 0 first, into `everywhere`. All ranks do so together."""
    controller = vtkMultiProcessController.GetGlobalController()
    everywhere[:] = take()
    if controller is None or controller.GetNumberOfProcesses() == 1:
        return
    mine, all_of_them = vtkUnsignedCharArray(), vtkUnsignedCharArray()
    for byte in "".join(line + "\n" for line in everywhere).encode(errors="replace"):
        mine.InsertNextValue(byte)
    controller.AllGatherV(mine, all_of_them)
    text = bytes(all_of_them.GetValue(i) for i in range(all_of_them.GetNumberOfValues()))
    everywhere[:] = text.decode(errors="replace").splitlines()


def reason_of(text):
    """'ERROR: In file.cxx, line 3\\nvtkFoo (0x1234): reason' without what only a developer wants."""
    text = text.split("\n", 1)[1] if text.startswith(("ERROR: In ", "Warning: In ")) and "\n" in text else text
    head, separator, tail = text.partition("): ")
    if separator and head.startswith("vtk") and " (0x" in head and "\n" not in head:
        text = tail
    text = " ".join(text.split())
    for wording, ours in WORDINGS:
        text = re.sub(wording, ours, text)
    return text
