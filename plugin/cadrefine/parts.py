"""The files that a mesh file names: the pieces of .pvtu and .pvtp, the blocks of .vtm, the data of .xdmf."""

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
    found = {}
    for endings, pattern in NAMES.items():
        if path.lower().endswith(endings):
            with open(path, encoding="utf-8", errors="replace") as file:
                for name in re.findall(pattern, file.read()):
                    found[os.path.join(os.path.dirname(path), html.unescape(name))] = None
    return list(found)


def all_files_of(path):
    """`path`, the files that it names, those that these name, and so on."""
    files = [path]
    for file in files:
        if os.path.isfile(file):
            files += [part for part in parts_of(file) if part not in files]
    return files
