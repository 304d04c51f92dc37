"""Draws the pressure beside the wing and the mesh: xvfb-run -a pvpython picture.py FLOW.vtu FILE.png"""

import sys

from paraview.simple import *

SIZE = (720, 400)
CENTRE = (1.4, 0.75, 0.0)  # Between the ends of the wing.
HALF_HEIGHT = 1.0
RANGE = (-0.4, 0.4)  # Of the pressure; in an unbounded flow it is 0.5 in the stagnation point.


def section_of(flow):
    """The plane in the middle of the span, with the outlines of the tetrahedra that it cuts."""
    section = Slice(Input=flow, SliceType="Plane")
    section.SliceType.Origin = CENTRE
    section.SliceType.Normal = (0.0, 1.0, 0.0)
    section.Triangulatetheslice = 0
    return section


def main():
    flow, picture = sys.argv[1:]
    view = CreateView("RenderView")
    view.ViewSize = SIZE
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = (1.0, 1.0, 1.0)
    display = Show(section_of(OpenDataFile(flow)), view)
    display.SetRepresentationType("Surface With Edges")
    display.EdgeColor = (0.45, 0.45, 0.45)
    display.LineWidth = 0.5
    display.Ambient, display.Diffuse = 1.0, 0.0
    ColorBy(display, ("POINTS", "pressure"))
    colours = GetColorTransferFunction("pressure")
    colours.RescaleTransferFunction(*RANGE)
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = "pressure", ""
    bar.TitleColor = bar.LabelColor = (0.0, 0.0, 0.0)
    display.SetScalarBarVisibility(view, True)
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = CENTRE
    view.CameraPosition = (CENTRE[0], CENTRE[1] - 10.0, CENTRE[2])
    view.CameraViewUp = (0.0, 0.0, 1.0)
    view.CameraParallelScale = HALF_HEIGHT
    SaveScreenshot(picture, view, ImageResolution=SIZE)


if __name__ == "__main__":
    main()
