"""The files that a mesh file names: the pieces of .pvtu and .pvtp, the blocks of .vtm, the data of .xdmf, the mesh of
an OpenFOAM case."""

import html
import os
import re

# By the endings of a file, where the names of others stand in it.
NAMES = {
    (".pvtu", ".pvtp"): r'<Piece\s[^>]*?\bSource\s*=\s*"([^"]*)"',
    (".vtm", ".vtmb", ".vtpd", ".vtpc", ".pvd"): r'<DataSet\s[^>]*?\bfile\s*=\s*"([^"]*)"',
    (".xdmf", ".xmf"): r">\s*([^<>]+):[^<>:]*<",
}


def parts_of(path):
    """Paths of the files that the file `path` names, each once. It can be read."""
    polymesh = polymesh_of(path)
    if polymesh:
        return sorted(os.path.join(polymesh, name) for name in os.listdir(polymesh))
    found = {}
    for endings, pattern in NAMES.items():
        if path.lower().endswith(endings):
            with open(path, encoding="utf-8", errors="replace") as file:
                for name in re.findall(pattern, file.read()):
                    found[os.path.join(os.path.dirname(path), html.unescape(name))] = None
    return list(found)


def polymesh_of(path):
    """The folder polyMesh of an OpenFOAM case: of its .foam file, its folder, or that folder itself; else None."""
    if path.endswith(".foam"):
        path = os.path.dirname(os.path.abspath(path))
    inside = os.path.join(path, "constant", "polyMesh")
    is_polymesh = os.path.basename(os.path.abspath(path)) == "polyMesh" and os.path.isdir(path)
    return inside if os.path.isdir(inside) else path if is_polymesh else None


def all_files_of(path):
    """`path`, the files that it names, those that these name, and so on."""
    files = [path]
    for file in files:
        if os.path.exists(file):
            files += [part for part in parts_of(file) if part not in files]
    return files
