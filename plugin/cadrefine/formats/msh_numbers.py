"""The numbers in a section of gmsh's .msh files, from text or binary alike."""

import warnings

import numpy as np

from cadrefine.formats import BadFile

FIRST_RUN = 1024  # Rows that are looked at together at first.


class Text:
    """The numbers of a section that is text, one after the other."""

    def __init__(self, content, start, name):
        end = content.find(b"$End" + name, start)
        if end < 0:
            raise BadFile(f"the section {name.decode()} has no end")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                self.values = np.fromstring(content[start:end], sep=" ")
            except DeprecationWarning:
                raise BadFile(f"the section {name.decode()} contains something other than numbers") from None
        self.at, self.name = 0, name

    def take(self, count):
        values = self.values[self.at:self.at + count]
        if len(values) < count:
            raise BadFile(f"the section {self.name.decode()} is cut short")
        self.at += count
        return values

    def integers(self, count):
        return self.take(count).astype(np.int64)

    def ahead(self, count, width):
        """Rows of whole numbers that will come next: as many as there are, at least one, at most `count`."""
        count = min(count, (len(self.values) - self.at) // width)
        if count == 0:
            raise BadFile(f"the section {self.name.decode()} is cut short")
        return self.values[self.at:self.at + count * width].reshape(count, width).astype(np.int64)

    sizes = integers
    doubles = take

    def rows(self, count, *columns):
        """Rows of one or more numbers a column, each column a kind ("i", "n", "d") and how many numbers it has."""
        width = sum(width for _, width in columns)
        table = self.take(count * width).reshape(count, width)
        parts = np.split(table, np.cumsum([width for _, width in columns])[:-1], axis=1)
        return [part if kind == "d" else part.astype(np.int64) for part, (kind, _) in zip(parts, columns)]


class Binary:
    """The same of a section that is binary."""

    KINDS = {"i": "i4", "n": "i8", "d": "f8"}

    def __init__(self, content, start, name, order):
        self.content, self.at, self.name, self.order = content, start, name, order

    def rows(self, count, *columns):
        kind = np.dtype([(f"f{i}", self.order + self.KINDS[k], (width,)) for i, (k, width) in enumerate(columns)])
        if count < 0 or self.at + count * kind.itemsize > len(self.content):
            raise BadFile(f"the section {self.name.decode()} is cut short")
        table = np.frombuffer(self.content, kind, count, self.at)
        self.at += count * kind.itemsize
        return [table[field].astype(float if k == "d" else np.int64)
                for field, (k, _) in zip(kind.names, columns)]

    def ahead(self, count, width):
        count = min(count, (len(self.content) - self.at) // (4 * width))
        if count == 0:
            raise BadFile(f"the section {self.name.decode()} is cut short")
        return np.frombuffer(self.content, self.order + "i4", count * width, self.at).reshape(count, width)

    def integers(self, count):
        return self.rows(1, ("i", count))[0][0]

    def sizes(self, count):
        return self.rows(1, ("n", count))[0][0]

    def doubles(self, count):
        return self.rows(1, ("d", count))[0][0]


def alike(numbers, limit, width, columns):
    """The next rows of that many whole numbers that have the same in `columns`, at most `limit`. The first row of
    another width is seen, as it starts where one of the same width would."""
    window = FIRST_RUN
    while True:
        rows = numbers.ahead(min(window, limit), width)
        same = (rows[:, columns] == rows[0, columns]).all(axis=1)
        if len(rows) < window or not same.all():
            run = len(same) if same.all() else int(np.argmin(same))
            return numbers.integers(run * width).reshape(run, width)
        window *= 2
