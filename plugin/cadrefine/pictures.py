"""Pictures of a mesh: what lies on the CAD, coloured by its distance from it, at the start and at the end of a run.

The facets are gathered on rank 0, which draws them alone. (Drawing on all ranks would want a display on each of them,
and ParaView 5.11 was seen to hang there when a rank has nothing to draw.)
"""

from cadrefine import drawing, facets, session, views


class Pictures:
    """Both are drawn at the end, when all colours are known, from one side and on one scale."""

    def __init__(self, options):
        self.options = options
        self.places = options.screenshot_start, options.screenshot
        self.first = None  # Facets at the start.

    def begin(self, pipeline):
        """Keeps the mesh at the start, once it is projected."""
        if self.first is None and any(self.places):
            self.first = facets.gather(pipeline.mesh, pipeline.cad, quadratic=False)

    def draw(self, pipeline, results):
        if not any(self.places):
            return
        last = facets.gather(pipeline.mesh, pipeline.cad, self.options.quadratic)
        paths = [place and results.path(place) for place in self.places]
        if session.speaks():
            draw_both(self.first, last, title("".join(pipeline.cad_values().get("CADUnit", ""))), self.options, paths)
        for place in filter(None, self.places):
            session.raise_errors(place)


def title(unit):
    return "distance\nfrom CAD" + (f", {unit}" if unit else "")


def draw_both(first, last, text, options, paths):
    """The mesh at the start tells which CAD faces both show, and from where."""
    scene = views.Scene(first, last, options.focus, options.view)
    values = [scene.values(each) for each in (first, last)]
    colours, camera = drawing.Colours(*values), drawing.Camera(scene.view, scene.points)
    for each, its_values, path in zip((first, last), values, paths):
        if path:
            shown = scene.shows(each)
            drawing.draw(drawing.cells_of(each.grid, shown), its_values[shown], camera, colours, text, path)
