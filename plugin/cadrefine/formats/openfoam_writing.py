"""Writes the mesh of an OpenFOAM case: patches, zones of cells and of faces."""

import os

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.cells import LINEAR
from cadrefine.formats.grid import PHYSICAL
from cadrefine.formats.groups import NAME, group_names, grouped
from cadrefine.formats.sides import sides_of, tagged

FOLDER = "constant/polyMesh"
FILES = ("points", "faces", "owner", "neighbour", "boundary", "cellZones", "faceZones")
TYPES = ("wall", "symmetry", "symmetryPlane")  # Of patches, which need nothing but their name.
HEADER = """FoamFile
{{
    version 2.0;
    format ascii;
    class {};
    location "constant/polyMesh";
    object {};
}}
"""


def check(mesh):
    """Throws BadFile where the format cannot hold the mesh."""
    dimensions = mesh.cell_dimensions()
    if dimensions.max(initial=0) < 3:
        raise BadFile("OpenFOAM meshes have volume cells only; extrude the mesh by one layer first")
    if any(kind in LINEAR for kind, _ in mesh.blocks):
        raise BadFile("OpenFOAM has no quadratic cells")


def write(path, mesh):
    """The files of the case `path`, a .foam file. Each face of the boundary is in a patch, that of its first group;
    groups of faces between cells become zones of faces, those of cells zones of cells."""
    check(mesh)
    mesh = grouped(mesh)
    first = int((mesh.cell_dimensions() < 3).sum())  # Blocks are ordered by type, volume cells are the last ones.
    sides = sides_of(mesh)
    tags = tagged(mesh, sides)
    inside = sides.neighbours >= 0
    order = np.lexsort((sides.neighbours, sides.cells, np.where(inside, 0, tags), ~inside))
    patches = [(name, order[~inside[order] & (tags[order] == tag)]) for tag, name in group_names(mesh, 2, NAME).items()]
    patches = [(name, faces) for name, faces in patches if len(faces)]
    order = np.concatenate([order[:inside.sum()], *(faces for _, faces in patches)])

    folder = os.path.join(os.path.dirname(path), *FOLDER.split("/"))
    os.makedirs(folder, exist_ok=True)
    with open(path, "w", encoding="ascii"):
        pass
    note = (f"nPoints: {len(mesh.points)} nCells: {int((mesh.cell_dimensions() == 3).sum())} nFaces: {len(order)} "
            f"nInternalFaces: {int(inside.sum())}")
    write_list(folder, "points", "vectorField", mesh.points, "(%.17g %.17g %.17g)")
    write_faces(folder, sides.corners[order])
    write_list(folder, "owner", "labelList", sides.cells[order] - first, "%d", note)
    write_list(folder, "neighbour", "labelList", sides.neighbours[order[:inside.sum()]] - first, "%d", note)
    write_patches(folder, patches, int(inside.sum()), mesh.patch_types)
    zones = {name: np.flatnonzero(mesh.cell_data[PHYSICAL][first:] == tag)
             for tag, name in group_names(mesh, 3, NAME).items()}
    write_zones(folder, "cellZones", "cellZone", "cellLabels", zones)
    zones = {name: np.flatnonzero(inside[order] & (tags[order] == tag)) for tag, name in
             group_names(mesh, 2, NAME).items()}
    write_zones(folder, "faceZones", "faceZone", "faceLabels", zones)


def open_file(folder, name, kind, note=""):
    file = open(os.path.join(folder, name), "w", encoding="ascii")
    head = HEADER.format(kind, name)
    file.write(head.replace("    location", f'    note "{note}";\n    location') if note else head)
    return file


def write_list(folder, name, kind, rows, row_format, note=""):
    with open_file(folder, name, kind, note) as file:
        file.write(f"{len(rows)}\n(\n")
        np.savetxt(file, rows, row_format)
        file.write(")\n")


def write_faces(folder, corners):
    """Of triangles and quadrilaterals, in their order."""
    sizes = (corners >= 0).sum(axis=1)
    lines = np.empty(len(corners), object)
    for size in np.unique(sizes):
        text = f"{size}({' '.join(['%d'] * size)})\n"
        lines[sizes == size] = [text % tuple(row) for row in corners[sizes == size, :size].tolist()]
    with open_file(folder, "faces", "faceList") as file:
        file.write(f"{len(corners)}\n(\n")
        file.writelines(lines)
        file.write(")\n")


def write_patches(folder, patches, start, types):
    """Patches have the type that they came with, if they can."""
    with open_file(folder, "boundary", "polyBoundaryMesh") as file:
        file.write(f"{len(patches)}\n(\n")
        for name, faces in patches:
            kind = types.get(name) if types.get(name) in TYPES else "patch"
            file.write(f"{name}\n{{\n    type {kind};\n    nFaces {len(faces)};\n    startFace {start};\n}}\n")
            start += len(faces)
        file.write(")\n")


def write_zones(folder, name, kind, labels, zones):
    """Without zones the file says so: one of an earlier mesh would not fit."""
    zones = {zone: members for zone, members in zones.items() if len(members)}
    with open_file(folder, name, "regIOobject") as file:
        file.write(f"{len(zones)}\n(\n")
        for zone, members in zones.items():
            file.write(f"{zone}\n{{\n    type {kind};\n    {labels} List<label>\n{len(members)}\n(\n")
            np.savetxt(file, members, "%d")
            file.write(")\n;\n")
            if kind == "faceZone":
                file.write(f"    flipMap List<bool> {len(members)}{{0}};\n")
            file.write("}\n")
        file.write(")\n")
