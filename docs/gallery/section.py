"""Draws meshes where they end in a plane wall: pvpython section.py X Y Z X0 X1 Z0 Z1 MESH=FILE.png ...

X Y Z is the direction from the mesh to the eye, along y; the pictures show X0 to X1 and Z0 to Z1.
"""

import sys

from paraview.simple import *

SIZE = (1400, 1000)


def draw(mesh, picture, direction, left, right, low, high):
    view = CreateView("RenderView")
    view.ViewSize = SIZE
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = (1.0, 1.0, 1.0)
    display = Show(OpenDataFile(mesh), view)
    display.SetRepresentationType("Surface With Edges")
    display.ColorArrayName = (None, "")
    display.DiffuseColor = display.AmbientColor = (0.80, 0.88, 0.96)
    display.EdgeColor = (0.15, 0.15, 0.15)
    display.LineWidth = 1.5
    display.Ambient, display.Diffuse = 1.0, 0.0
    middle = ((left + right) / 2, 0.0, (low + high) / 2)
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = middle
    view.CameraPosition = [place + 10 * part for place, part in zip(middle, direction)]
    view.CameraViewUp = (0.0, 0.0, 1.0)
    view.CameraParallelScale = max((high - low) / 2, (right - left) / 2 * SIZE[1] / SIZE[0])
    SaveScreenshot(picture, view, ImageResolution=SIZE)


def main():
    numbers = [float(word) for word in sys.argv[1:8]]
    for pair in sys.argv[8:]:
        draw(*pair.split("="), numbers[:3], *numbers[3:])


if __name__ == "__main__":
    main()
