"""Sides of cells, and which of them the facets of a mesh are."""

import dataclasses

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.cells import CORNERS, SIDES, TYPES, facet_of, mirrored
from cadrefine.formats.grid import PHYSICAL, tag_array
from cadrefine.formats.groups import BOUNDARY, is_list, set_groups, unused

WIDTH = 4  # Most corners of a side.
IN_PLANE = 2e-7  # A planar mesh leaves its plane by less, in parts of its extent: the filters take it for one, too.


@dataclasses.dataclass
class Sides:
    """The sides of a mesh's cells of the highest dimension, each once. `corners` (sides, 4) go round as `cells` sees it
    from inside, -1 where there are fewer; `cells` is the first cell that has the side, `numbers` which of its sides it
    is, `neighbours` the second cell, -1 on the boundary; `facets` the cell of one dimension less with the same corners,
    or -1. Cells are counted over all blocks of the mesh."""

    corners: np.ndarray
    cells: np.ndarray
    numbers: np.ndarray
    neighbours: np.ndarray
    facets: np.ndarray


def sides_of(mesh):
    dimension = int(mesh.cell_dimensions().max(initial=0))
    corners, cells, numbers = all_sides(mesh, dimension)
    facet_corners, facets = cells_of(mesh, dimension - 1)
    classes, count = same_corners(np.concatenate([corners, facet_corners]))
    of_side, of_facet = classes[:len(corners)], classes[len(corners):]

    first = np.full(count, -1)
    first[of_side[::-1]] = np.arange(len(corners))[::-1]
    second = np.full(count, -1)
    second[of_side] = np.arange(len(corners))
    facet = np.full(count, -1)
    facet[of_facet[::-1]] = facets[::-1]
    chosen = np.sort(first[first >= 0])
    other = second[of_side[chosen]]
    return Sides(corners[chosen], cells[chosen], numbers[chosen], np.where(other == chosen, -1, cells[other]),
                 facet[of_side[chosen]])


def tagged(mesh, sides):
    """The tag of each side's group, 0 for none; each side of the boundary has one: for those in no group, a group is
    added to the mesh."""
    tags = np.where(sides.facets >= 0, mesh.cell_data[PHYSICAL][sides.facets], 0)
    rest = (tags == 0) & (sides.neighbours < 0)
    if rest.any():
        tags[rest] = 1 + max([0, *(tag for tag, _ in mesh.groups.values())])
        mesh.groups[unused(BOUNDARY, mesh.groups)] = (int(tags[rest][0]), int(mesh.cell_dimensions().max()) - 1)
    return tags


def with_boundary(mesh):
    """The grouped mesh with each side of its boundary as a cell that is in a group."""
    sides = sides_of(mesh)
    mesh = with_facets(mesh, sides, np.flatnonzero((sides.neighbours < 0) & (sides.facets < 0)))
    sides = sides_of(mesh)
    boundary = sides.neighbours < 0
    mesh.cell_data[PHYSICAL][sides.facets[boundary]] = tagged(mesh, sides)[boundary]
    return mesh


def with_facets(mesh, sides, chosen):
    """The mesh with the `chosen` sides of its cells as further cells, whose arrays are 0."""
    found, first = {}, 0
    for kind, nodes in mesh.blocks:
        cells, numbers = sides.cells[chosen] - first, sides.numbers[chosen]
        inside = (0 <= cells) & (cells < len(nodes))
        for number in np.unique(numbers[inside]):
            facet, places = facet_of(kind, SIDES[kind][number])
            found.setdefault(facet, []).append(nodes[cells[inside & (numbers == number)]][:, places])
        first += len(nodes)
    cell_data = {name: np.concatenate([values, np.zeros((len(chosen), *values.shape[1:]), values.dtype)])
                 for name, values in mesh.cell_data.items()}
    blocks = [*mesh.blocks, *((facet, np.concatenate(rows)) for facet, rows in found.items())]
    return dataclasses.replace(mesh, blocks=blocks, cell_data=cell_data)


def all_sides(mesh, dimension):
    """Corners, cells and numbers of the sides, cell by cell."""
    corners, cells, numbers, first = [], [], [], 0
    for kind, points in mesh.blocks:
        if TYPES[kind][1] == dimension:
            table = np.array([padded(side) for side in SIDES[kind]])
            corners.append(np.where(table >= 0, points[:, table], -1).reshape(-1, WIDTH))
            cells.append(np.repeat(np.arange(first, first + len(points)), len(table)))
            numbers.append(np.tile(np.arange(len(table)), len(points)))
        first += len(points)
    return np.concatenate(corners), np.concatenate(cells), np.concatenate(numbers)


def cells_of(mesh, dimension):
    """Corners of the cells of that dimension, -1 where there are fewer than 4, and their numbers."""
    corners, cells, first = [np.zeros((0, WIDTH), int)], [np.zeros(0, int)], 0
    for kind, points in mesh.blocks:
        if TYPES[kind][1] == dimension:
            rows = np.full((len(points), WIDTH), -1)
            rows[:, :CORNERS[kind]] = points[:, :CORNERS[kind]]
            corners.append(rows)
            cells.append(np.arange(first, first + len(points)))
        first += len(points)
    return np.concatenate(corners), np.concatenate(cells)


def check_pyramids(mesh):
    """Throws BadFile where pyramids are missing between quadrilaterals and tetrahedra."""
    corners = {CORNERS[kind] for kind, nodes in mesh.blocks if len(nodes) and TYPES[kind][1] == 3}
    if 4 not in corners or 5 in corners or len(corners) == 1:  # Tetrahedra, and hexahedra or wedges, but no pyramids.
        return
    corners = all_sides(mesh, 3)[0]
    quads = alone(corners[corners[:, 3] >= 0])
    is_corner = np.zeros(len(mesh.points), bool)
    is_corner[quads] = True
    triangles = corners[corners[:, 3] < 0]
    triangles = alone(triangles[is_corner[triangles[:, :3]].sum(axis=1) >= 2])
    bases = np.concatenate([quads[:, [k, (k + 1) % 4]] for k in range(4)])
    edges = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    apexes = np.concatenate([triangles[:, (k + 2) % 3] for k in range(3)])
    classes, _ = same_corners(np.concatenate([bases, edges]))
    of_base, of_edge = classes[:len(bases)], classes[len(bases):]
    order = np.argsort(of_edge)
    first, last = (np.searchsorted(of_edge[order], of_base, side) for side in ("left", "right"))
    beside = np.concatenate([np.zeros(0, int), *(order[a:b] for a, b in zip(first, last))])
    quad = np.repeat(np.tile(np.arange(len(quads)), 4), last - first)
    _, sides = np.unique(np.column_stack([quad, apexes[beside]]), axis=0, return_counts=True)
    cavities = np.count_nonzero(sides == 4)
    if cavities:
        raise BadFile(f"the mesh has no pyramids, but cavities where they should be, between quadrilaterals and "
                      f"tetrahedra: {cavities}; gmsh writes pyramids only to some formats, .msh and .su2 among them: "
                      "save the mesh in one of these")


def alone(rows):
    """The rows whose corners no other row has."""
    classes, count = same_corners(rows)
    return rows[np.bincount(classes, minlength=count)[classes] == 1]


def once(mesh):
    """The mesh with each cell below its own dimension once: one that comes several times, for each of its groups, is
    in all of them."""
    highest = int(mesh.cell_dimensions().max(initial=0))
    kept = np.arange(len(mesh.cell_dimensions()))
    for dimension in range(highest):
        corners, cells = cells_of(mesh, dimension)
        classes, count = same_corners(corners)
        first = np.full(count, -1)
        first[classes[::-1]] = cells[::-1]
        kept[cells] = first[classes]
    single = kept == np.arange(len(kept))
    name = tag_array(mesh.cell_data)
    if single.all():
        return mesh
    blocks, start = [], 0
    for kind, corners in mesh.blocks:
        blocks.append((kind, corners[single[start:start + len(corners)]]))
        start += len(corners)
    result = dataclasses.replace(mesh, blocks=blocks,
                                 cell_data={name: values[single] for name, values in mesh.cell_data.items()})
    if name:
        place = (np.cumsum(single) - 1)[kept]
        tags = mesh.cell_data[name]
        rows = [np.column_stack([place, tags])[tags > 0]]
        for group, (tag, dimension) in mesh.groups.items():
            if is_list(mesh.cell_data.get(group)):
                inside = place[(mesh.cell_data[group] == 1) & (mesh.cell_dimensions() == dimension)]
                rows.append(np.column_stack([inside, np.full(len(inside), tag)]))
        rows = np.concatenate(rows)
        _, first = np.unique(rows, axis=0, return_index=True)
        set_groups(result, rows[np.sort(first)])
    return result


def turned_alike(mesh):
    """The cells of a mesh of one plane all the same way round, in z = 0 counter-clockwise: gmsh has those of each
    surface its own way round. As it is where all are one way round, or two are on the same side of an edge between
    them, as inverted ones are."""
    if mesh.cell_dimensions().max(initial=0) != 2:
        return mesh
    corners, cells = cells_of(mesh, 2)
    points = np.pad(mesh.points, ((0, 0), (0, 3 - mesh.points.shape[1])))
    axes = axes_of_plane(points[np.unique(corners[corners >= 0])])
    if axes is None:
        return mesh
    x, y = np.moveaxis((points[np.where(corners < 0, corners[:, :1], corners)] - points[corners[:, :1]]) @ axes, 2, 0)
    turns = np.sign((x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1))
    ends, of_side, _ = all_sides(mesh, 2)
    on_left = turns[np.searchsorted(cells, of_side)] * np.where(ends[:, 0] < ends[:, 1], 1, -1)
    classes, _ = same_corners(ends)
    if not (turns < 0).any() or not (turns > 0).any() or (np.abs(np.bincount(classes, on_left)) > 1).any():
        return mesh
    blocks, turns = [], np.split(turns, np.cumsum([len(nodes) for kind, nodes in mesh.blocks if TYPES[kind][1] == 2]))
    for kind, nodes in mesh.blocks:
        if TYPES[kind][1] == 2:
            turned = nodes[:, mirrored(kind, [0, *range(CORNERS[kind] - 1, 0, -1)])]
            nodes = np.where(turns.pop(0)[:, np.newaxis] < 0, turned, nodes)
        blocks.append((kind, nodes))
    return dataclasses.replace(mesh, blocks=blocks)


def axes_of_plane(points):
    """Two unit vectors, as columns, that span the plane of the points; None where these lie in none."""
    offsets = points - points.mean(axis=0)
    (first, second, normal), extent = np.linalg.svd(offsets, full_matrices=False)[2], np.ptp(offsets, axis=0).max()
    if np.abs(offsets @ normal).max() > IN_PLANE * extent:
        return None
    largest = np.abs(normal).argmax()
    return np.column_stack([first, second * np.sign(np.cross(first, second)[largest])])


def padded(side):
    return (*side, *[-1] * (WIDTH - len(side)))


def same_corners(rows):
    """A number for each row, the same where the corners are the same in whatever order; and how many there are."""
    return same_rows(np.sort(rows, axis=1))


def same_rows(rows):
    order = np.lexsort(rows.T)
    changes = (rows[order][1:] != rows[order][:-1]).any(axis=1)
    classes = np.empty(len(rows), dtype=int)
    classes[order] = np.concatenate([[0], np.cumsum(changes)])[:len(rows)]
    return classes, int(classes.max(initial=-1)) + 1
