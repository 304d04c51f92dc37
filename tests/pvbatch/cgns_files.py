"""Writes CGNS files: with the CGNS library, as most programs do, and by the letter of the format, for what the library
would not write."""

import ctypes
import ctypes.util
import os

import h5py
import numpy as np

TYPES = {3: 3, 5: 5, 10: 10}  # CGNS's numbers of VTK's types.
MIXED, NGON = 20, 22
BASE, ZONE = "Base", "Base/Zone"


class Library:
    """A file that the CGNS library writes, with one base."""

    UNSTRUCTURED, DOUBLE, FAMILY_SPECIFIED = 3, 4, 13
    LOCATIONS = {"Vertex": 2, "CellCenter": 3, "FaceCenter": 4}
    SETS = {"PointList": 2, "PointRange": 4}

    def __init__(self, path, dimension=3):
        self.library = ctypes.CDLL(ctypes.util.find_library("cgns"))
        self.library.cg_get_error.restype = ctypes.c_char_p
        with open("/usr/include/cgnstypes.h", encoding="ascii") as file:
            wide = any(line.split() == ["#define", "CG_BUILD_64BIT", "1"] for line in file)
        self.integer = np.int64 if wide else np.int32
        self.call("cg_set_file_type", 2)  # HDF5
        self.file = self.made("cg_open", os.fsencode(path), 1)
        self.base = self.made("cg_base_write", self.file, BASE.encode(), dimension, 3)
        self.zone = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.call("cg_close", self.file)

    def call(self, function, *arguments):
        arguments = [argument.ctypes if isinstance(argument, np.ndarray) else argument for argument in arguments]
        if getattr(self.library, function)(*arguments):
            raise RuntimeError(f"{function}: {self.library.cg_get_error().decode()}")

    def made(self, function, *arguments):
        """The index of what it makes."""
        index = ctypes.c_int()
        self.call(function, *arguments, ctypes.byref(index))
        return index.value

    def integers(self, values):
        return np.ascontiguousarray(values, dtype=self.integer)

    def add_zone(self, name, points, cells):
        """`cells` are those of the highest dimension."""
        self.zone = self.made("cg_zone_write", self.file, self.base, name.encode(),
                              self.integers([len(points), cells, 0]), self.UNSTRUCTURED)
        for axis, values in zip("XYZ", points.T):
            self.made("cg_coord_write", self.file, self.base, self.zone, self.DOUBLE, b"Coordinate" + axis.encode(),
                      np.array(values, float))

    def add_section(self, name, kind, first, corners):
        """Elements of one type, numbered from `first` on; corners from 0 on. Returns the next number."""
        end = first + len(corners)
        self.made("cg_section_write", self.file, self.base, self.zone, name.encode(), kind, first, end - 1, 0,
                  self.integers(corners + 1))
        return end

    def add_mixed(self, name, blocks):
        """Elements of several types, numbered from 1 on: pairs of type and corners."""
        rows = [np.concatenate([[kind], row + 1]) for kind, corners in blocks for row in corners]
        offsets = np.cumsum([0, *(len(row) for row in rows)])
        self.made("cg_poly_section_write", self.file, self.base, self.zone, name.encode(), MIXED, 1, len(rows), 0,
                  self.integers(np.concatenate(rows)), self.integers(offsets))

    def add_condition(self, name, location, kind, numbers, family=None):
        place = self.file, self.base, self.zone
        index = self.made("cg_boco_write", *place, name.encode(), self.FAMILY_SPECIFIED, self.SETS[kind], len(numbers),
                          self.integers(numbers))
        self.call("cg_boco_gridlocation_write", *place, index, self.LOCATIONS[location])
        if family:
            self.call("cg_goto", self.file, self.base, b"Zone_t", self.zone, b"ZoneBC_t", 1, b"BC_t", index, b"end")
            self.call("cg_famname_write", family.encode())

    def add_zone_family(self, family):
        self.call("cg_goto", self.file, self.base, b"Zone_t", self.zone, b"end")
        self.call("cg_famname_write", family.encode())

    def add_family(self, name, inner):
        index = self.made("cg_family_write", self.file, self.base, name.encode())
        for of_family in inner:
            self.call("cg_family_name_write", self.file, self.base, index, of_family.encode(), of_family.encode())

    def add_solution(self, name, location, arrays):
        place = self.file, self.base, self.zone
        index = self.made("cg_sol_write", *place, name.encode(), self.LOCATIONS[location])
        for of_array, values in arrays.items():
            self.made("cg_field_write", *place, index, self.DOUBLE, of_array.encode(), np.array(values, float))


def write_as_gmsh(path, mesh):
    """A grid.Mesh with gmsh's numbers of entities and groups, as gmsh writes it: for each entity that is in a group a
    section, a condition on its elements, and a family, in which there are the names of its groups."""
    from cadrefine.formats.groups import members

    dimensions, entities = mesh.cell_dimensions(), mesh.cell_data["gmsh:geometrical"]
    inside = {name: members(mesh, name) for name in mesh.groups}
    with Library(path) as file:
        chosen = np.any(list(inside.values()), axis=0)
        file.add_zone("boxes_Part0", mesh.points, int((chosen & (dimensions == 3)).sum()))
        first_cell, number = 0, 1
        for kind, corners in mesh.blocks:
            cells = first_cell + np.arange(len(corners))
            first_cell += len(corners)
            for entity in np.unique(entities[cells[chosen[cells]]]):
                of_entity = cells[entities[cells] == entity]
                name = f"{'PLSV'[dimensions[of_entity[0]]]}_{entity}"
                after = file.add_section(f"{kind}_{name}", TYPES[kind], number, corners[entities[cells] == entity])
                file.add_condition(name, "CellCenter", "PointRange", [number, after - 1], name)
                file.add_family(name, [group for group in mesh.groups if inside[group][of_entity[0]]])
                number = after


def add_node(parent, name, label, data=None):
    """A node of the tree that a CGNS file is; the root's name is /."""
    node = parent if name == "/" else parent.create_group(name)
    node.attrs["name"], node.attrs["label"] = np.bytes_(name.ljust(33, "\0")), np.bytes_(label.ljust(33, "\0"))
    node.attrs["type"] = np.bytes_("MT" if data is None else "C1")
    if isinstance(data, str):
        data = np.frombuffer(data.encode(), np.int8)
    if data is not None:
        node.create_dataset(" data", data=data)
    return node


def write_by_hand(path, points, sections, conditions=()):
    """Sections are name, CGNS's type and corners from 0 on; conditions name, location (or None), and numbers from 1 on.
    Coordinates have single precision, and indices 64 bits."""
    with h5py.File(path, "w") as file:
        add_node(file, "/", "Root Node of HDF5 File")
        base = add_node(file, BASE, "CGNSBase_t", np.int32([points.shape[1], points.shape[1]]))
        zone = add_node(base, "Zone", "Zone_t", np.int64([[len(points)], [len(sections[0][2])], [0]]))
        add_node(zone, "ZoneType", "ZoneType_t", "Unstructured")
        grid = add_node(zone, "GridCoordinates", "GridCoordinates_t")
        for axis, values in zip("XYZ", points.T):
            add_node(grid, "Coordinate" + axis, "DataArray_t", np.float32(values))
        first = 1
        for name, kind, corners in sections:
            section = add_node(zone, name, "Elements_t", np.int32([kind, 0]))
            add_node(section, "ElementRange", "IndexRange_t", np.int64([first, first + len(corners) - 1]))
            add_node(section, "ElementConnectivity", "DataArray_t", np.int64(corners).ravel() + 1)
            first += len(corners)
        boundary = add_node(zone, "ZoneBC", "ZoneBC_t")
        for name, location, numbers in conditions:
            condition = add_node(boundary, name, "BC_t", "BCWall")
            add_node(condition, "PointList", "IndexArray_t", np.int64(numbers)[:, np.newaxis])
            if location:
                add_node(condition, "GridLocation", "GridLocation_t", location)
