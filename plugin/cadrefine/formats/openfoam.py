"""Reads the mesh of an OpenFOAM case, with patches and zones. (VTK's reader has points in single precision alone.)"""

import gzip
import os
import re
import zlib

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.grid import Mesh
from cadrefine.formats.groups import set_groups, unused
from cadrefine.formats.openfoam_cells import cells_of
from cadrefine.parts import polymesh_of

TRIANGLE, QUADRILATERAL = 5, 9  # VTK's types of cells.
HEAD = re.compile(rb"FoamFile\s*\{(.*?)\}", re.DOTALL)
COMMENT = re.compile(rb"//[^\n]*|/\*.*?\*/", re.DOTALL)
START = re.compile(rb"\s*(\d+)\s*([({])")  # Of a list: how many, and the brace of values or of one value for all.


class File:
    """One of the mesh's files: its values from the place `at` on."""

    def __init__(self, folder, name):
        self.name, self.at = name, 0
        self.content = content_of(os.path.join(folder, name))
        head = HEAD.search(self.content)
        if not head:
            raise BadFile(f"constant/polyMesh/{name} is not an OpenFOAM file")
        self.binary = re.search(rb"format\s+binary", head[1]) is not None
        label, scalar = (int(size[1]) if size else default for size, default in
                         ((re.search(rb"label=(\d+)", head[1]), 32), (re.search(rb"scalar=(\d+)", head[1]), 64)))
        self.kinds = {"label": f"<i{label // 8}", "scalar": f"<f{scalar // 8}"}
        self.at = head.end()
        if not self.binary:
            self.content = COMMENT.sub(b" ", self.content)
            self.at = HEAD.search(self.content).end()

    def list(self, kind, width=1):
        """The numbers of the next list, in rows of `width`."""
        while self.binary and (comment := re.compile(rb"\s*//[^\n]*\n").match(self.content, self.at)):
            self.at = comment.end()
        start = START.match(self.content, self.at)
        if not start:
            raise BadFile(f"constant/polyMesh/{self.name} is malformed: a list is missing")
        count = int(start[1])
        self.at = start.end()
        if start[2] == b"{":
            end = self.content.index(b"}", self.at)
            return np.full(count, int(self.content[self.at:end]))
        if self.binary:
            size = count * width * np.dtype(self.kinds[kind]).itemsize
            values = np.frombuffer(self.content[self.at:self.at + size], self.kinds[kind])
            self.at += size + 1
        else:
            values = self.text_values(kind)
        if len(values) != count * width:
            raise BadFile(f"constant/polyMesh/{self.name} is cut short")
        return values.reshape(count, width) if width > 1 else values

    def text_values(self, kind):
        """All numbers up to the end of the list."""
        depth = re.compile(rb"\)\s*(?:;|\Z)").search(self.content, self.at)
        end = depth.start() if depth else len(self.content)
        text = self.content[self.at:end].translate(bytes.maketrans(b"()", b"  "))
        self.at = end + 1
        return np.array(text.split(), dtype=float if kind == "scalar" else int)

    def faces(self):
        """Corners of each face, -1 where there are fewer than the most."""
        if self.binary:
            starts = self.list("label")
            corners = self.list("label")
            sizes = np.diff(starts)
        else:
            count = int(START.match(self.content, self.at)[1])
            self.at = START.match(self.content, self.at).end()
            values, sizes, corners, at = self.text_values("label"), np.zeros(count, int), [], 0
            for face in range(count):
                sizes[face] = values[at]
                corners.append(values[at + 1:at + 1 + sizes[face]])
                at += 1 + sizes[face]
            corners = np.concatenate(corners)
        if min(sizes, default=0) < 0 or sum(sizes) != len(corners):
            raise BadFile("constant/polyMesh/faces is cut short")
        table = np.full((len(sizes), max(sizes, default=0)), -1)
        table[np.arange(table.shape[1]) < sizes[:, np.newaxis]] = corners
        return table

    def entries(self):
        """Pairs of a name and a function that seeks a key in its dictionary."""
        for match in re.finditer(rb"([^\s{}();]+|\"[^\"]*\")\s*\{", self.content[self.at:]):
            start = self.at + match.end()
            end = self.content.find(b"}", start)
            yield match[1].decode(errors="replace").strip('"'), start, end


def content_of(path):
    for name, opener in ((path, open), (path + ".gz", gzip.open)):
        if os.path.isfile(name):
            try:
                with opener(name, "rb") as file:
                    return file.read()
            except (OSError, EOFError, zlib.error) as error:
                raise BadFile(f"{name} cannot be read: {error}") from None
    raise BadFile(f"there is no {path}; if the case is decomposed, run reconstructParMesh first")


def read(path):
    """The Mesh of the cells, and of the faces in patches and zones. Throws BadFile."""
    folder = polymesh_of(path)
    if folder is None:
        raise BadFile("there is no folder constant/polyMesh beside it")
    try:
        return read_folder(folder)
    except (ValueError, IndexError, TypeError) as error:
        raise BadFile(f"malformed: {error}") from None


def read_folder(folder):
    points = File(folder, "points").list("scalar", 3)
    faces = File(folder, "faces").faces()
    owner, neighbour = (File(folder, name).list("label") for name in ("owner", "neighbour"))
    cells = np.concatenate([owner, neighbour])
    if len(owner) != len(faces) or faces.max(initial=-1) >= len(points) or len(neighbour) > len(owner) or not (
            0 <= cells.min(initial=0) <= cells.max(initial=0) < len(faces)):
        raise BadFile("constant/polyMesh/owner, faces and points do not fit together")
    blocks, cell_places = cells_of(faces, owner, neighbour)
    patches = list(patches_of(File(folder, "boundary")))
    members = [(name, 2, np.arange(start, start + count)) for name, _, start, count in patches]
    members += zones_of(folder, "faceZones", b"faceLabels", 2) + zones_of(folder, "cellZones", b"cellLabels", 3)
    in_groups = [numbers for _, dimension, numbers in members if dimension == 2]
    chosen = np.unique(np.concatenate([np.zeros(0, int), *in_groups]))
    chosen = chosen[np.argsort((faces[chosen] >= 0).sum(axis=1), kind="stable")]
    sizes = (faces[chosen] >= 0).sum(axis=1)
    facets = [(kind, faces[chosen[sizes == size], :size]) for kind, size in ((TRIANGLE, 3), (QUADRILATERAL, 4))
              if (sizes == size).any()]
    mesh = Mesh(points, [*facets, *blocks], patch_types={name: kind for name, kind, _, _ in patches})
    place = np.full(len(faces), -1)
    place[chosen] = np.arange(len(chosen))
    rows = []
    for tag, (name, dimension, numbers) in enumerate(members, 1):
        mesh.groups[unused(name, mesh.groups)] = (tag, dimension)
        where = place[numbers] if dimension == 2 else len(chosen) + cell_places[numbers]
        rows.append(np.column_stack([where, np.full(len(numbers), tag)]))
    set_groups(mesh, np.concatenate(rows))
    return mesh


def patches_of(file):
    """Name, type, first face and number of faces of each patch."""
    for name, start, end in file.entries():
        text = file.content[start:end]
        kind, first, count = (re.search(key + rb"\s+([^\s;]+)\s*;", text)
                              for key in (rb"\btype", b"startFace", b"nFaces"))
        if not (kind and first and count):
            raise BadFile("constant/polyMesh/boundary is malformed")
        yield name, kind[1].decode(errors="replace"), int(first[1]), int(count[1])


def zones_of(folder, name, key, dimension):
    """Name, dimension and members of each zone; none where there is no such file."""
    path = os.path.join(folder, name)
    if not (os.path.isfile(path) or os.path.isfile(path + ".gz")):
        return []
    file, zones = File(folder, name), []
    for match in re.finditer(rb"([^\s{}();]+)\s*\{\s*type\s+\w+;\s*" + key + rb"\s+(?:List<label>)?", file.content):
        file.at = match.end()
        zones.append((match[1].decode(errors="replace"), dimension, file.list("label")))
    return zones
