"""What a signal does that ends the run. Every rank has this module; the plugin does the work, as it must not wait for
Python."""

import ctypes

from vtkmodules.vtkParallelCore import vtkMultiProcessController


def follow(plugin, line, failure, actions, unfinished):
    """What the next signal does on this rank, see EndOnSignal.h. All ranks do so together, and have done so then."""
    controller = vtkMultiProcessController.GetGlobalController()
    speaks = controller is None or controller.GetLocalProcessId() == 0
    told = line if actions or speaks else b""  # Without an action that the ranks share all of them would speak.
    ctypes.CDLL(plugin).cadrefineEndOnSignal(told, failure, strings(actions), strings(unfinished))
    if controller is not None:
        controller.Barrier()


def strings(texts):
    return (ctypes.c_char_p * (len(texts) + 1))(*texts)
