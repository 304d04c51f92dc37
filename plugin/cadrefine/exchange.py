"""Puts files that were made in a folder in their places, over what is there."""

import os
import re

# Of an OpenFOAM mesh, also those that would not fit a new one.
MESH_FILES = ("points", "faces", "owner", "neighbour", "boundary", "cellZones", "faceZones", "pointZones", "cellLevel",
              "pointLevel", "level0Edge", "surfaceIndex", "refinementHistory")


def exchange(folder, place):
    """Pairs of paths that put what is in `folder` in place, over what is there: "from", "to" to be renamed, "from", ""
    to be removed, "", "to" for a folder to be made. Where the result is several files, the one that names the others
    goes first and comes last, so that it never names files of two runs."""
    target, last = os.path.split(os.path.abspath(place))
    found = [os.path.relpath(os.path.join(inside, name), folder) for inside, _, names in os.walk(folder)
             for name in names]
    actions = []
    if len(found) > 1:
        actions += [(path, "") for path in (place, *pieces_of(place)) if os.path.exists(path)]
    for name in sorted(found, key=lambda name: (name == last, name)):
        actions += [("", os.path.join(target, inside)) for inside in folders_of(name)]
        actions.append((os.path.join(folder, name), os.path.join(target, name)))
    return actions


def carry_out(actions):
    for source, target in actions:
        if not target:
            os.remove(source)
        elif not source:
            os.makedirs(target, exist_ok=True)
        else:
            os.replace(source, target)


def folders_of(name):
    """The folders of a name, the outermost first."""
    parts = os.path.dirname(name).split("/")
    return ["/".join(parts[:count]) for count in range(1, len(parts) + 1) if parts[0]]


def pieces_of(place):
    """The pieces that the .pvtu file at `place` names, the mesh of the case of a .foam file, and nothing else of the
    user's."""
    if place.endswith(".foam"):
        folder = os.path.join(os.path.dirname(os.path.abspath(place)), "constant", "polyMesh")
        return [path for path in (os.path.join(folder, name + packed) for name in MESH_FILES for packed in ("", ".gz"))
                if os.path.isfile(path)]
    if not place.endswith(".pvtu") or not os.path.isfile(place):
        return []
    with open(place, encoding="utf-8", errors="replace") as file:
        named = re.findall(r'<Piece\s+Source="([^"]*)"', file.read())
    folder = os.path.basename(place)[: -len(".pvtu")]
    pieces = [os.path.join(os.path.dirname(os.path.abspath(place)), piece) for piece in named
              if re.fullmatch(re.escape(f"{folder}/{folder}_") + r"\d+\.vtu", piece)]
    return [path for path in pieces if os.path.isfile(path)]
