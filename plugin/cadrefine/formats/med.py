"""Reads and writes MED files, of SALOME and code_aster, with groups. (meshio leaves the corners of cells in VTK's
order, which is the opposite of MED's, and makes no groups of families.)"""

import numpy as np

from cadrefine.formats import BadFile, library
from cadrefine.formats.cells import TURNED, TYPES, reordered, turned_where_negative
from cadrefine.formats.grid import Mesh, check, in_space
from cadrefine.formats.groups import grouped, set_groups, sets_of_groups, unused

VTK_TYPES = {"PO1": 1, "SE2": 3, "SE3": 21, "TR3": 5, "TR6": 22, "QU4": 9, "QU8": 23, "TE4": 10, "T10": 24, "HE8": 12,
             "H20": 25, "PE6": 13, "P15": 26, "PY5": 14, "P13": 27}
MED_TYPES = {vtk: med for med, vtk in VTK_TYPES.items()}
# Those that have nodes on sides or inside too: how many, and what they are without.
REDUCED = {"TR7": (7, 22), "QU9": (9, 23), "H27": (27, 25), "P18": (18, 26)}
MESH = "mesh"
STEP = "-0000000000000000001-0000000000000000001"  # Of a mesh that does not change.
PROFILE = np.bytes_("MED_NO_PROFILE_INTERNAL")
NAME, FAMILY_NAME = 80, 64  # Bytes of the names of groups and of families.


def read(path):
    """The only mesh of the file. Throws BadFile."""
    h5py = library("h5py")
    try:
        with h5py.File(path, "r") as file:
            return read_file(file)
    except (OSError, RuntimeError, KeyError, ValueError, IndexError, TypeError) as error:  # Of h5py and numpy.
        raise BadFile(f"malformed: {' '.join(str(error).split())}") from None


def read_file(file):
    names = list(file["ENS_MAA"]) if "ENS_MAA" in file else []
    if len(names) != 1:
        raise BadFile(f"it holds {len(names)} meshes ({', '.join(names)}); save one alone" if names else
                      "it holds no mesh")
    space = int(file["ENS_MAA"][names[0]].attrs["ESP"])
    step = file["ENS_MAA"][names[0]]
    step = step if "NOE" in step else step[sorted(step)[0]]
    coordinates = step["NOE/COO"][()]
    mesh = Mesh(in_space(coordinates.reshape((-1, space), order="F")), [])
    families = []
    for name, cells in step.get("MAI", {}).items():
        if name not in VTK_TYPES and name not in REDUCED:
            raise BadFile(f"it holds cells of MED's type {name}")
        size, kind = REDUCED[name] if name in REDUCED else (TYPES[VTK_TYPES[name]][2], VTK_TYPES[name])
        corners = cells["NOD"][()].reshape((-1, size), order="F")[:, :TYPES[kind][2]].astype(int) - 1
        mesh.blocks.append((kind, corners))
        families.append(cells["FAM"][()] if "FAM" in cells else np.zeros(len(corners), int))
    check(mesh)
    # Volume cells are the other way round, but for those of meshio.
    mesh.blocks = [(kind, turned_where_negative(mesh.points, kind, reordered(kind, corners, TURNED)))
                   for kind, corners in mesh.blocks]
    groups = groups_of_families(file["FAS"][names[0]].get("ELEME", {}) if names[0] in file.get("FAS", {}) else {})
    add_groups(mesh, groups, np.concatenate(families))
    return mesh


def groups_of_families(families):
    """{number: names of its groups}."""
    groups = {}
    for family in families.values():
        names = family["GRO/NOM"][()] if "GRO" in family else []
        groups[int(family.attrs["NUM"])] = [bytes(np.asarray(row, np.int8).view(np.uint8)).partition(b"\0")[0]
                                            .decode(errors="replace").strip() for row in names]
    return groups


def add_groups(mesh, groups, families):
    """A name of groups of several dimensions goes to the highest of them."""
    names = list(dict.fromkeys(name for _, of_family in sorted(groups.items(), reverse=True) for name in of_family))
    dimensions, rows = mesh.cell_dimensions(), []
    found = {name: set() for name in names}
    for family in np.unique(families):
        cells = np.flatnonzero(families == family)
        for name in groups.get(int(family), []):
            found[name] |= set(dimensions[cells].tolist())
            rows.append(np.column_stack([cells, np.full(len(cells), names.index(name) + 1)]))
    for tag, name in enumerate(names, 1):
        for dimension in sorted(found[name], reverse=True):
            wanted = name if name not in mesh.groups else f"{name} of dimension {dimension}"
            mesh.groups[unused(wanted, mesh.groups)] = (tag, dimension)
    if rows:
        set_groups(mesh, np.concatenate(rows))


def write(path, mesh):
    h5py = library("h5py")
    mesh = grouped(mesh)
    numbers, sets = sets_of_groups(mesh)
    dimensions = mesh.cell_dimensions()
    names = {pair: name for name, pair in mesh.groups.items()}
    kinds, place = np.unique(np.column_stack([dimensions, numbers]), axis=0, return_inverse=True)
    members = [[names[tag, int(dimension)] for tag in sets[number]] for dimension, number in kinds]
    families = np.cumsum([1 if of_set else 0 for of_set in members]) * [-1 if of_set else 0 for of_set in members]
    with h5py.File(path, "w") as file:
        attributes(file.create_group("INFOS_GENERALES"), MAJ=3, MIN=0, REL=0)  # SALOME 8 reads no later version.
        root = file.create_group(f"ENS_MAA/{MESH}")
        attributes(root, DIM=int(dimensions.max()), ESP=3, REP=0, UNT="", UNI="", SRT=1, TYP=0, DES="",
                   NOM="".join(f"{axis:<16}" for axis in "XYZ"))
        step = root.create_group(STEP)
        attributes(step, CGT=1, NDT=-1, NOR=-1, PDT=-1.0)
        write_nodes(step, mesh.points)
        write_cells(step, mesh, families[place.ravel()].astype(np.int32))
        root = file.create_group(f"FAS/{MESH}")
        attributes(root.create_group("FAMILLE_ZERO"), NUM=0)
        for number, of_set in zip(families, members):
            if of_set:
                write_family(root, int(number), of_set)


def attributes(target, **values):
    for name, value in values.items():
        if isinstance(value, str):
            value = np.bytes_(value)
        target.attrs.create(name, np.int32(value) if isinstance(value, int) else value)


def dataset(group, name, values, count):
    attributes(group.create_dataset(name, data=values), CGT=1, NBR=count)


def write_nodes(step, points):
    nodes = step.create_group("NOE")
    attributes(nodes, CGT=1, CGS=1, PFL=PROFILE)
    dataset(nodes, "COO", points.astype(float).flatten(order="F"), len(points))


def write_cells(step, mesh, families):
    root, first = step.create_group("MAI"), 0
    attributes(root, CGT=1)
    for kind, corners in mesh.blocks:
        cells = root.create_group(MED_TYPES[kind])
        attributes(cells, CGT=1, CGS=1, PFL=PROFILE)
        nodes = 1 + reordered(kind, corners, TURNED).astype(np.int32)
        dataset(cells, "NOD", nodes.flatten(order="F"), len(corners))
        dataset(cells, "FAM", families[first:first + len(corners)], len(corners))
        first += len(corners)


def write_family(root, number, names):
    name = f"FAM_{number}_{'_'.join(names)}".replace("/", "_").encode()[:FAMILY_NAME].decode(errors="ignore")
    family = root.create_group(f"ELEME/{name}")
    attributes(family, NUM=number)
    group = family.create_group("GRO")
    attributes(group, NBR=len(names))
    table = np.zeros((len(names), NAME), np.int8)
    for row, of_group in zip(table, names):
        text = of_group.encode()[:NAME - 1]
        row[:len(text)] = np.frombuffer(text, np.int8)
    group.create_dataset("NOM", (len(names),), dtype=f"{NAME}int8")[:] = table
