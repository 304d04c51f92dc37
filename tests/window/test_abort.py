"""The abort button of the real ParaView window stops Adapt To CAD: the mouse is moved there and pressed while the filter
is at work. It keeps its last whole step. The plugin is loaded later, as Tools > Manage Plugins does.

usage: test_abort.py PLUGIN DATA OUTPUT
"""

import ctypes
import json
import os
import sys
import time

import numpy as np

from test_window import APPLY, PANEL, choose_from_menu, open_file
from window import Picture, Window, check, event, python

TIMEOUT = 150
STATUS_BAR = 30  # Height at most.


class Mouse:
    """That of a display, by the X Test extension."""

    def __init__(self, display):
        self.x11, self.test = ctypes.CDLL("libX11.so.6"), ctypes.CDLL("libXtst.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.display = ctypes.c_void_p(self.x11.XOpenDisplay(display.name.encode()))

    def click(self, x, y):
        self.test.XTestFakeMotionEvent(self.display, -1, x, y, 0)
        for pressed in (1, 0):
            self.test.XTestFakeButtonEvent(self.display, 1, pressed, 0)
        self.x11.XFlush(self.display)


def enabled_button(dump):
    """The middle of the red cross in the status bar, which is grey where the button is disabled; None without."""
    with open(dump, "rb") as file:
        picture = Picture(file.read())
    bar = picture.pixels[-STATUS_BAR:]
    y, x = np.nonzero((bar[:, :, 0] > 180) & (bar[:, :, 1:] < 90).all(axis=2))
    return (int(x.mean()), len(picture.pixels) - STATUS_BAR + int(y.mean())) if len(x) else None


def press_abort(window, display):
    mouse, dump = Mouse(display), window.path("display", "Xvfb_screen0")
    while (place := enabled_button(dump)) is None:
        time.sleep(0.1)
    time.sleep(5)  # For some steps: the chart of one alone cannot be drawn.
    window.clicked_at = place
    mouse.click(*place)


def main():
    plugin, data, output = map(os.path.abspath, sys.argv[1:])
    window = Window(None, output)
    window.clicked_at = None
    result = window.path("output", "steps.json")
    window.play(python("from paraview import simple"), python(f"simple.LoadPlugin({plugin!r}, remote=False)"),
                check("CAD Refinement/1QToolButton0", "visible", "true"),
                *open_file(os.path.join(data, "cylinder.brep")), APPLY,
                *open_file(os.path.join(data, "cylinder_coarse.vtu")), APPLY, *choose_from_menu("AdaptToCAD"),
                event(PANEL + "MaximumSteps/LineEdit0", "set_string", "100"), APPLY)
    window.picture("aborted")
    window.play(python("import json; from paraview import servermanager"),
                python("table = servermanager.Fetch(simple.FindSource('AdaptToCAD1'), idx=1)"),
                python("reason = table.GetFieldData().GetAbstractArray('StopReason').GetValue(0)"),
                python(f"json.dump([table.GetNumberOfRows() - 1, reason], open({result!r}, 'w'))"))
    window.meanwhile = press_abort
    window.run_well(TIMEOUT)
    with open(result, encoding="utf-8") as file:
        steps, reason = json.load(file)
    assert reason == "interrupted", f"stopped after step {steps}: {reason}; clicked at {window.clicked_at}"
    assert 0 < steps < 100, steps
    print(f"stopped after step {steps}; pictures are in {output}")


if __name__ == "__main__":
    main()
