"""Draws the triangles of a mesh, coloured by their tags: pvpython groups.py MESH ARRAY FILE.png X Y Z

X Y Z is the direction from the mesh to the eye.
"""

import sys

from paraview.simple import *

SIZE = (1400, 900)
TRIANGLE = "Triangle"
COLOURS = ((0.55, 0.75, 0.90), (0.99, 0.75, 0.44), (0.60, 0.82, 0.55), (0.85, 0.85, 0.85))


def main():
    mesh, array, picture = sys.argv[1:4]
    view = CreateView("RenderView")
    view.ViewSize = SIZE
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = (1.0, 1.0, 1.0)
    triangles = ExtractCellsByType(Input=OpenDataFile(mesh), CellTypes=[TRIANGLE])
    triangles.UpdatePipeline()
    display = Show(triangles, view)
    display.SetRepresentationType("Surface With Edges")
    display.EdgeColor = (0.15, 0.15, 0.15)
    display.LineWidth = 1.5
    display.Ambient, display.Diffuse = 0.6, 0.4
    ColorBy(display, ("CELLS", array))
    colours = GetColorTransferFunction(array)
    colours.InterpretValuesAsCategories = 1
    first, last = triangles.CellData[array].GetRange()
    tags = range(int(first), int(last) + 1)
    colours.Annotations = [text for tag in tags for text in (str(tag), str(tag))]
    colours.IndexedColors = [part for index, _ in enumerate(tags) for part in COLOURS[index % len(COLOURS)]]
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = (0.0, 0.0, 0.0)
    view.CameraPosition = [float(word) for word in sys.argv[4:7]]
    view.CameraViewUp = (0.0, 0.0, 1.0)
    ResetCamera(view)
    SaveScreenshot(picture, view, ImageResolution=SIZE)


if __name__ == "__main__":
    main()
