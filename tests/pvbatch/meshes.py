"""Meshes of one body in the formats of other programs, written by these where they are at hand."""

import os
import subprocess
import sys

import cgns_files
import driver
import gmsh
import meshio
import numpy as np
from scipy.io import netcdf_file

sys.path.insert(0, os.path.join(driver.ROOT, "plugin"))

from cadrefine.formats.groups import members

BODY, WALL, ENDS, RIM = 10, 20, 21, 30  # Tags of the physical groups.
GROUPS = {"solid body": (BODY, 3), "wall": (WALL, 2), "ends": (ENDS, 2), "rim": (RIM, 1)}

DOLFIN = """
import sys
import dolfin as df
mesh = df.Mesh()
folder = sys.argv[1]
with df.XDMFFile(folder + "/tetrahedra.xdmf") as file:
    file.read(mesh)
tags = df.MeshFunction("size_t", mesh, 2, 0)
df.CompiledSubDomain("on_boundary && x[2] < 0.02").mark(tags, 5)
tags.rename("tags", "tags")
with df.XDMFFile(folder + "/dolfin.xdmf") as file:
    file.write(mesh)
    file.write(tags)
with df.XDMFFile(folder + "/square.xdmf") as file:
    file.write(df.UnitSquareMesh(3, 3))
"""
DOLFINX = """
import sys
import dolfinx
import numpy as np
from dolfinx import fem
from dolfinx.io import XDMFFile
from dolfinx.mesh import create_unit_cube, locate_entities, meshtags
from mpi4py import MPI

def tags_of(name, dimension, *places):
    found = [locate_entities(mesh, dimension, where) for where, _ in places]
    values = np.repeat(np.int32([tag for _, tag in places]), [len(entities) for entities in found])
    order = np.argsort(np.concatenate(found))
    tags = meshtags(mesh, dimension, np.concatenate(found)[order], values[order])
    tags.name = name
    return tags

mesh = create_unit_cube(MPI.COMM_WORLD, 2, 2, 2)
mesh.topology.create_connectivity(2, 3)
space = fem.functionspace if hasattr(fem, "functionspace") else fem.FunctionSpace
height = fem.Function(space(mesh, ("Lagrange", 1)))
height.name = "height"
height.interpolate(lambda x: x[2])
volume = fem.Function(space(mesh, ("DG", 0)))
volume.name = "volume"
volume.x.array[:] = 1 / 48
geometry = [] if dolfinx.__version__ < "0.7" else [mesh.geometry]
with XDMFFile(MPI.COMM_WORLD, sys.argv[1] + "/dolfinx.xdmf", "w") as file:
    file.write_mesh(mesh)
    file.write_function(height, 0.0)
    file.write_function(height, 1.0)
    file.write_function(volume, 0.0)
    file.write_meshtags(tags_of("layers", 3, (lambda x: x[2] < 0.6, 3), (lambda x: x[2] > 0.4, 4)), *geometry)
    file.write_meshtags(tags_of("below", 2, (lambda x: np.isclose(x[2], 0), 1)), *geometry)
    file.write_meshtags(tags_of("above", 2, (lambda x: np.isclose(x[2], 1), 2)), *geometry)
"""


def counts(mesh):
    """{(name, dimension): number of cells}."""
    return {(name, dimension): int(members(mesh, name).sum()) for name, (_, dimension) in mesh.groups.items()}


def write_gmsh(cad, folder):
    """The body of a CAD file in the formats that gmsh writes. Part of the walls belongs to no group."""
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.importShapes(cad)
        gmsh.model.occ.synchronize()
        faces = [tag for _, tag in gmsh.model.getEntities(2)]
        edges = [tag for _, tag in gmsh.model.getEntities(1)]
        members = {"solid body": [1], "wall": faces[:2], "ends": faces[3:], "rim": edges[:1]}
        for name, (tag, dimension) in GROUPS.items():
            gmsh.model.addPhysicalGroup(dimension, members[name], tag)
            gmsh.model.setPhysicalName(dimension, tag, name)
        gmsh.option.setNumber("Mesh.MeshSizeMin", 0.6)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.8)
        gmsh.model.mesh.generate(3)
        for version, binary in ((2.2, 0), (2.2, 1), (4.1, 0), (4.1, 1)):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            gmsh.write(os.path.join(folder, f"gmsh{version:.0f}{'binary' if binary else 'text'}.msh"))
        gmsh.option.setNumber("Mesh.Binary", 0)
        for ending in ("mesh", "inp", "vtk", "su2"):
            gmsh.write(os.path.join(folder, "gmsh." + ending))
        gmsh.model.mesh.setOrder(2)
        gmsh.option.setNumber("Mesh.SaveElementTagType", 2)
        for ending in ("msh", "unv", "bdf"):
            gmsh.write(os.path.join(folder, "order2." + ending))
        gmsh.model.mesh.setOrder(1)
        gmsh.option.setNumber("Mesh.SaveAll", 1)  # In this file, some cells belong to no group.
        gmsh.model.addPhysicalGroup(2, faces[:1], 22)  # And some to two.
        gmsh.model.setPhysicalName(2, 22, "first wall")
        gmsh.write(os.path.join(folder, "all.msh"))
    finally:
        gmsh.finalize()


def write_meshio(folder):
    """The same, from gmsh's file, as XDMF in text and in HDF5, and Netgen."""
    mesh = meshio.gmsh.read(os.path.join(folder, "gmsh2text.msh"))
    meshio.write(os.path.join(folder, "text.xdmf"), mesh, data_format="XML")
    meshio.write(os.path.join(folder, "mixed.xdmf"), mesh)
    alone = meshio.Mesh(mesh.points, {"tetra": mesh.cells_dict["tetra"]},
                        cell_data={"gmsh:physical": [mesh.get_cell_data("gmsh:physical", "tetra")]})
    for name in ("tetrahedra.xdmf", "meshio.vol"):
        meshio.write(os.path.join(folder, name), alone)


def write_dolfin(folder):
    """Tetrahedra, and in a second grid tags of all faces: 5 below, 0 on the others; and a square of triangles."""
    subprocess.run([sys.executable, "-c", DOLFIN, folder], check=True, capture_output=True)


def write_dolfinx(folder):
    """A cube of tetrahedra with tags of cells, tags of facets twice (1 below; 2 above), a function at two times, and
    one that is constant in each cell."""
    subprocess.run([sys.executable, "-c", DOLFINX, folder], check=True, capture_output=True)


def write_exodus(folder):
    """Two element blocks and a side set, by the letter of the format (netCDF 3)."""
    mesh = meshio.gmsh.read(os.path.join(folder, "gmsh2text.msh"))
    cells, triangles = mesh.cells_dict["tetra"] + 1, mesh.cells_dict["triangle"] + 1
    blocks = cells[:100], cells[100:]
    wall = triangles[mesh.get_cell_data("gmsh:physical", "triangle") == WALL]
    sides = sides_of(cells, wall)
    with netcdf_file(os.path.join(folder, "exodus.ex2"), "w", version=2) as file:
        file.api_version = file.version = np.float32(5)
        file.floating_point_word_size, file.file_size, file.title = np.int32(8), np.int32(1), "test"
        file.createDimension("time_step", None)
        sizes = {"len_string": 33, "len_line": 81, "len_name": 33, "four": 4, "num_dim": 3,
                 "num_nodes": len(mesh.points), "num_elem": len(cells), "num_el_blk": 2, "num_side_sets": 1,
                 "num_side_ss1": len(sides)}
        for number, block in enumerate(blocks, 1):
            sizes.update({f"num_el_in_blk{number}": len(block), f"num_nod_per_el{number}": 4})
        for name, size in sizes.items():
            file.createDimension(name, size)
        file.createVariable("time_whole", "d", ("time_step",))
        for axis, values in zip("xyz", mesh.points.T):
            file.createVariable("coord" + axis, "d", ("num_nodes",))[:] = values
        add_names(file, "eb", "num_el_blk", {1: "steel", 2: "air"})
        add_names(file, "ss", "num_side_sets", {7: "wall"})
        for number, block in enumerate(blocks, 1):
            table = file.createVariable(f"connect{number}", "i", (f"num_el_in_blk{number}", f"num_nod_per_el{number}"))
            table[:] = block
            table.elem_type = "TETRA"
        for name, values in zip(("elem_ss1", "side_ss1"), sides.T):
            file.createVariable(name, "i", ("num_side_ss1",))[:] = values
    return {1: len(blocks[0]), 2: len(blocks[1]), 7: len(wall)}


def add_names(file, kind, dimension, names):
    ids = file.createVariable(kind + "_prop1", "i", (dimension,))
    ids[:] = list(names)
    ids.name = "ID"
    file.createVariable(kind + "_status", "i", (dimension,))[:] = 1
    table = file.createVariable(kind + "_names", "c", (dimension, "len_name"))
    for row, name in enumerate(names.values()):
        table[row] = np.array(list(name.ljust(33, "\0")), "S1")


def sides_of(cells, triangles):
    """Number of the tetrahedron and of its side, both from 1, for each triangle."""
    corners = [[0, 1, 3], [1, 2, 3], [0, 2, 3], [0, 1, 2]]  # Exodus's sides 1 to 4.
    found = {}
    for side, chosen in enumerate(corners, 1):
        for cell, triple in enumerate(np.sort(cells[:, chosen], axis=1).tolist(), 1):
            found[tuple(triple)] = cell, side
    return np.array([found[tuple(triple)] for triple in np.sort(triangles, axis=1).tolist()])


def write_ball(folder):
    """A ball of radius 1 about the origin, by gmsh."""
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addSphere(0, 0, 0, 1)
        gmsh.model.occ.synchronize()
        gmsh.write(os.path.join(folder, "ball.brep"))
        gmsh.option.setNumber("Mesh.MeshSizeMin", 0.7)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.7)
        gmsh.model.mesh.generate(3)
        gmsh.write(os.path.join(folder, "ball.msh"))
    finally:
        gmsh.finalize()


def write_cgns(folder):
    """Each group of gmsh's file as a section with a boundary condition, by the CGNS library."""
    mesh = meshio.gmsh.read(os.path.join(folder, "gmsh2text.msh"))
    kinds = {1: ("line", 3), 2: ("triangle", 5), 3: ("tetra", 10)}
    with cgns_files.Library(os.path.join(folder, "gmsh.cgns")) as file:
        file.add_zone("cylinder", mesh.points, len(mesh.cells_dict["tetra"]))
        first = 1
        for name, (tag, dimension) in GROUPS.items():
            kind, number = kinds[dimension]
            cells = mesh.cells_dict[kind][mesh.get_cell_data("gmsh:physical", kind) == tag]
            after = file.add_section(f"elements of {name}", number, first, cells)
            file.add_condition(name, "CellCenter", "PointRange", [first, after - 1])
            first = after


def build_options():
    """What gmsh was built with: words."""
    gmsh.initialize()
    try:
        return gmsh.option.getString("General.BuildOptions").split()
    finally:
        gmsh.finalize()


def write_boxes(path):
    """Two boxes that share a face, of steel and air; "wall" is one side of both, "contact" between them, "low" also one
    of the sides of "wall". The other facets are in no group."""
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.addBox(0, 0, 1, 1, 1, 1)
        gmsh.model.occ.fragment([(3, 1)], [(3, 2)])
        gmsh.model.occ.synchronize()
        centres = {tag: gmsh.model.occ.getCenterOfMass(2, tag) for _, tag in gmsh.model.getEntities(2)}
        wall = [tag for tag, centre in centres.items() if centre[0] < 0.01]
        contact = [tag for tag, centre in centres.items() if abs(centre[2] - 1) < 0.01]
        for dimension, tag, name, entities in ((3, 1, "steel", [1]), (3, 2, "air", [2]), (2, 5, "wall", wall),
                                               (2, 6, "contact", contact), (2, 7, "low", wall[:1])):
            gmsh.model.addPhysicalGroup(dimension, entities, tag)
            gmsh.model.setPhysicalName(dimension, tag, name)
        gmsh.option.setNumber("Mesh.SaveAll", 1)
        gmsh.option.setNumber("Mesh.MeshSizeMin", 0.5)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
        gmsh.model.mesh.generate(3)
        gmsh.write(path)
    finally:
        gmsh.finalize()


def write_mixed(path, path_2, lid=True, complete=False):
    """Boxes side by side: one of hexahedra, one of wedges; with `lid`, two of tetrahedra above them, and pyramids where
    hexahedra and tetrahedra meet. All have a volume of 1. Some facets are in a group: "floor", "roof", "contact"
    (between the boxes and what is above them), and of the lower boxes "left", "right", "front" and "back". Also of
    second order, `complete` with nodes on sides and inside. Returns {(name, dimension): number of cells}. (gmsh 4.8
    makes pyramids once in a process, and crashes then.)"""
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        geometry = gmsh.model.geo
        corners = [geometry.addPoint(x, y, 0, 0.4) for x, y in ((0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1))]
        around = [geometry.addLine(corners[i - 1], corners[i]) for i in (1, 2, 3, 4, 5, 0)]
        between = geometry.addLine(corners[1], corners[4])
        loops = [[around[0], between, *around[4:]], [*around[1:4], -between]]
        floor = [geometry.addPlaneSurface([geometry.addCurveLoop(loop)]) for loop in loops]
        for curve in (*around, between):
            geometry.mesh.setTransfiniteCurve(curve, 4)
        geometry.mesh.setTransfiniteSurface(floor[0])
        geometry.mesh.setRecombine(2, floor[0])
        layers = geometry.extrude([(2, surface) for surface in floor], 0, 0, 1, numElements=[2], recombine=True)
        contact = [layers[place - 1] for place, (dimension, _) in enumerate(layers) if dimension == 3]
        above = geometry.extrude(contact, 0, 0, 1) if lid else []
        geometry.synchronize()
        boxes, tetrahedra = ([tag for dimension, tag in made if dimension == 3] for made in (layers, above))
        roof = [above[place - 1][1] for place, (dimension, _) in enumerate(above) if dimension == 3]
        groups = {("hexahedra", 3): boxes[:1], ("wedges", 3): boxes[1:], ("above", 3): tetrahedra, ("floor", 2): floor,
                  ("contact", 2): [tag for _, tag in contact], ("roof", 2): roof}
        extents = {tag: gmsh.model.getBoundingBox(2, tag) for _, tag in gmsh.model.getEntities(2)}
        for name, axis, place in (("left", 0, 0), ("right", 0, 2), ("front", 1, 0), ("back", 1, 1)):
            groups[name, 2] = [tag for tag, extent in extents.items() if extent[5] < 1.1 and
                               max(abs(extent[axis] - place), abs(extent[axis + 3] - place)) < 0.1]
        groups = {pair: entities for pair, entities in groups.items() if entities}
        for (name, dimension), entities in groups.items():
            gmsh.model.setPhysicalName(dimension, gmsh.model.addPhysicalGroup(dimension, entities), name)
        gmsh.model.mesh.generate(3)
        gmsh.write(path)
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", int(not complete))
        gmsh.model.mesh.setOrder(2)
        gmsh.write(path_2)
        return {(name, dimension): sum(len(ids) for entity in entities
                                       for ids in gmsh.model.mesh.getElements(dimension, entity)[1])
                for (name, dimension), entities in groups.items()}
    finally:
        gmsh.finalize()


def write_two_ways(path, path_2):
    """Two squares side by side: quadrilaterals that turn clockwise, triangles that do not; of second order as well."""
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        geo = gmsh.model.geo
        corners = [geo.addPoint(x, y, 0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (2, 1))]
        lines = [geo.addLine(corners[a], corners[b])
                 for a, b in ((0, 1), (1, 2), (2, 3), (3, 0), (1, 4), (4, 5), (5, 2))]
        left = geo.addPlaneSurface([geo.addCurveLoop([-line for line in reversed(lines[:4])])])
        geo.addPlaneSurface([geo.addCurveLoop([*lines[4:], -lines[1]])])
        geo.mesh.setTransfiniteSurface(left)
        geo.mesh.setRecombine(2, left)
        geo.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.3)
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        gmsh.model.mesh.generate(2)
        gmsh.write(path)
        gmsh.model.mesh.setOrder(2)
        gmsh.write(path_2)
    finally:
        gmsh.finalize()


def write_plane(folder):
    """A square in the plane z = 0, with tagged sides, by gmsh."""
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addDisk(0, 0, 0, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [1], 3)
        gmsh.model.addPhysicalGroup(1, [1], 4)
        gmsh.model.setPhysicalName(1, 4, "rim")
        gmsh.option.setNumber("Mesh.MeshSizeMin", 0.5)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
        gmsh.model.mesh.generate(2)
        gmsh.write(os.path.join(folder, "disc.msh"))
        gmsh.write(os.path.join(folder, "disc.brep"))
    finally:
        gmsh.finalize()
