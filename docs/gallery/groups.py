"""Draws the triangles of a mesh, coloured by their tags: pvpython groups.py MESH ARRAY FILE.png X Y Z TAG=NAME ...

X Y Z is the direction from the mesh to the eye.
"""

import sys

from paraview.simple import *

SIZE = (1400, 900)
ZOOM = 1.45
COLOURS = ((0.45, 0.68, 0.90), (0.99, 0.70, 0.35), (0.50, 0.80, 0.45), (0.88, 0.88, 0.88))


def picture_of(triangles, array, names):
    view = CreateView("RenderView")
    view.ViewSize = SIZE
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = (1.0, 1.0, 1.0)
    display = Show(triangles, view)
    display.SetRepresentationType("Surface With Edges")
    display.EdgeColor = (0.15, 0.15, 0.15)
    display.LineWidth = 1.5
    display.Ambient, display.Diffuse = 0.6, 0.4
    ColorBy(display, ("CELLS", array))
    colours = GetColorTransferFunction(array)
    colours.InterpretValuesAsCategories = 1
    colours.Annotations = [text for name in names for text in name.split("=")]
    colours.IndexedColors = [part for index, _ in enumerate(names) for part in COLOURS[index % len(COLOURS)]]
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = array, ""
    bar.TitleColor = bar.LabelColor = (0.0, 0.0, 0.0)
    bar.TitleFontSize = bar.LabelFontSize = 26
    bar.WindowLocation = "Lower Right Corner"
    display.SetScalarBarVisibility(view, True)
    return view


def look_from(view, direction):
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = (0.0, 0.0, 0.0)
    view.CameraPosition = direction
    view.CameraViewUp = (0.0, 0.0, 1.0)
    ResetCamera(view)
    view.CameraParallelScale /= ZOOM


def main():
    mesh, array, picture = sys.argv[1:4]
    triangles = ExtractCellsByType(Input=OpenDataFile(mesh), CellTypes=["Triangle"])
    view = picture_of(triangles, array, sys.argv[7:])
    look_from(view, [float(word) for word in sys.argv[4:7]])
    SaveScreenshot(picture, view, ImageResolution=SIZE)


if __name__ == "__main__":
    main()
