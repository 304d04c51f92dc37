"""Meshes as numpy arrays, and as VTK's grids: what the readers and writers of this driver's own have in common."""

import dataclasses

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkCellTypes, vtkUnstructuredGrid

from cadrefine.formats import BadFile
from cadrefine.formats.cells import REDUCED, TURNED, TYPES, reordered, turned_where_negative

PHYSICAL, GEOMETRICAL = "gmsh:physical", "gmsh:geometrical"  # Cell arrays, named as meshio names them.
# Field data: names of patches, and the type of each behind it, in lines, as bytes: meshio reads no arrays of text.
PATCH_TYPES = "OpenFOAMPatchTypes"
SERIAL = "SERIAL:"  # Before the name of an HDF5 file: this process opens it alone, not all ranks together.
# Cell arrays that tell groups of cells, the first of them counts: of gmsh, Medit, Exodus, SU2, Nastran, universal
# files, Netgen, .vtk files.
TAG_ARRAYS = (PHYSICAL, "medit:ref", "ObjectId", "su2:tag", "nastran:ref", "unv:property", "netgen:index",
              "CellEntityIds", "MaterialIds")
WEDGES = {kind: TURNED[kind] for kind in (13, 26)}  # VTK has them the other way round.


@dataclasses.dataclass
class Mesh:
    """Cells of one type after the other, in `blocks` of type and nodes (cells, points), numbered as in `cells`; arrays
    over all points, and over all cells in the order of the blocks; `groups` is tag and dimension by name of group,
    `entity_names` the CAD's name by dimension and number of a CAD entity that cells are part of, `patch_types`
    OpenFOAM's type by name of patch."""

    points: np.ndarray
    blocks: list
    point_data: dict = dataclasses.field(default_factory=dict)
    cell_data: dict = dataclasses.field(default_factory=dict)
    groups: dict = dataclasses.field(default_factory=dict)
    entity_names: dict = dataclasses.field(default_factory=dict)
    patch_types: dict = dataclasses.field(default_factory=dict)

    def cell_dimensions(self):
        return np.repeat([TYPES[number][1] for number, _ in self.blocks], [len(corners) for _, corners in self.blocks])


def check(mesh):
    """Throws BadFile where cells have points that are not there, which VTK would not notice."""
    for _, corners in mesh.blocks:
        if len(corners) and not 0 <= corners.min() <= corners.max() < len(mesh.points):
            raise BadFile("a cell has a point that is not in the file")
    if not sum(len(corners) for _, corners in mesh.blocks):
        raise BadFile("the mesh has no cells")


def to_grid(mesh):
    """A vtkUnstructuredGrid. Names of groups become field data: two integers, the tag and the dimension."""
    sizes = [np.full(len(corners), corners.shape[1]) for _, corners in mesh.blocks]
    offsets = np.concatenate([[0], np.cumsum(np.concatenate(sizes or [[]]))])
    corners = np.concatenate([reordered(kind, corners, WEDGES).ravel() for kind, corners in mesh.blocks] or [[]])
    types = np.concatenate([np.full(len(corners), number) for number, corners in mesh.blocks] or [[]])
    grid = make_grid(in_space(mesh.points), types, offsets, corners)
    for data, arrays in ((grid.GetPointData(), mesh.point_data), (grid.GetCellData(), mesh.cell_data),
                         (grid.GetFieldData(), {name: np.int32([pair]) for name, pair in mesh.groups.items()})):
        for name, values in arrays.items():
            data.AddArray(to_vtk(name, np.asarray(values)))
    if mesh.patch_types:
        lines = "\n".join(text for pair in mesh.patch_types.items() for text in pair)
        grid.GetFieldData().AddArray(to_vtk(PATCH_TYPES, np.frombuffer(lines.encode(), np.uint8)))
    return grid


def make_grid(coordinates, types, offsets, corners):
    """A vtkUnstructuredGrid: of cell i, VTK's type and points corners[offsets[i]:offsets[i + 1]]."""
    grid = vtkUnstructuredGrid()
    points = vtkPoints()
    points.SetData(to_vtk("Points", coordinates))
    grid.SetPoints(points)
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(offsets.astype(np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(corners.astype(np.int64), deep=True))
    grid.SetCells(numpy_to_vtk(types.astype(np.uint8), deep=True), cells)
    return grid


def corners_of(grid, cells, sizes=None):
    """Offsets and points of `cells` (their numbers) of a VTK grid: of each its first points, `sizes` of them or all."""
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    sizes = np.diff(offsets)[cells] if sizes is None else sizes
    new_offsets = np.concatenate([[0], np.cumsum(sizes)])
    places = np.repeat(offsets[:-1][cells] - new_offsets[:-1], sizes) + np.arange(new_offsets[-1])
    return new_offsets, vtk_to_numpy(grid.GetCells().GetConnectivityArray())[places]


def to_vtk(name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    return array


def in_space(points):
    """Points of a plane get z = 0."""
    points = np.asarray(points, dtype=float)
    return np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))]) if points.shape[1] < 3 else points


def from_grid(grid):
    """A Mesh with the cells ordered by type, those of a type as they were; ids and ghost arrays are left out. Wedges
    are taken either way round: programs differ in how they read VTK's definition."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    types = vtk_to_numpy(grid.GetCellTypesArray())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    for kind, reduced in REDUCED.items():
        types = np.where(types == kind, reduced, types)
    order, blocks = [], []
    for kind in np.unique(types).tolist():
        if kind not in TYPES:
            raise BadFile(f"it holds a {vtkCellTypes.GetClassNameFromTypeId(kind)}")
        chosen = np.flatnonzero(types == kind)
        nodes = corners[offsets[chosen][:, np.newaxis] + np.arange(TYPES[kind][2])]
        blocks.append((kind, turned_where_negative(points, kind, nodes) if kind in WEDGES else nodes))
        order.append(chosen)
    order = np.concatenate(order or [[]]).astype(int)
    cell_data = {name: values[order] for name, values in arrays_of(grid.GetCellData()).items()}
    return Mesh(points, blocks, arrays_of(grid.GetPointData()), cell_data,
                groups_of(grid.GetFieldData()), entity_names_of(grid.GetCellData()),
                patch_types_of(grid.GetFieldData()))


def entity_names_of(cell_data):
    """{(dimension, entity): name} of the CAD entities that cells are part of."""
    dimensions, entities, names = (cell_data.GetAbstractArray("CAD" + name) for name in ("Dimension", "Entity", "Name"))
    if dimensions is None or entities is None or names is None:
        return {}
    pairs = np.column_stack([vtk_to_numpy(dimensions), vtk_to_numpy(entities)])
    found, cells = np.unique(pairs, axis=0, return_index=True)
    return {(int(dimension), int(entity)): names.GetValue(int(cell))
            for (dimension, entity), cell in zip(found, cells) if entity >= 0}


def patch_types_of(field_data):
    array = field_data.GetArray(PATCH_TYPES)
    lines = vtk_to_numpy(array).tobytes().decode().split("\n") if array else []
    return dict(zip(lines[::2], lines[1::2]))


def arrays_of(data):
    """The arrays of numbers, by name, but for ids and what ParaView adds for its own use."""
    ids = data.GetGlobalIds()
    arrays = {}
    for index in range(data.GetNumberOfArrays()):
        array = data.GetArray(index)
        if array is not None and array != ids and not array.GetName().startswith("vtk"):
            arrays[array.GetName()] = vtk_to_numpy(array)
    return arrays


def groups_of(field_data):
    """Names of groups: field data of two integers, tag and dimension, as meshio has them too."""
    groups = {}
    for index in range(field_data.GetNumberOfArrays()):
        array = field_data.GetArray(index)
        if array is not None and array.GetNumberOfValues() == 2 and not array.IsA("vtkDoubleArray"):
            tag, dimension = (int(array.GetComponent(i // array.GetNumberOfComponents(),
                                                     i % array.GetNumberOfComponents())) for i in range(2))
            if tag > 0 and 0 <= dimension <= 3:
                groups[array.GetName()] = (tag, dimension)
    return groups


def tag_array(cell_data):
    """Name of the array that tells groups of cells, or None."""
    return next((name for name in TAG_ARRAYS if name in cell_data), None)


def positions(tags, all_tags):
    """Where each of `tags` stands in `all_tags`."""
    order = np.argsort(all_tags, kind="stable")
    found = np.minimum(np.searchsorted(all_tags, tags, sorter=order), len(order) - 1)
    if len(order) == 0 or (all_tags[order[found]] != tags).any():
        raise BadFile("a cell or a value belongs to a node or element that is not in the file")
    return order[found]
