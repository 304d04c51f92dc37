"""What the driver needs of ParaView as a whole: ranks, the plugin, and errors that end every rank with one line."""

import glob
import os
import sys
import traceback

from paraview import simple
from paraview.modules.vtkRemotingCore import vtkProcessModule
from vtkmodules.util.misc import calldata_type
from vtkmodules.vtkCommonCore import vtkOutputWindow

PLUGIN = "CADRefine.so"

# Runs on every rank: errors are collected and told once, not printed by each rank; signals end the process.
SILENCE = """
import signal
from vtkmodules.vtkCommonCore import vtkLogger
vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
for ending in (signal.SIGINT, signal.SIGTERM):
    signal.signal(ending, signal.SIG_DFL)
"""

# Runs on every rank: makes its exit status 1 once it has left MPI and returned from main. (sys.exit would end rank 0
# inside MPI, whereupon mpirun kills the others; and these, which run no script, would return 0 of their own.)
EXIT_WITH_1 = """
import ctypes
libc = ctypes.CDLL(None)
libc.__cxa_atexit(ctypes.cast(libc._exit, ctypes.c_void_p), ctypes.c_void_p(1), None)
"""

# Runs on every rank: what ends it on a signal is in the plugin, since it must not wait for Python.
ON_SIGNALS = """
import ctypes
from vtkmodules.vtkParallelCore import vtkMultiProcessController
controller = vtkMultiProcessController.GetGlobalController()
first = controller is None or controller.GetLocalProcessId() == 0
plugin = ctypes.CDLL({plugin!r})
plugin.cadrefineEndOnSignal({line!r} if first else b"")
for path in {paths!r}:
    plugin.cadrefineRemoveOnSignal(path)
"""
NOTHING_ON_SIGNALS = """
import ctypes
ctypes.CDLL({plugin!r}).cadrefineRemoveNothingOnSignal()
"""
INTERRUPTED = b"cadrefine: interrupted, nothing was written\n"


# The filters whose warnings are for the user. (What the CAD Reader warns of is in its field data.)
WARNING = ("vtkProjectOntoCAD", "vtkCADGeometricError", "vtkRefineWithCAD", "vtkMeshValidity")


class Failure(Exception):
    """Bad input: one line that names the file and the reason."""


class Messages:
    """What VTK said on this rank: errors since they were last taken, and warnings of the filters, each once."""

    def __init__(self):
        self.errors = []
        self.warnings = []

    def observe(self):
        @calldata_type("string0")
        def collect(_window, _event, text):
            self.errors.append(text)

        @calldata_type("string0")
        def collect_warning(_window, _event, text):
            if any(f"\n{name} (" in text for name in WARNING) and reason_of(text) not in self.warnings:
                self.warnings.append(reason_of(text))

        vtkOutputWindow.GetInstance().AddObserver("ErrorEvent", collect)
        vtkOutputWindow.GetInstance().AddObserver("WarningEvent", collect_warning)

    def take(self):
        errors, self.errors = [reason_of(text) for text in self.errors if text.strip()], []
        return [error for error in errors if "returned failure for request" not in error] or errors


messages = Messages()


def reason_of(text):
    """'ERROR: In file.cxx, line 3\\nvtkFoo (0x1234): reason' without what only a developer wants."""
    text = text.split("\n", 1)[1] if text.startswith(("ERROR: In ", "Warning: In ")) and "\n" in text else text
    head, separator, tail = text.partition("): ")
    if separator and head.startswith("vtk") and " (0x" in head and "\n" not in head:
        text = tail
    return " ".join(text.split())


def ranks():
    return vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions()


def speaks():
    """True on the rank that prints and writes (with --symmetric every rank runs the script)."""
    return vtkProcessModule.GetProcessModule().GetPartitionId() <= 0


def run_on_all_ranks(script):
    source = simple.ProgrammableSource(Script=script, OutputDataSetType="vtkPolyData")
    source.UpdatePipeline()
    simple.Delete(source)


def start():
    run_on_all_ranks(SILENCE)
    messages.observe()


def update(proxy, path):
    """Brings `proxy` up to date; where that fails, the file `path` is to blame."""
    messages.take()
    try:
        proxy.UpdatePipeline()
    except RuntimeError as error:
        messages.errors.append(str(error))
    raise_errors(path)


def raise_errors(path):
    errors = messages.take()
    if errors:
        raise Failure(errors[0] if path in errors[0] else f"{path}: {errors[0]}")


def fail(reason):
    """Prints the line; every rank will end with exit status 1 when the script returns, which it must do next."""
    sys.stdout.flush()
    if speaks():
        line = "cadrefine: " + " ".join(reason.split()) + "\n"
        os.write(2, line.encode(errors="replace"))
    run_on_all_ranks(EXIT_WITH_1)


def fail_with_traceback():
    if speaks():
        os.write(2, traceback.format_exc().encode(errors="replace"))
    fail("internal error, see above")


def check_readable(path):
    if not os.path.exists(path):
        raise Failure(f"{path}: no such file")
    if os.path.isdir(path):
        raise Failure(f"{path}: is a folder, not a file")
    if not os.access(path, os.R_OK):
        raise Failure(f"{path}: may not be read")
    if os.path.getsize(path) == 0:
        raise Failure(f"{path}: the file is empty")


def check_writable(path, endings):
    if not path.endswith(endings):
        raise Failure(f"{path}: the name must end in {', '.join(endings)}")
    folder = os.path.dirname(os.path.abspath(path))
    if not os.path.isdir(folder):
        raise Failure(f"{path}: there is no folder {folder}")
    if os.path.isdir(path) or not all(os.access(item, os.W_OK) for item in (path, folder) if os.path.exists(item)):
        raise Failure(f"{path}: may not be written")


def plugin_candidates():
    """Where the plugin may be, the likeliest place first."""
    if os.environ.get("CADREFINE_PLUGIN"):
        return [os.environ["CADREFINE_PLUGIN"]]
    here = os.path.dirname(os.path.abspath(__file__))
    built = glob.glob(os.path.join(here, "..", "build", "**", PLUGIN), recursive=True)
    built.sort(key=os.path.getmtime, reverse=True)
    release = [path for path in built if f"{os.sep}build{os.sep}release{os.sep}" in path]
    folders = os.environ.get("PV_PLUGIN_PATH", "").split(os.pathsep)
    for prefix in (os.path.join(here, ".."), "/usr/local", "/usr"):
        folders += glob.glob(os.path.join(prefix, "lib*", "**", "paraview-*"), recursive=False)
        folders += glob.glob(os.path.join(prefix, "lib", "*", "paraview-*"))
    installed = []
    for folder in filter(None, folders):
        for inside in ("", "CADRefine", "plugins", os.path.join("plugins", "CADRefine")):
            installed.append(os.path.join(folder, inside, PLUGIN))
    return [os.path.join(here, PLUGIN)] + release + built + installed


loaded_plugin = ""


def remove_on_signal(paths):
    """A signal that ends a rank removes these files, and folders that come before what is in them."""
    run_on_all_ranks(ON_SIGNALS.format(plugin=loaded_plugin, line=INTERRUPTED,
                                       paths=[os.fsencode(os.path.abspath(path)) for path in paths]))


def remove_nothing_on_signal():
    """Takes back what remove_on_signal did."""
    run_on_all_ranks(NOTHING_ON_SIGNALS.format(plugin=loaded_plugin))


def load_plugin():
    """Loads the plugin on every rank. From then on, signals end all ranks cleanly."""
    global loaded_plugin
    found = [path for path in plugin_candidates() if os.path.isfile(path)]
    if not found:
        raise Failure(f"{PLUGIN}: not found; build it (make build) or name it in CADREFINE_PLUGIN")
    path = os.path.realpath(found[0])
    try:
        simple.LoadPlugin(path, remote=True, ns=vars(simple))
    except RuntimeError as error:
        messages.errors.append(str(error))
    raise_errors(path)
    if not hasattr(simple, "CADReader"):
        raise Failure(f"{path}: is not the CADRefine plugin")
    loaded_plugin = path
    remove_on_signal([])
