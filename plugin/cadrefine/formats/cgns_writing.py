"""Writes CGNS files in HDF5, of one zone: boundary conditions for groups of facets and edges, subregions of the zone
for those of cells."""

import itertools

import numpy as np

from cadrefine.formats import library
from cadrefine.formats.cells import LAYERED, TYPES, reordered
from cadrefine.formats.cgns_tree import REGION
from cadrefine.formats.cgns_types import CGNS_TYPES, MIXED
from cadrefine.formats.grid import PHYSICAL
from cadrefine.formats.groups import grouped, members
from cadrefine.formats.sides import with_boundary

VERSION = 3.3  # Later ones have offsets in mixed sections.
NAME = 32  # Most bytes of the name of a node.
CELLS = "cells"  # The section of the cells of the highest dimension.
LOCATIONS = {1: "EdgeCenter", 2: "FaceCenter"}
KINDS = {"i4": "I4", "i8": "I8", "f4": "R4", "f8": "R8", "i1": "C1"}  # CGNS's types of data, by numpy's.


def write(path, mesh):
    """Each facet of the boundary is in a condition. The cells are a section, facets and edges one for each group, the
    first that they are in; vertices, and facets and edges in no group, are left out."""
    h5py = library("h5py")
    mesh = with_boundary(grouped(mesh))
    dimensions = mesh.cell_dimensions()
    highest = int(dimensions.max())
    space = 3 if highest == 3 or np.any(mesh.points[:, 2]) else 2
    sections, numbers = sections_of(mesh)
    with h5py.File(path, "w", track_order=True) as file:
        describe(file, "HDF5 MotherNode", "Root Node of HDF5 File", "MT")
        file[" format"] = characters("IEEE_LITTLE_32\0")
        file[" hdf5version"] = characters("HDF5 Version 1.8".ljust(NAME + 1, "\0"))
        add(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", np.float32([VERSION]))
        base = add(file, "Base", "CGNSBase_t", np.int32([highest, space]))
        zone = add(base, "Zone", "Zone_t", integers([[len(mesh.points)], [(dimensions == highest).sum()], [0]]))
        add(zone, "ZoneType", "ZoneType_t", "Unstructured")
        grid = add(zone, "GridCoordinates", "GridCoordinates_t")
        for axis, values in zip("XYZ"[:space], mesh.points.T):
            add(grid, "Coordinate" + axis, "DataArray_t", values.astype(float))
        conditions = add(zone, "ZoneBC", "ZoneBC_t")
        for name, blocks, first in sections:
            add_section(zone, free(name, zone), blocks, first)
        for name, (_, dimension) in mesh.groups.items():
            chosen = np.sort(numbers[members(mesh, name)])
            if dimension == highest:
                node = add(zone, free(name, zone), REGION, np.int32([dimension]))
                add_members(node, chosen, "CellCenter")
            elif dimension > 0:
                node = add(conditions, free(name, conditions), "BC_t", "UserDefined")
                add_members(node, chosen, LOCATIONS[dimension])


def sections_of(mesh):
    """Name, blocks and first number of each section, the cells of the highest dimension first; and for each cell of the
    mesh its number in the file, 0 for those left out."""
    names = {pair: name for name, pair in mesh.groups.items()}
    dimensions, tags = mesh.cell_dimensions(), mesh.cell_data[PHYSICAL]
    starts = np.cumsum([0, *(len(nodes) for _, nodes in mesh.blocks)])
    numbers, sections, written = np.zeros(starts[-1], int), {}, 1
    highest = dimensions.max()
    kept = (dimensions == highest) | (dimensions > 0) & (tags > 0)
    for dimension, tag in np.unique(np.column_stack([dimensions, tags])[kept], axis=0)[::-1].tolist():
        name = CELLS if dimension == highest else names[tag, dimension]
        _, blocks = sections.setdefault((name, dimension), (written, []))
        for (kind, nodes), start in zip(mesh.blocks, starts):
            inside = np.flatnonzero(tags[start:start + len(nodes)] == tag) if TYPES[kind][1] == dimension else ()
            if len(inside):
                numbers[start + inside] = np.arange(written, written + len(inside))
                blocks.append((kind, nodes[inside]))
                written += len(inside)
    return [(name, blocks, first) for (name, _), (first, blocks) in sections.items()], numbers


def add_section(zone, name, blocks, first):
    """Elements of one type, or each with its type before it."""
    kinds = {kind for kind, _ in blocks}
    mixed = len(kinds) > 1
    section = add(zone, name, "Elements_t", np.int32([MIXED if mixed else CGNS_TYPES[kinds.pop()], 0]))
    count = sum(len(nodes) for _, nodes in blocks)
    add(section, "ElementRange", "IndexRange_t", integers([first, first + count - 1]))
    rows = []
    for kind, nodes in blocks:
        nodes = reordered(kind, nodes, LAYERED) + 1
        rows.append(np.insert(nodes, 0, CGNS_TYPES[kind], axis=1).ravel() if mixed else nodes.ravel())
    add(section, "ElementConnectivity", "DataArray_t", integers(np.concatenate(rows)))


def add(parent, name, label, data=None):
    """A node of the tree that the file is."""
    data = characters(data) if isinstance(data, str) else data
    node = parent.create_group(name, track_order=True)  # VTK's reader takes nodes in the order of their making.
    kind = "MT" if data is None else KINDS[data.dtype.str[1:]]
    describe(node, name, label, kind)
    node.attrs["flags"] = np.int32([1])
    if data is not None:
        node[" data"] = data
    return node


def describe(node, name, label, kind):
    """Texts of the length that the CGNS library reads."""
    node.attrs.update(name=np.array(name.encode(), f"S{NAME + 1}"), label=np.array(label.encode(), f"S{NAME + 1}"),
                      type=np.array(kind.encode(), "S3"))


def add_members(node, numbers, location):
    """Elements of a condition or a region, by their numbers."""
    if numbers[-1] - numbers[0] == len(numbers) - 1:
        add(node, "PointRange", "IndexRange_t", integers([[numbers[0]], [numbers[-1]]]))
    else:
        add(node, "PointList", "IndexArray_t", integers(numbers[:, np.newaxis]))
    add(node, "GridLocation", "GridLocation_t", location)


def free(name, parent):
    """The name as the format takes it, and as `parent` has none yet."""
    for number in itertools.count(1):
        suffix = f" {number}" if number > 1 else ""
        wanted = name.replace("/", "_").encode()[:NAME - len(suffix)].decode(errors="ignore") + suffix
        if wanted not in parent:
            return wanted


def characters(text):
    return np.frombuffer(text.encode(), np.int8)


def integers(values):
    """In 32 bits where they fit."""
    values = np.asarray(values, np.int64)
    return values.astype(np.int32) if values.max(initial=0) < 2**31 else values
