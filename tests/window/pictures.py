"""Makes the pictures of docs/window.md in the real ParaView window.

usage: pictures.py PLUGIN DATA FOLDER, for example
       /usr/bin/python3 tests/window/pictures.py build/release/lib/cadrefine/CADRefine/CADRefine.so data docs/images
"""

import os
import sys
import tempfile

from PIL import Image

from test_client_server import write
from test_faces import HELPERS, MIDDLE, add_to, look_at, select, show_alone
from test_ready_view import SHOW
from test_window import APPLY, PANEL, choose_from_menu, open_file
from window import Window, event, python

SIZE = (1000, 660)
TIMEOUT = 150


def look_from(x, y, z, zoom=1):
    """A view of everything from this direction."""
    return [python("from paraview import simple; view = simple.GetActiveView()"),
            python(f"view.CameraPosition = ({x}, {y}, {z}); view.CameraFocalPoint = (0, 0, 0)"),
            python("view.CameraViewUp = (0, 1, 0); view.ResetCamera()"),
            python(f"simple.GetActiveCamera().Dolly({zoom}); simple.Render()")]


def play_cad(window, data):
    window.play(*open_file(os.path.join(data, "aeroplane.igs")), APPLY, *look_from(-3, 3, 3, 1.3))
    window.picture("window_cad")


def play_region(window, data):
    window.play(python("simple.ResetSession()"), *open_file(os.path.join(data, "cylinder.brep")), APPLY,
                *open_file(os.path.join(data, "cylinder_coarse.vtu")), APPLY,
                *choose_from_menu("ProjectOntoCAD"),
                event(PANEL + "UseRegion/CheckBox", "set_boolean", "true"),
                event(PANEL + "CADRegion/Bound3", "set_string", "0.2"),
                python("simple.Hide(simple.FindSource('cylinder.brep'))"), *look_from(-2, 1.5, 3))
    window.picture("window_region")


def play_error(window):
    window.play(event(PANEL + "UseRegion/CheckBox", "set_boolean", "false"), APPLY,
                *choose_from_menu("RefineWithCAD"),
                event(PANEL + "Levels/IntRangeWidget/LineEdit", "set_string", "2"), APPLY,
                *choose_from_menu("CADGeometricError"), APPLY, *look_from(-2, 1.5, 3))
    window.picture("window_error")


def play_faces(window, data):
    """In a window whose Python has the helpers of test_faces."""
    window.play(python(f"exec(open({write(window.path('helpers.py'), HELPERS)!r}).read(), globals())"),
                python("simple.ResetSession()"), *open_file(os.path.join(data, "cylinder.brep")), APPLY,
                *open_file(os.path.join(data, "cylinder_coarse.vtu")), APPLY, *choose_from_menu("ProjectOntoCAD"),
                show_alone("cylinder.brep"), *look_at((0, 0, 2)), *select(*MIDDLE), *add_to("ProjectOntoCAD1"))
    window.picture("window_faces")


def play_facets(window, data):
    window.play(python("simple.ResetSession()"), *open_file(os.path.join(data, "aeroplane.igs")), APPLY,
                *open_file(os.path.join(data, "aeroplane_coarse.vtu")), APPLY, *choose_from_menu("ProjectOntoCAD"),
                APPLY, *choose_from_menu("CADGeometricError"), APPLY, SHOW)
    window.picture("window_facets")


def main():
    plugin, data, folder = map(os.path.abspath, sys.argv[1:])
    with tempfile.TemporaryDirectory() as output:
        window = Window(plugin, output, SIZE)
        play_cad(window, data)
        play_region(window, data)
        play_error(window)
        play_faces(window, data)
        play_facets(window, data)
        window.run_well(TIMEOUT)
        for name in ("window_cad", "window_region", "window_error", "window_faces", "window_facets"):
            picture = Image.open(window.path(name + ".png")).convert("RGB")
            target = os.path.join(folder, name + ".png")
            picture.save(target, optimize=True)
            print(f"{target}: {os.path.getsize(target)} bytes")


if __name__ == "__main__":
    main()
