"""Reads Nastran's bulk data. (meshio wants a line BEGIN BULK, and loses nodes of elements that go on without a mark, of
which gmsh writes neither.)"""

import re

from cadrefine.formats import BadFile
from cadrefine.formats.bulk import Bulk
from cadrefine.formats.cells import LAYERED, inverse

REFERENCE = "nastran:ref"  # Cell array, as meshio names it: the property of each element.
PYRAMIDS = {5: 14, 13: 27}
SOLIDS = {"CTETRA": {4: 10, 10: 24}, "CPENTA": {6: 13, 15: 26}, "CHEXA": {8: 12, 20: 25}, "CPYRAM": PYRAMIDS,
          "CPYRA": PYRAMIDS}
SHELLS = {"CTRIA3": 5, "CTRIAR": 5, "CPLSTS3": 5, "CPLSTN3": 5, "CTRIA6": 22, "CPLSTS6": 22, "CPLSTN6": 22, "CQUAD4": 9,
          "CQUADR": 9, "CPLSTS4": 9, "CPLSTN4": 9, "CQUAD8": 23, "CPLSTS8": 23, "CPLSTN8": 23, "CQUAD": 23}
LINES = ("CROD", "CTUBE", "CBAR", "CBEAM")
SIZES = {5: 3, 22: 6, 9: 4, 23: 8}
ORDERS = inverse(LAYERED)
NO_EXPONENT = re.compile(r"(?<=[\d.])([+-]\d)")  # Nastran writes 1.5-3 for 1.5E-3.
NAME = re.compile(r"\$HMNAME\s+(?:COMP|PROP)\s+(\d+)\s*\"([^\"]+)\"")  # As HyperMesh names components.


def read(path):
    """The Mesh; names of properties are those of HyperMesh's comments. Throws BadFile."""
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = file.read().splitlines()
    bulk, names = Bulk(), dict(match.groups() for match in map(NAME.match, lines) if match)
    for number, fields in cards(lines):
        try:
            add_card(bulk, fields)
        except (ValueError, IndexError) as error:
            raise BadFile(f"line {number} is malformed: {error}") from None
    mesh = bulk.mesh(REFERENCE)
    dimensions = mesh.cell_dimensions()
    for tag, name in names.items():
        inside = mesh.cell_data[REFERENCE] == int(tag)
        if inside.any():
            mesh.groups[name] = (int(tag), int(dimensions[inside].max()))
    return mesh


def cards(lines):
    """Number of the first line, and fields, of each card with the lines that continue it."""
    card, first = [], 0
    start = next((number for number, line in enumerate(lines, 1) if line.upper().startswith("BEGIN BULK")), 0)
    for number, line in enumerate(lines[start:], start + 1):
        line = line.split("$")[0].expandtabs(8).rstrip()
        if not line or line.startswith("#"):
            continue
        if line.upper().startswith("ENDDATA"):
            break
        fields = fields_of(line)
        if line[0] in "+*, ":
            card += fields[1:]
            continue
        if card:
            yield first, card
        card, first = fields, number
    if card:
        yield first, card


def fields_of(line):
    """Without the mark of continuation at the end."""
    if "," in line:
        return [field.strip() for field in line.split(",")][:9]
    if "*" in line[:8]:
        return [line[:8].strip(), *(line[start:start + 16].strip() for start in range(8, 72, 16))]
    return [line[start:start + 8].strip() for start in range(0, 72, 8)]


def add_card(bulk, fields):
    name = fields[0].rstrip("*").upper()
    if name == "GRID":
        if fields[2] not in ("", "0"):
            raise BadFile(f"node {fields[1]} is in a coordinate system of its own; save nodes in the basic one")
        bulk.add_node(int(fields[1]), [real(text) for text in (fields[3:6] + ["", "", ""])[:3]])
    elif name == "INCLUDE":
        raise BadFile("it includes another file; merge both into one")
    elif name in SOLIDS or name in SHELLS or name in LINES:
        nodes = [int(field) for field in fields[3:] if field] if name in SOLIDS else fields[3:]
        kind = kind_of(name, nodes)
        nodes = nodes if name in SOLIDS else [int(field) for field in nodes[:SIZES.get(kind, 2)]]
        nodes = [nodes[place] for place in ORDERS[kind]] if kind in ORDERS else nodes
        bulk.add_element(int(fields[1]), kind, nodes, int(fields[2] or 0))


def kind_of(name, nodes):
    if name in LINES:
        return 3
    if name in SHELLS:
        return SHELLS[name]
    if len(nodes) not in SOLIDS[name]:
        raise BadFile(f"holds elements {name} of {len(nodes)} nodes")
    return SOLIDS[name][len(nodes)]


def real(text):
    return float(NO_EXPONENT.sub(r"e\1", text.upper().replace("D", "E"))) if text else 0.0
