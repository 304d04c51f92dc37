"""What a picture of a mesh shows: the parts of the CAD that carry error, from the side that shows most of it."""

import itertools

import numpy as np

NEGLIGIBLE = 1e-6  # Distance from the CAD, in parts of a face's size: what is closer is flat.
FAR = 8.0  # How many times as large as all that it surrounds a far field is at least.
AROUND = 0.5  # How far flat faces may reach beyond the curved ones, in parts of their size.
DEFAULT_VIEW = (-0.6, -0.64, 0.48)  # From ahead, the side and above.
WORTH_TURNING = 1.2  # How many times as much another side must show.
PLANE = 1e-5  # Thickness of a face, in parts of its size, up to which it is plane.
IN_PLANE = (0.0, 0.0, 1.0)


class Scene:
    """What pictures show of a mesh at the start and at the end, whose facets these are. `focus`: a box to be seen,
    `view`: the direction to the eye; None: the best ones."""

    def __init__(self, first, last, focus, view):
        self.curved = (carriers(first) | carriers(last)) & ~plane_faces(first) & ~plane_faces(last)
        # Facets that are coarse have few of the faces that they span.
        self.faces = shown_faces(last, self.curved & last.meets()) | (self.curved & ~last.meets())
        if focus and not first.inside(focus)[first.points_of(self.shows(first))].any():
            self.faces[:] = True  # The far field, for example.
        self.view = view or default_view(first, self.shows(first))
        self.points = box_corners(focus) if focus else points_in_view(first, self.shows(first))

    def shows(self, facets):
        """Which facets are drawn, as a mask: all of a mesh in the plane, or where none is on the CAD."""
        on_faces = facets.on(self.faces)
        return on_faces if on_faces.any() and not facets.flat else np.ones(facets.count, dtype=bool)

    def values(self, facets):
        """The distance of each facet from the CAD; NaN where it is flat."""
        if facets.flat:
            curved = facets.distance > NEGLIGIBLE * size((facets.points.min(axis=0), facets.points.max(axis=0)))
        else:
            curved = facets.on(self.curved & self.faces)
        return np.where(curved, facets.distance, np.nan)


def limits(facets):
    """The distances from which on the facets of CAD faces carry error."""
    return NEGLIGIBLE * size(facets.boxes())


def carriers(facets):
    """The CAD faces with a facet that carries error, as a mask."""
    return facets.meets() & (facets.distances()[1] > limits(facets))


def plane_faces(facets):
    """The CAD faces that are plane, though facets may seem to carry error, as a mask: what is known of a facet is that
    of its cell, which may have others on curved faces. Facets in a plane of which some are on the CAD all are."""
    in_plane = facets.thickness() < PLANE * size(facets.boxes())
    return facets.meets() & in_plane & (facets.distances()[0] <= limits(facets))


def shown_faces(facets, curved):
    """The CAD faces to show, as a mask: the `curved` ones, but for a far field, and flat ones that lie round them, as
    the ends of a pipe do, but not a plane of symmetry. All where none is curved."""
    if not curved.any():
        return np.ones(facets.faces, dtype=bool)
    shown = without_far_field(facets, curved) if facets.of_volumes else curved
    lower, upper = facets.boxes()
    box = lower[shown].min(axis=0), upper[shown].max(axis=0)
    reach = AROUND * size(box)
    near = (lower >= box[0] - reach).all(axis=1) & (upper <= box[1] + reach).all(axis=1)
    return shown | (near & facets.meets() & ~curved)


def size(box):
    """The length of its diagonal; of several boxes those of each."""
    return np.linalg.norm(box[1] - box[0], axis=-1)


def without_far_field(facets, faces):
    """`faces` but for those round a mesh that is round all others of them, if they are FAR times as large as these
    together. (A disc with a small hole has the shape of a flow round a cylinder: size alone tells.)"""
    lower, upper = facets.boxes()
    for body in bodies(facets, faces):
        rest = faces & ~body
        if not rest.any() or turned_out(facets, facets.on(body)) < 0 or turned_out(facets, facets.on(rest)) > 0:
            continue
        outer, inner = ((lower[chosen].min(axis=0), upper[chosen].max(axis=0)) for chosen in (body, rest))
        slack = NEGLIGIBLE * size(outer)  # Where both end at a plane of symmetry.
        around = (outer[0] <= inner[0] + slack).all() and (outer[1] >= inner[1] - slack).all()
        if around and size(outer) > FAR * size(inner):
            return rest
    return faces


def turned_out(facets, chosen):
    """The sign: 1 where the mesh is inside of the facets, -1 where it is around them, as the air of a wing."""
    middles = facets.middles()[chosen]
    return np.sign(np.sum(facets.normals()[chosen] * (middles - middles.mean(axis=0))))


def bodies(facets, faces):
    """`faces` as sets that have no point in common, as masks."""
    leader = np.arange(facets.faces)

    def lead(face):
        while leader[face] != face:
            leader[face] = leader[leader[face]]
            face = leader[face]
        return face

    pairs = facets.points_and_faces()
    pairs = pairs[faces[pairs[:, 1]]]
    meeting = pairs[:-1, 0] == pairs[1:, 0]
    for one, other in np.unique(np.column_stack([pairs[:-1, 1], pairs[1:, 1]])[meeting], axis=0):
        leader[lead(one)] = lead(other)
    leaders = np.array([lead(face) for face in range(facets.faces)], dtype=int)
    return [faces & (leaders == face) for face in np.unique(leaders[faces])]


def default_view(facets, shown):
    """The direction to the eye, of eight, from which most of the error is seen on what is shown."""
    if facets.flat:
        normal = facets.normals().sum(axis=0)
        return tuple(normal / normal[np.abs(normal).argmax()]) if normal.any() else IN_PLANE
    vectors = turned_out(facets, shown) * facets.normals()[shown]
    lengths = np.linalg.norm(vectors, axis=1)
    vectors *= np.divide(facets.error[shown], lengths, out=np.zeros(len(vectors)), where=lengths > 0)[:, None]

    def seen(view):
        return np.maximum(vectors @ view, 0.0).sum()

    views = [np.array(signs) * np.abs(DEFAULT_VIEW) for signs in itertools.product((-1, 1), repeat=3)]
    best = max(views, key=seen)
    return tuple(best) if seen(best) > WORTH_TURNING * seen(np.array(DEFAULT_VIEW)) else DEFAULT_VIEW


def points_in_view(facets, shown):
    """What the picture has room for. Of a mesh in the plane the triangles that carry error, and as much around."""
    if not facets.flat:
        return facets.points[facets.points_of(shown)]
    points = facets.points[facets.points_of(facets.distance > NEGLIGIBLE * facets.distance.max())]
    if not len(points):
        return facets.points
    middle, half = (points.min(axis=0) + points.max(axis=0)) / 2, np.ptp(points, axis=0) / 2 * (1 + AROUND)
    return np.clip([middle - half, middle + half], facets.points.min(axis=0), facets.points.max(axis=0))


def box_corners(box):
    return np.array(list(itertools.product(box[0:2], box[2:4], box[4:6])))
