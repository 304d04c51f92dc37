"""Meshes and arrays between the files of CADRefine (.vtu) and legacy DOLFIN, on any number of ranks.

DOLFIN shares the cells out as it likes. Its global numbers of vertices and cells are those of the file, however, so
arrays are exchanged by these numbers.
"""

import os

import dolfin as df
import meshio
import numpy as np

COMM = df.MPI.comm_world
TAGS = "gmsh:physical"  # Cell array of the file: tags of the boundary's triangles.


def read_file(path):
    """The file's mesh with tetrahedra and tagged triangles, on every rank: a meshio.Mesh."""
    return meshio.read(path)


def tetrahedra(file):
    """Corners of the file's tetrahedra: (cells, 4) integers."""
    return file.cells_dict["tetra"].astype(np.int64)


def distributed_mesh(file, path):
    """The file's tetrahedra as a df.Mesh in pieces; `path` is a .xdmf file to write in between."""
    if COMM.rank == 0:
        with df.XDMFFile(df.MPI.comm_self, path) as xdmf:
            xdmf.write(serial_mesh(file.points, tetrahedra(file)))
    COMM.barrier()
    df.parameters["ghost_mode"] = "shared_facet"  # Integrals over inner facets need the cells on both sides.
    mesh = df.Mesh(COMM)
    with df.XDMFFile(COMM, path) as xdmf:
        xdmf.read(mesh)
    return mesh


def serial_mesh(points, cells):
    mesh = df.Mesh(df.MPI.comm_self)
    editor = df.MeshEditor()
    editor.open(mesh, "tetrahedron", 3, 3)
    editor.init_vertices(len(points))
    editor.init_cells(len(cells))
    for number, point in enumerate(points):
        editor.add_vertex(number, point)
    for number, cell in enumerate(cells):
        editor.add_cell(number, cell)
    editor.close()
    return mesh


def facet_tags(mesh, file, tags):
    """`tags` of the file's triangles, (triangles,), on the facets of `mesh`, 0 elsewhere: a df.MeshFunction."""
    mesh.init(2, 0)
    numbers = mesh.topology().global_indices(0)
    facets = numbers[np.array(mesh.topology()(2, 0)()).reshape(-1, 3)]
    keys, wanted = (row_keys(rows, len(file.points)) for rows in (file.cells_dict["triangle"], facets))
    order = np.argsort(keys)
    place = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    result = df.MeshFunction("size_t", mesh, 2, 0)
    result.array()[:] = np.where(keys[order][place] == wanted, tags[order][place], 0)
    return result


def row_keys(rows, count):
    """One integer for each row of three numbers below `count`, whatever their order in the row."""
    rows = np.sort(rows.astype(np.int64), axis=1)
    return (rows[:, 0] * count + rows[:, 1]) * count + rows[:, 2]


def to_function(values, function):
    """Sets `function`, linear with c components, to `values` at the file's vertices: (vertices, c)."""
    space = function.function_space()
    mesh = space.mesh()
    local = function.vector().get_local()
    dofs = df.vertex_to_dof_map(space)
    owned = dofs < len(local)
    local[dofs[owned]] = values[mesh.topology().global_indices(0)].ravel()[owned]
    function.vector().set_local(local)
    function.vector().apply("insert")


def from_function(function, file):
    """Values of `function`, linear with c components, at the file's vertices: (vertices, c) on rank 0."""
    mesh = function.function_space().mesh()
    values = function.compute_vertex_values(mesh).reshape(-1, mesh.num_vertices()).T
    return gathered(mesh.topology().global_indices(0), values, len(file.points))


def from_cells(function, file):
    """Values of `function`, constant in each cell, in the file's tetrahedra: (tetrahedra,) on rank 0."""
    space = function.function_space()
    mesh = space.mesh()
    own = mesh.topology().ghost_offset(3)  # Cells of this rank come before those of others.
    values = function.vector().get_local()[space.dofmap().dofs(mesh, 3)[:own]]
    return gathered(mesh.topology().global_indices(3)[:own], values, len(tetrahedra(file)))


def gathered(numbers, values, count):
    pieces = COMM.gather((numbers, values))
    if COMM.rank != 0:
        return None
    result = np.empty((count, *values.shape[1:]))
    for piece_numbers, piece in pieces:
        result[piece_numbers] = piece
    return result


def write_file(path, file, point_arrays, indicator):
    """Writes the file's mesh, tags and places on the CAD again, with new arrays at points, and a value a
    tetrahedron, `indicator`. For one rank."""
    blocks = [("triangle", file.cells_dict["triangle"]), ("tetra", tetrahedra(file))]
    tags = [file.cell_data_dict[TAGS]["triangle"], np.zeros(len(blocks[1][1]), dtype=np.int32)]
    kept = {name: values for name, values in file.point_data.items() if name.startswith("CAD")}
    mesh = meshio.Mesh(file.points, blocks, point_data={**kept, **point_arrays},
                       cell_data={TAGS: tags, "indicator": [np.zeros(len(tags[0])), indicator]})
    mesh.write(path + ".part", file_format="vtu")
    os.replace(path + ".part", path)
