"""The facets of the CAD that carry error, shown in ParaView's window as the driver's pictures show them (see views): cut
free of the far field, coloured by their distance from the CAD, from the side that shows most of it. What is made is an
ordinary CAD Boundary with its Faces, and an ordinary view.

Runs in the Python of the window, which is the client of a server perhaps: the facets are fetched to be looked at.
"""

import math

import numpy as np
from paraview import servermanager, simple
from vtkmodules.vtkFiltersCore import vtkAppendFilter

from cadrefine import drawing, facets, views
from cadrefine.merge import merged_grid

ARRAY = "GeometricDistance"
MANY = 5000  # Facets whose edges would hide their colours.


def show():
    """Of the active mesh. Where that is a CAD Boundary: of the mesh below it, and its faces are chosen anew."""
    active = simple.GetActiveSource()
    active = getattr(active, "Proxy", active)  # The active one may be an output, of the mesh or of the chart.
    if facets.is_flat(active):
        shown, seen = active, facets_of(facets.of_dimension(2, fetched(active)), active)
    else:
        shown = active if active.GetXMLName() == "CADBoundary" else simple.CADBoundary(Input=active)
        shown.Faces = []
        seen = facets_of(fetched(shown), active)
    if seen:
        scene = views.Scene(seen, seen, None, None)
        if not seen.flat:
            shown.Faces = entries(seen, scene)
        view = render_view()
        draw(shown, int(scene.shows(seen).sum()), view)
        look(scene, view)
        simple.SetActiveSource(shown)


def fetched(source):
    """The output of all ranks as one grid, as blocks on the way: of a grid on several ranks ParaView 5.11 fetches one
    piece alone."""
    group = servermanager.filters.GroupDatasets(Input=source)
    group.UpdatePipeline()
    append, iterator = vtkAppendFilter(), servermanager.Fetch(group).NewIterator()
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        append.AddInputData(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    append.Update()
    return append.GetOutput()


def facets_of(data, mesh):
    """None where there are none, as where a filter has failed, which it says itself."""
    if not data.GetNumberOfCells():
        return None
    entity = data.GetCellData().GetArray("CADEntity") or data.GetPointData().GetArray("CADEntity")
    volumes = mesh.FieldData["MeshDimension"].GetRange(0)[0] == 3
    return facets.Facets(merged_grid(data), int(entity.GetRange()[1]) + 1, facets.is_flat(mesh), False, volumes)


def entries(seen, scene):
    """Of Faces: those that are shown, or those that are not with "!", whichever are fewer; none: all facets, also those
    off the CAD."""
    shown, hidden = (np.flatnonzero(seen.meets() & chosen) for chosen in (scene.faces, ~scene.faces))
    if scene.shows(seen).all():
        return []
    if not len(hidden):
        return ["*"]
    return [f"!{face}" for face in hidden] if len(hidden) < len(shown) else [str(face) for face in shown]


def render_view():
    """The active view may be the chart of Adapt To CAD."""
    found = [view for view in (simple.GetActiveView(), *simple.GetRenderViews()) if is_render_view(view)]
    view = found[0] if found else simple.CreateRenderView()
    simple.SetActiveView(view)
    return view


def is_render_view(view):
    return view is not None and view.SMProxy.IsA("vtkSMRenderViewProxy")


def draw(source, count, view):
    """Alone, on a scale of its own, which pqColourScales fits to it: another mesh's errors would set the colours."""
    simple.HideAll(view)
    display = simple.Show(source, view)
    display.SetRepresentationType("Surface With Edges" if count < MANY else "Surface")
    display.EdgeColor = [value / 255 for value in drawing.EDGE_COLOUR]
    if list(display.ColorArrayName) != ["CELLS", ARRAY] or not display.UseSeparateColorMap:  # Else it is shown again.
        simple.ColorBy(display, ("CELLS", ARRAY), separate=True)
        places = np.linspace(0, 1, len(drawing.COLOURS))
        display.LookupTable.RGBPoints = np.column_stack([places, drawing.COLOURS]).ravel().tolist()
    display.SetScalarBarVisibility(view, True)


def look(scene, view):
    """From the scene's side, from so near that all of it just fits."""
    lower, upper = scene.points.min(axis=0), scene.points.max(axis=0)
    centre, (direction, right, up) = (lower + upper) / 2, drawing.axes(scene.view)
    width, height = view.ViewSize
    across, upwards, depth = (np.abs((scene.points - centre) @ right) * height / width,
                              np.abs((scene.points - centre) @ up), (scene.points - centre) @ direction)
    half = np.maximum(across, upwards) * (1 + drawing.MARGIN)
    distance = (half / math.tan(math.radians(view.CameraViewAngle) / 2) + depth).max()
    view.CameraFocalPoint, view.CameraViewUp = centre.tolist(), up.tolist()
    view.CameraPosition = (centre + distance * direction).tolist()
    view.CameraParallelScale = half.max()
    view.StillRender()  # simple.Render would reset the camera, the first time.
