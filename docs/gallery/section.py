"""Draws the cells of a mesh on a plane wall: pvpython section.py MESH FILE.png X Y Z X0 X1 Z0 Z1

X Y Z is the direction from the mesh to the eye, along an axis; the picture shows X0 to X1 and Z0 to Z1 of the wall.
Cells are coloured by how good they are.
"""

import sys

from paraview.simple import *

SIZE = (1400, 1000)


def picture_of(mesh):
    view = CreateView("RenderView")
    view.ViewSize = SIZE
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = (1.0, 1.0, 1.0)
    display = Show(mesh, view)
    display.SetRepresentationType("Surface With Edges")
    display.DiffuseColor = display.AmbientColor = (0.80, 0.88, 0.96)
    display.EdgeColor = (0.15, 0.15, 0.15)
    display.LineWidth = 1.5
    display.Ambient, display.Diffuse = 1.0, 0.0
    display.ColorArrayName = (None, "")
    return view


def look_from(view, direction, left, right, low, high):
    middle = ((left + right) / 2, 0.0, (low + high) / 2)
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = middle
    view.CameraPosition = [m + 10 * d for m, d in zip(middle, direction)]
    view.CameraViewUp = (0.0, 0.0, 1.0)
    view.CameraParallelScale = max((high - low) / 2, (right - left) / 2 * SIZE[1] / SIZE[0])


def main():
    mesh, picture = sys.argv[1:3]
    numbers = [float(word) for word in sys.argv[3:]]
    view = picture_of(OpenDataFile(mesh))
    look_from(view, numbers[:3], *numbers[3:])
    SaveScreenshot(picture, view, ImageResolution=SIZE)


if __name__ == "__main__":
    main()
