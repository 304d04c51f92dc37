"""Reads and writes XDMF files with their HDF5 files, as meshio, DOLFIN, DOLFINx and ParaView have them."""

import contextlib
import copy
import os
import xml.etree.ElementTree as ElementTree

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkUnstructuredGrid
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader, vtkXdmfWriter

from cadrefine.formats import BadFile, library
from cadrefine.formats.blocks import joined, merge_cells, orient
from cadrefine.formats.cells import TYPES
from cadrefine.formats.grid import PHYSICAL, SERIAL, Mesh, arrays_of, tag_array, to_grid, to_vtk
from cadrefine.formats.groups import grouped

FACET_TAGS = "facet_tags"
PLANE = "plane"  # Points in the plane, two coordinates: DOLFIN takes them for a mesh of two dimensions.
INCLUDE = "{*}include"  # DOLFINx 0.5 and 0.9 have different names for the name space.

# XDMF's numbers, by VTK's, of the types of cells that can be beside others in a grid.
NUMBERS = {5: 4, 9: 5, 10: 6, 14: 7, 13: 8, 12: 9, 22: 36, 23: 37, 24: 38, 27: 39, 26: 40, 25: 48}
# Names of the types of second order, which VTK's writer has not.
NAMES = {21: "Edge_3", 22: "Tri_6", 23: "Quad_8", 24: "Tet_10", 25: "Hex_20", 26: "Wedge_15", 27: "Pyramid_13"}

OVERHEAD = 1 << 20  # Bytes of an HDF5 file beside its numbers, more or less.
KINDS = {1: "Scalar", 3: "Vector", 6: "Tensor6", 9: "Tensor"}  # Of attributes, by components.


def read(path):
    """All grids of the file's domain as one, of a series the first time step. Throws BadFile."""
    tree = parse(path)
    resolve_includes(tree)
    grids = [grid for grid in tree.iter("Grid") if grid.find("Grid") is None]
    if not grids or any(grid.find(part) is None for grid in grids for part in ("Topology", "Geometry")):
        raise BadFile("it holds no grid of cells, or one without them")  # VTK's reader would crash.
    folder = os.path.dirname(os.path.abspath(path))
    for item in tree.iter("DataItem"):
        if item.get("Format", "XML").upper() != "HDF" or ":" not in (item.text or ""):
            continue
        name, _, inside = item.text.strip().rpartition(":")
        heavy = os.path.join(folder, name)
        if not os.path.isfile(heavy):
            raise BadFile(f"its data file {name} does not exist")
        item.text = f"{SERIAL}{heavy}:{inside}"
        if item.get("NumberType", "Float") == "Float" and item.get("DataType", "Float") == "Float":
            item.set("Precision", "8")  # DOLFIN leaves it out, and has doubles; 4 would be the default.
    reader = vtkXdmfReader()
    reader.SetFileName(path)
    reader.SetReadFromInputString(1)
    text = ElementTree.tostring(tree.getroot(), encoding="unicode")
    reader.SetInputString(text)
    reader.Update()
    if reader.GetOutputDataObject(0) is None:
        raise BadFile("it holds no grid that can be read")
    grid = merge_cells(joined(reader.GetOutputDataObject(0)))
    if grid.GetCellData().HasArray(PHYSICAL):
        grid.GetCellData().RemoveArray(FACET_TAGS)
    for name, pair in names_of(tree).items():
        grid.GetFieldData().AddArray(to_vtk(name, np.int32([pair])))
    orient(grid)  # DOLFIN orders the corners of a cell by their numbers.
    return grid


def resolve_includes(tree):
    """DOLFINx writes the mesh first; its tags are grids that include the geometry of that one, with an array of
    integers. The first tags of each type of cells are those of groups."""
    tagged = set()
    for grid in [grid for grid in tree.iter("Grid") if grid.find(INCLUDE) is not None]:
        topology, attribute = grid.find("Topology"), grid.find("Attribute[@Center='Cell']")
        for include in grid.findall(INCLUDE):
            grid.remove(include)
            grid.extend(copy.deepcopy(elements_at(tree, include)))
        if topology is None or attribute is None:
            continue  # It is a function on the mesh.
        attribute.find("DataItem").set("NumberType", "Int")
        if topology.get("TopologyType") not in tagged:
            attribute.set("Name", PHYSICAL)
            tagged.add(topology.get("TopologyType"))


def elements_at(tree, include):
    """What an XInclude of DOLFINx or DOLFIN points to: `xpointer(/Xdmf/Domain/Grid/Geometry)`, or
    `xpointer(/Xdmf/Domain/Grid[@GridType='Uniform'][1]/*[self::Topology or self::Geometry])`."""
    path = include.get("xpointer", "").removeprefix("xpointer(").removesuffix(")")
    path, _, names = path.partition("/*")
    path = "." + path.removeprefix("/Xdmf")
    try:
        found = tree.getroot().find(path)
    except SyntaxError:
        found = None
    if found is None:
        raise BadFile(f"it includes {include.get('xpointer')}, which does not exist")
    return [part for part in found if part.tag in names] if names else [found]


def names_of(tree):
    """Tag and dimension by name of group."""
    try:
        return {item.get("key"): (int(item.text), int(item.get("dim"))) for information in tree.iter("Information")
                if (information.text or "").strip() for item in ElementTree.fromstring(information.text)}
    except (ElementTree.ParseError, TypeError, ValueError):  # Information of another kind.
        return {}


def parse(path):
    try:
        return ElementTree.parse(path)
    except ElementTree.ParseError as error:
        raise BadFile(f"malformed: {error}") from None


def write(path, mesh):
    """Writes a Mesh to `path`, and its numbers to the HDF5 file beside it: a grid for each dimension, all with the same
    points. The cells of the highest dimension are the grid "mesh", which DOLFIN takes; those of its boundary are
    "facets", with their tags a second time as FACET_TAGS, since DOLFIN seeks arrays by name in all grids. Names of
    groups are Information of each grid, as meshio reads them: text that is XML itself."""
    named = grouped(mesh)
    mesh = named if named.groups else mesh
    grids = grids_of(mesh)
    data = vtkMultiBlockDataSet()
    names = {}
    for index, grid in enumerate(grids.values()):
        data.SetBlock(index, with_numbered_arrays(grid, names))
    folder, name = os.path.split(os.path.abspath(path))
    check_space(os.path.splitext(path)[0] + ".h5", 1024 * data.GetActualMemorySize() + OVERHEAD)
    writer = vtkXdmfWriter()
    writer.SetInputData(data)
    writer.SetFileName(SERIAL + name)  # Becomes a part of the names of both files, but is none of the HDF5 file's.
    writer.SetLightDataLimit(0)
    with contextlib.chdir(folder):
        if not writer.Write():
            raise OSError("the HDF5 library reports an error")
    os.replace(os.path.join(folder, SERIAL + name), path)
    arrange(path, grids, names, mesh)
    number_mixed_cells(path, grids)


def number_mixed_cells(path, grids):
    """Gives quadrilaterals, and cells of second order, their numbers where they are beside others: VTK's writer has
    wrong ones."""
    for element, grid in zip(parse(path).iter("Grid"), grids.values()):
        topology = element.find("Topology")
        if topology.get("TopologyType") != "Mixed":
            continue
        types = vtk_to_numpy(grid.GetCellTypesArray())
        sizes = np.diff(vtk_to_numpy(grid.GetCells().GetOffsetsArray()))
        starts = np.cumsum([0, *(1 + sizes)])[:-1]
        name, _, inside = topology.find("DataItem").text.rpartition(":")
        with library("h5py").File(os.path.join(os.path.dirname(os.path.abspath(path)), name), "a") as file:
            numbers = file[inside][()]
            numbers[starts] = np.array([NUMBERS.get(kind, 0) for kind in range(256)])[types]
            file[inside][...] = numbers


def check_space(path, size):
    """Throws OSError where the disk cannot take a file of that size: HDF5 would crash at the end of the process."""
    with open(path, "wb") as file:
        try:
            os.posix_fallocate(file.fileno(), 0, size)
        finally:
            os.remove(path)


def grids_of(mesh):
    """{name: vtkUnstructuredGrid}, the cells of the highest dimension first. Points in the plane z = 0 get the array
    PLANE."""
    dimensions, grids = mesh.cell_dimensions(), {}
    tags = mesh.cell_data.get(tag_array(mesh.cell_data))
    points = dict(mesh.point_data)
    if not np.any(mesh.points[:, 2]):
        points[PLANE] = mesh.points[:, :2]
    for dimension in np.unique(dimensions)[::-1].tolist():
        arrays = {name: values[dimensions == dimension] for name, values in mesh.cell_data.items()}
        below = dimensions.max() - dimension
        if below == 1 and tags is not None:
            arrays[FACET_TAGS] = tags[dimensions == dimension]
        name = ("mesh", "facets")[below] if below < 2 else ("vertices", "edges")[dimension]
        blocks = [(kind, corners) for kind, corners in mesh.blocks if TYPES[kind][1] == dimension]
        grids[name] = to_grid(Mesh(mesh.points, blocks, points, arrays))
    return grids


def with_numbered_arrays(grid, names):
    """A copy whose arrays have names that HDF5 takes; `names` gets what they stand for."""
    copy = vtkUnstructuredGrid()
    copy.CopyStructure(grid)
    for source, target in ((grid.GetPointData(), copy.GetPointData()), (grid.GetCellData(), copy.GetCellData())):
        for name, values in arrays_of(source).items():
            number = next((key for key, value in names.items() if value == name), f"array{len(names)}")
            names[number] = name
            target.AddArray(writable(number, values))
    return copy


def writable(name, values):
    """Whole numbers of 64 bits as a vtkIdTypeArray: VTK's writer knows no other array of them. Numbers without a sign
    become floating point numbers where some are too large for it."""
    if values.dtype.kind not in "iu" or values.itemsize < 8:
        return to_vtk(name, values)
    if int(values.max(initial=0)) > np.iinfo(np.int64).max:
        return to_vtk(name, values.astype(float))
    array = numpy_to_vtkIdTypeArray(np.ascontiguousarray(values, np.int64), deep=True)
    array.SetName(name)
    return array


def arrange(path, grids, array_names, mesh):
    """Puts all grids side by side under the domain, as DOLFIN has them, and gives grids, types, arrays and groups their
    names.
    DOLFIN and DOLFINx look at the first array of a grid alone: that is the one of tags."""
    tree = parse(path)
    domain = tree.find("Domain")
    elements = [grid for grid in domain.iter("Grid") if grid.get("GridType") == "Uniform"]
    for child in list(domain):
        domain.remove(child)
    highest = int(mesh.cell_dimensions().max(initial=0))
    dimensions = {"mesh": highest, "facets": highest - 1, "edges": 1, "vertices": 0}
    for grid, (grid_name, data) in zip(elements, grids.items()):
        grid.set("Name", grid_name)
        if data.IsHomogeneous() and data.GetCellType(0) in NAMES:
            grid.find("Topology").set("TopologyType", NAMES[data.GetCellType(0)])
        for attribute in grid.findall("Attribute"):
            name_attribute(attribute, array_names[attribute.get("Name")])
        attributes = {item.get("Name"): item for item in grid.findall("Attribute")}  # Some of points and of cells.
        if PLANE in attributes:
            geometry = grid.find("Geometry")
            geometry.set("GeometryType", "XY")
            geometry[0] = attributes[PLANE].find("DataItem")
            grid.remove(attributes[PLANE])
        for name in (tag_array(mesh.cell_data), FACET_TAGS):
            if name in attributes:
                grid.remove(attributes[name])
                grid.insert(0, attributes[name])
        for item in grid.iter("DataItem"):
            item.text = item.text.strip().removeprefix(SERIAL)
        add_names(grid, mesh.groups, dimensions[grid_name])
        domain.append(grid)
    ElementTree.indent(tree)
    tree.write(path, encoding="utf-8", xml_declaration=True)


def add_names(grid, groups, dimension):
    names = ElementTree.Element("main")
    for name, (tag, of_dimension) in groups.items():
        if of_dimension == dimension:
            ElementTree.SubElement(names, "map", key=name, dim=str(dimension)).text = str(tag)
    if len(names):
        information = ElementTree.SubElement(grid, "Information", Name="groups", Value=str(len(names)))
        information.text = ElementTree.tostring(names, encoding="unicode")


def name_attribute(attribute, name):
    sizes = attribute.find("DataItem").get("Dimensions").split()
    attribute.attrib.pop("Active", None)
    attribute.set("Name", name)
    attribute.set("AttributeType", KINDS.get(int(sizes[1]) if len(sizes) > 1 else 1, "Matrix"))
