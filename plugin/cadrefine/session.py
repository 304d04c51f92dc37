"""What the driver needs of ParaView as a whole: ranks, the plugin, and errors that end every rank with one line."""

import glob
import os
import traceback

from paraview import simple
from paraview.modules.vtkRemotingCore import vtkProcessModule

from cadrefine import messages
from cadrefine.messages import flush
from cadrefine.parts import polymesh_of

PLUGIN = "CADRefine.so"
HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))  # Where the package and the command are.

# Runs on every rank, in the process of the driver on rank 0: errors are collected; signals end the process.
START = """
import signal, sys
if {folder!r} not in sys.path:
    sys.path.insert(0, {folder!r})
from cadrefine import messages
messages.observe()
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

# Runs on every rank.
ON_SIGNAL = """
from cadrefine import signals
signals.follow{arguments!r}
"""
NOTHING_WRITTEN = "ended by a signal, nothing was written"


class Failure(Exception):
    """Bad input: one line that names the file and the reason."""


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
    run_on_all_ranks(START.format(folder=HERE))


def update(proxy, path):
    """Brings `proxy` up to date; where that fails, the file `path` is to blame. Our filters tell on rank 0 what fails
    on any."""
    messages.take()
    update_pipeline(proxy)
    raise_errors(path)


def update_reader(proxy, path):
    """The same for ParaView's readers, which tell errors on the rank where they are, some before the update."""
    update_pipeline(proxy)
    run_on_all_ranks("from cadrefine import messages\nmessages.share()")
    raise_first(messages.everywhere, path)


def update_pipeline(proxy):
    try:
        proxy.UpdatePipeline()
    except RuntimeError as error:
        messages.errors.append(str(error))


def raise_errors(path):
    raise_first(messages.take(), path)


def raise_first(errors, path):
    if errors:
        raise Failure(errors[0] if path in errors[0] else f"{path}: {errors[0]}")


def fail(reason):
    """Prints the line; every rank will end with exit status 1 when the script returns, which it must do next."""
    flush()
    if speaks():
        os.write(2, line_of(reason))
    run_on_all_ranks(EXIT_WITH_1)


def line_of(reason):
    return ("cadrefine: " + " ".join(reason.split()) + "\n").encode(errors="replace")


def fail_with_traceback():
    if speaks():
        os.write(2, traceback.format_exc().encode(errors="replace"))
    fail("internal error, see above")


def check_readable(path):
    if not os.path.exists(path):
        raise Failure(f"{path}: no such file")
    if os.path.isdir(path) and not polymesh_of(path):
        raise Failure(f"{path}: is a folder, not a file, and contains no constant/polyMesh")
    if not os.access(path, os.R_OK):
        raise Failure(f"{path}: cannot be read: permission denied")
    if os.path.getsize(path) == 0 and not path.endswith(".foam"):
        raise Failure(f"{path}: the file is empty")


def check_writable(path, endings):
    if not path.endswith(endings):
        raise Failure(f"{path}: the name must end in {', '.join(endings)}")
    folder = os.path.dirname(os.path.abspath(path))
    if not os.path.isdir(folder):
        raise Failure(f"{path}: there is no folder {folder}")
    if os.path.isdir(path) or not all(os.access(item, os.W_OK) for item in (path, folder) if os.path.exists(item)):
        raise Failure(f"{path}: cannot be written")


def plugin_candidates():
    """Where the plugin may be, the likeliest place first."""
    if os.environ.get("CADREFINE_PLUGIN"):
        return [os.environ["CADREFINE_PLUGIN"]]
    built = glob.glob(os.path.join(HERE, "..", "build", "**", PLUGIN), recursive=True)
    built.sort(key=os.path.getmtime, reverse=True)
    release = [path for path in built if f"{os.sep}build{os.sep}release{os.sep}" in path]
    folders = os.environ.get("PV_PLUGIN_PATH", "").split(os.pathsep)
    for prefix in (os.path.join(HERE, ".."), "/usr/local", "/usr"):
        folders += glob.glob(os.path.join(prefix, "lib*", "cadrefine"))
    installed = []
    for folder in filter(None, folders):
        for inside in ("", "CADRefine", "plugins", os.path.join("plugins", "CADRefine")):
            installed.append(os.path.join(folder, inside, PLUGIN))
    return [os.path.join(HERE, PLUGIN)] + release + built + installed


loaded_plugin = ""


def on_signal(line=NOTHING_WRITTEN, failure="", actions=(), unfinished=()):
    """What a signal that ends the run does from now on: `actions` are pairs of paths, see EndOnSignal.h."""
    paths = [path and os.path.abspath(path) for pair in actions for path in pair]
    run_on_all_ranks(ON_SIGNAL.format(arguments=(
        loaded_plugin, line_of(line), line_of(failure), [os.fsencode(path) for path in paths],
        [os.fsencode(os.path.abspath(path)) for path in unfinished])))


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
    on_signal()
