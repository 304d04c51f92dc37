"""A small IGES 5.3 writer: fixed 80-column records, numbers to the last bit, the same bytes every time.

Only what the programs of this folder need: entities with numeric parameters and no pointers.
"""

DATA_COLUMNS = 64  # Columns 1 to 64 of a parameter record hold data, 66 to 72 point back to the entity.


def real(value):
    """`value` as an IGES real constant that reads back as the very same double."""
    text = repr(float(value)).upper()
    mantissa, _, exponent = text.partition("E")
    if "." not in mantissa:
        mantissa += "."
    return mantissa + (f"E{int(exponent)}" if exponent else "")


def hollerith(text):
    return f"{len(text)}H{text}"
GEOMETRY, CONSTRUCTION = 0, 6  # Entity use flags: part of the model, or an aid beside it.


class IgesFile:
    """Collects entities, then writes the sections S, G, D, P and T."""

    def __init__(self, name, title):
        self.name = name
        self.title = title
        self.entities = []
        self.largest = 0.0  # Largest absolute coordinate, for the global section.

    def add(self, entity_type, parameters, points, use=GEOMETRY):
        """Adds an independent entity. Integers among `parameters` are written as such, floats as reals;
        `points` are its coordinates, of which only the largest matters here."""
        self.entities.append((entity_type, use, parameters))
        self.largest = max([self.largest] + [abs(float(c)) for point in points for c in point])

    def curve(self, degree, knots, poles, planar_normal=None, rational_weights=None, use=GEOMETRY):
        """Entity 126, a (rational) B-spline curve."""
        weights = rational_weights or [1.0] * len(poles)
        closed = int(poles[0] == poles[-1])
        planar = int(planar_normal is not None)
        head = [len(poles) - 1, degree, planar, closed, int(rational_weights is None), 0]
        body = [float(k) for k in knots] + [float(w) for w in weights] + flat(poles)
        tail = [float(knots[0]), float(knots[-1])] + [float(c) for c in planar_normal or (0, 0, 0)]
        self.add(126, head + body + tail, poles, use)

    def surface(self, degrees, knots_u, knots_v, poles):
        """Entity 128, a polynomial B-spline surface; `poles[j][i]`, i along u, j along v."""
        flattened = [pole for row in poles for pole in row]
        head = [len(poles[0]) - 1, len(poles) - 1, *degrees, 0, 0, 1, 0, 0]
        body = [float(k) for k in [*knots_u, *knots_v]] + [1.0] * len(flattened) + flat(flattened)
        tail = [float(k) for k in (knots_u[0], knots_u[-1], knots_v[0], knots_v[-1])]
        self.add(128, head + body + tail, flattened)

    def write(self, path):
        start = lines([self.title], 72)
        glob = lines([field + "," for field in self.global_fields()[:-1]] + [self.global_fields()[-1] + ";"], 72)
        directory, parameters = [], []
        for entity_type, use, values in self.entities:
            pointer = len(directory) + 1
            fields = [str(entity_type)] + [real(v) if isinstance(v, float) else str(v) for v in values]
            body = lines([field + "," for field in fields[:-1]] + [fields[-1] + ";"], DATA_COLUMNS)
            first = [entity_type, len(parameters) + 1, 0, 0, 0, 0, 0, 0]
            directory.append("".join(f"{value:8d}" for value in first) + f"0000{use:02d}00")
            second = [entity_type, 0, 0, len(body), 0]
            directory.append("".join(f"{value:8d}" for value in second) + " " * 24 + f"{0:8d}")
            parameters += [f"{line:<{DATA_COLUMNS}} {pointer:7d}" for line in body]
        with open(path, "w", encoding="ascii", newline="\n") as file:
            for letter, section in zip("SGDP", (start, glob, directory, parameters)):
                for number, line in enumerate(section, 1):
                    file.write(f"{line:<72}{letter}{number:7d}\n")
            counts = f"S{len(start):7d}G{len(glob):7d}D{len(directory):7d}P{len(parameters):7d}"
            file.write(f"{counts:<72}T{1:7d}\n")

    def global_fields(self):
        name = hollerith(self.name)
        date = hollerith("20260101.000000")  # Fixed, so that the file is the same every time.
        return ["1H,", "1H;", name, name, hollerith("CADRefine"), hollerith("CADRefine"),
                "32", "38", "6", "308", "15", name, "1.", "6", "1HM", "1", "0.", date,
                "1.E-9", real(self.largest), "", "", "11", "0", date, ""]


def flat(points):
    return [float(c) for point in points for c in point]


def lines(fields, width):
    """Fills records of `width` columns without splitting a field (a text field longer than a record is cut)."""
    records = [""]
    for field in fields:
        if records[-1] and len(records[-1]) + len(field) > width:
            records.append("")
        records[-1] += field
        while len(records[-1]) > width:
            records[-1], rest = records[-1][:width], records[-1][width:]
            records.append(rest)
    return records
