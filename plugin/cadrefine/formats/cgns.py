"""Reads CGNS files in HDF5, with the names of boundary conditions, families and zones as groups. (ParaView's reader
gives no names; meshio's files are none to other programs.)

1. The elements of all zones become cells. Points of several zones with the same coordinates become one.
2. A boundary condition is a group of the elements that it lists, or of the facets between the nodes that it lists. Its
   names are those of its families, and its own. In gmsh's files a family stands for a part of the geometry, and the
   names in it are those of physical groups: these count.
3. A section of facets is a group where no condition has any of them: SU2 knows no conditions, but names of sections.
4. A part of a zone that lists elements is a group of its families and its name, as a condition is.
5. The cells of a zone are a group of its families. Of several zones, one without has its name, where no condition has
   any of its cells.
"""

import dataclasses

import numpy as np

from cadrefine.formats import BadFile, library
from cadrefine.formats.blocks import in_order
from cadrefine.formats.bulk import Bulk
from cadrefine.formats.cells import CORNERS, LAYERED, TYPES, inverse, reordered
from cadrefine.formats.cgns_tree import REGION, Node
from cadrefine.formats.cgns_types import MIXED, NAMES, SIZES, VTK_TYPES
from cadrefine.formats.grid import Mesh, in_space, positions
from cadrefine.formats.sides import same_rows, sides_of, with_facets

ORDERS = inverse(LAYERED)


@dataclasses.dataclass
class Part:
    """Elements of one type of a section: VTK's type, corners from 0 on, numbers in the zone."""

    section: str
    kind: int
    corners: np.ndarray
    numbers: np.ndarray


@dataclasses.dataclass
class Zone:
    """`places` are those of its points in the mesh, `first` is the number of its first cell there."""

    node: Node
    points: np.ndarray
    parts: list
    places: np.ndarray = None
    first: int = 0

    def numbers(self):
        return np.concatenate([part.numbers for part in self.parts])

    def dimensions(self):
        return np.concatenate([np.full(len(part.numbers), TYPES[part.kind][1]) for part in self.parts])


def read(path):
    """The only base of the file. Throws BadFile."""
    h5py = library("h5py")
    try:
        with h5py.File(path, "r") as file:
            return read_file(Node(file, "the file"))
    except (OSError, RuntimeError, LookupError, ValueError, TypeError, MemoryError) as error:  # Of h5py and numpy.
        raise BadFile(f"malformed: {' '.join(str(error).split())}") from None


def read_file(root):
    bases = root.all("CGNSBase_t")
    if len(bases) != 1:
        names = ", ".join(base.name for base in bases)
        raise BadFile(f"it holds {len(bases)} bases ({names}); save one alone" if bases else "it holds no base")
    zones = [read_zone(node) for node in bases[0].all("Zone_t")]
    zones = [zone for zone in zones if zone.parts]
    if not zones:
        raise BadFile("the mesh has no cells")
    mesh = joined(zones)
    conditions = [(zone, node) for zone in zones for of_zone in zone.node.all("ZoneBC_t")
                  for node in of_zone.all("BC_t")]
    conditions += [(zone, node) for zone in zones for node in zone.node.all(REGION)
                   if (node.has("PointList") or node.has("PointRange")) and not is_of_nodes(node)]
    if any(is_of_nodes(node) for _, node in conditions):
        mesh = with_boundary_facets(mesh)
    add_groups(mesh, zones, conditions, families_of(bases[0]))
    add_arrays(mesh, zones)
    return mesh


def families_of(base):
    """{name: names of the families in it}."""
    return {family.name: [name.text() for name in family.all("FamilyName_t")] for family in base.all("Family_t")}


def read_zone(node):
    if node.child("ZoneType").text() != "Unstructured":
        raise BadFile(f"the zone {node.name} is structured; save it as an unstructured one")
    grids = node.all("GridCoordinates_t")
    if not grids:
        raise BadFile(f"the zone {node.name} has no nodes")
    grid = min(grids, key=lambda grid: grid.name != "GridCoordinates")  # Others are of later times.
    axes = [grid.child("Coordinate" + axis).data() for axis in "XYZ" if axis != "Z" or grid.has("CoordinateZ")]
    points = in_space(np.column_stack(axes))
    parts = [part for section in node.all("Elements_t") for part in parts_of(section)]
    for part in parts:
        if len(part.corners) and not 0 <= part.corners.min() <= part.corners.max() < len(points):
            raise BadFile(f"an element of {part.section} has a node that is not in the file")
    return Zone(node, points, sorted(parts, key=lambda part: part.numbers[0]))


def parts_of(section):
    """The elements of a section, type by type."""
    kind = int(section.integers()[0])
    first, last = section.child("ElementRange").integers()
    values = section.child("ElementConnectivity").integers()
    if kind == MIXED:
        starts = 1 + starts_of(section, values)
        kinds = values[starts - 1]
    else:
        starts = np.arange(0, len(values), size_of(section, kind))
        kinds = np.full(len(starts), kind)
    for kind in np.unique(kinds).tolist():
        chosen = np.flatnonzero(kinds == kind)
        if starts[chosen[-1]] + size_of(section, kind) > len(values) or len(starts) != last - first + 1:
            raise BadFile(f"{section.name} does not hold the elements {first} to {last}")
        vtk = VTK_TYPES[kind]
        nodes = values[starts[chosen, np.newaxis] + np.arange(TYPES[vtk][2])] - 1
        yield Part(section.name, vtk, reordered(vtk, nodes, ORDERS), first + chosen)


def size_of(section, kind):
    if kind not in SIZES:
        raise BadFile(f"{section.name} holds elements of CGNS's type {NAMES.get(kind, kind)}")
    return SIZES[kind]


def starts_of(section, values):
    """Where each element of a mixed section begins, with its type. Before version 4 no offsets tell."""
    if section.has("ElementStartOffset"):
        return section.child("ElementStartOffset").integers()[:-1]
    starts, place, values = [], 0, values.tolist()
    while place < len(values):
        starts.append(place)
        place += 1 + size_of(section, values[place])
    return np.array(starts, int)


def joined(zones):
    """One Mesh of points and cells."""
    points = np.concatenate([zone.points for zone in zones])
    places = np.arange(len(points))
    if len(zones) > 1:
        places, first = in_order(same_rows(points))
        points = points[first]
    mesh, first_point, first_cell = Mesh(points, []), 0, 0
    for zone in zones:
        zone.places, zone.first = places[first_point:first_point + len(zone.points)], first_cell
        mesh.blocks += [(part.kind, zone.places[part.corners]) for part in zone.parts]
        first_point += len(zone.points)
        first_cell += sum(len(part.corners) for part in zone.parts)
    return mesh


def with_boundary_facets(mesh):
    """The mesh with the facets of its boundary as cells, if it has no facets."""
    dimensions = mesh.cell_dimensions()
    if dimensions.max() < 2 or (dimensions == dimensions.max() - 1).any():
        return mesh
    sides = sides_of(mesh)
    return with_facets(mesh, sides, np.flatnonzero(sides.neighbours < 0))


def is_of_nodes(condition):
    """Whether it lists nodes: that is what a list means, if nothing else is said."""
    return (not condition.has("GridLocation") or condition.child("GridLocation").text() == "Vertex") and not (
        condition.has("ElementList") or condition.has("ElementRange"))


def add_groups(mesh, zones, conditions, families):
    dimensions = mesh.cell_dimensions()
    highest, groups, listed = dimensions.max(), {}, np.zeros(len(dimensions), bool)
    for zone, condition in conditions:
        cells = facets_of(mesh, zone, condition) if is_of_nodes(condition) else elements_of(zone, condition)
        listed[cells] = True
        for name in names_of(condition, families, condition.name):
            groups.setdefault(name, []).append(cells)
    for zone in zones:
        sections = zone_sections(zone)
        for name, cells in sections.items():
            if dimensions[cells].max() < highest and not listed[cells].any():
                groups.setdefault(name, []).append(cells)
        cells = np.concatenate([*sections.values()])
        cells = cells[dimensions[cells] == highest]
        own = [zone.node.name] if len(zones) > 1 and not listed[cells].any() else []
        for name in names_of(zone.node, families) or own:
            groups.setdefault(name, []).append(cells)
    groups = {name: np.unique(np.concatenate(cells)) for name, cells in groups.items()}
    Bulk.add_groups(mesh, [part for name, cells in groups.items() for part in by_dimension(name, cells, dimensions)])


def by_dimension(name, cells, dimensions):
    """A name of cells of several dimensions goes to the highest of them."""
    found = np.unique(dimensions[cells])
    for dimension in found[::-1]:
        yield (name if dimension == found[-1] else f"{name} of dimension {dimension}",
               cells[dimensions[cells] == dimension])


def names_of(node, families, *own):
    """Those within its families, or of these and `own`."""
    outer = [name.text().rpartition("/")[2] for label in ("FamilyName_t", "AdditionalFamilyName_t")
             for name in node.all(label)]
    inner = [name for family in outer for name in families.get(family, [])]
    return inner or list(dict.fromkeys([*outer, *own]))


def zone_sections(zone):
    """{name: cells of the mesh}."""
    cells, first = {}, zone.first
    for part in zone.parts:
        cells.setdefault(part.section, []).append(np.arange(first, first + len(part.numbers)))
        first += len(part.numbers)
    return {name: np.concatenate(of_section) for name, of_section in cells.items()}


def listed_in(condition, numbers):
    """Places in `numbers` of those that the condition lists."""
    for name in ("PointRange", "ElementRange"):
        if condition.has(name):
            values = condition.child(name).integers()
            return np.flatnonzero((values.min() <= numbers) & (numbers <= values.max()))
    values = condition.child("ElementList" if condition.has("ElementList") else "PointList").integers()
    try:
        return positions(values, numbers)
    except BadFile:
        raise BadFile(f"the boundary condition {condition.name} lists nodes or elements that are not in the "
                      "file") from None


def elements_of(zone, condition):
    return zone.first + listed_in(condition, zone.numbers())


def facets_of(mesh, zone, condition):
    """The facets of the mesh with all corners at nodes of the condition."""
    inside = np.zeros(len(mesh.points), bool)
    inside[zone.places[listed_in(condition, 1 + np.arange(len(zone.places)))]] = True
    highest = mesh.cell_dimensions().max()
    chosen = [inside[corners[:, :CORNERS[kind]]].all(axis=1) & (TYPES[kind][1] == highest - 1)
              for kind, corners in mesh.blocks]
    return np.flatnonzero(np.concatenate(chosen))


def add_arrays(mesh, zones):
    """Solutions at nodes and in cells; of several, the first."""
    highest = mesh.cell_dimensions().max()
    counts = {"Vertex": len(mesh.points), "CellCenter": len(mesh.cell_dimensions())}
    arrays = {"Vertex": mesh.point_data, "CellCenter": mesh.cell_data}
    for zone in zones:
        cells = np.flatnonzero(zone.dimensions() == highest)
        places = {"Vertex": zone.places, "CellCenter": zone.first + cells[np.argsort(zone.numbers()[cells])]}
        for (location, name), values in solutions_of(zone.node).items():
            if len(values) != len(places[location]):
                raise BadFile(f"{name} has {len(values)} values in {zone.node.name}, but needs {len(places[location])}")
            array = arrays[location].setdefault(name, np.zeros((counts[location], *values.shape[1:]), values.dtype))
            array[places[location]] = values


def solutions_of(zone):
    """{(location, name): values}. The components X, Y, Z of a vector become one array, as in ParaView."""
    arrays = {}
    for solution in zone.all("FlowSolution_t"):
        location = solution.child("GridLocation").text() if solution.has("GridLocation") else "Vertex"
        if location in ("Vertex", "CellCenter") and not solution.has("PointList") and not solution.has("PointRange"):
            for node in solution.all("DataArray_t"):
                if (location, node.name) not in arrays and node.has(" data"):
                    arrays[location, node.name] = node.data()
    arrays = {pair: values for pair, values in arrays.items() if values.dtype.kind in "iuf"}
    for location, name in [pair for pair in arrays if pair[1].endswith("X")]:
        components = [(location, name[:-1] + axis) for axis in "XYZ" if (location, name[:-1] + axis) in arrays]
        if len(name) > 1 and len(components) > 1:
            arrays[location, name[:-1]] = in_space(np.column_stack([arrays.pop(pair) for pair in components]))
    return arrays
