"""The tree of nodes that a CGNS file in HDF5 is: each is a group with a label, data, and nodes in it."""

import numpy as np

from cadrefine.formats import BadFile


REGION = "ZoneSubRegion_t"  # The label of a part of a zone.


class Node:
    """The attributes of the group tell its label, its dataset " data" what it holds. A link has " link" instead."""

    def __init__(self, group, name):
        self.name, self.group = name, group
        if not hasattr(group, "keys"):
            raise BadFile(f"{name} is not a node")
        if text(group.attrs.get("type", "")) == "LK":
            try:
                self.group = group[" link"]
            except KeyError:
                raise BadFile(f"{name} is a link to a place or a file that does not exist") from None

    def all(self, label):
        """The nodes in it that have the label, by name."""
        found = [Node(self.group[name], name) for name in self.group if not name.startswith(" ")]
        return [node for node in found if text(node.group.attrs.get("label", "")) == label]

    def has(self, name):
        return name in self.group

    def child(self, name):
        if name not in self.group:
            raise BadFile(f"{self.name} has no {name}")
        return Node(self.group[name], name)

    def data(self):
        """Throws BadFile where there is none."""
        if " data" not in self.group:
            raise BadFile(f"{self.name} is empty")
        return np.ravel(self.group[" data"][()])

    def integers(self):
        return self.data().astype(int)

    def text(self):
        return text(self.data())


def text(value):
    value = value.encode() if isinstance(value, str) else np.asarray(value).tobytes()
    return value.partition(b"\0")[0].decode(errors="replace").strip()
