#!/usr/bin/python3
"""The drawing docs/images/architecture.dot shows the libraries that CMake links, and the SVG file is made from it.

usage: test_architecture.py LINKS   (lines of a library and those that it links, written by CMakeLists.txt)
"""

import os
import re
import sys
import unittest

import pages

IMAGES = os.path.join(pages.DOCS, "images")
LIBRARY = re.compile(r"CADRefine(?!Warnings)[A-Z]\w*")


def reached(links):
    """All libraries that each one sees, also through others."""
    result = {name: set(seen) for name, seen in links.items()}
    for _ in links:
        for seen in result.values():
            seen.update(*[result.get(name, set()) for name in list(seen)])
    return result


def linked():
    links = {}
    with open(LINKS, encoding="utf-8") as file:
        for line in file:
            name, *others = LIBRARY.findall(line.replace("::", ""))
            links[name] = set(others) - {name}
    return links


def drawn():
    links = {}
    with open(os.path.join(IMAGES, "architecture.dot"), encoding="utf-8") as file:
        text = file.read()
    for name in re.findall(r"^ *(CADRefine\w+) \[label", text, re.MULTILINE):
        links[name] = set()
    for name, other in re.findall(r"^ *(CADRefine\w+) -> (CADRefine\w+)\s*$", text, re.MULTILINE):
        links[name].add(other)
    return links


def library_of(path):
    """The library of a file below geom/ or filters/, such as CADRefineFiltersMesh of filters/mesh/CellReading.h."""
    top, *folders, _ = path.split("/")
    half = "Filters" if top == "filters" else ""
    return f"CADRefine{half}{folders[0].capitalize() if folders else ''}"


def included():
    """Libraries whose headers the sources of each library include."""
    seen = {}
    for top in ("geom", "filters"):
        for folder, _, names in os.walk(os.path.join(pages.ROOT, top)):
            for name in names:
                if not name.endswith((".h", ".cxx")):
                    continue
                path = os.path.join(folder, name)
                library = library_of(os.path.relpath(path, pages.ROOT))
                with open(path, encoding="utf-8") as file:
                    text = file.read()
                others = [f"geom/{header}" for header in re.findall(r"#include <cadrefine/(.*)>", text)]
                others += [f"filters/{header}" for header in re.findall(r'#include "(.*)"', text)]
                seen.setdefault(library, set()).update(map(library_of, others))
    return seen


class Architecture(unittest.TestCase):
    def test_sources_include_what_is_linked(self):
        links = reached(linked())
        self.assertEqual(sorted(included()), sorted(links))
        for library, others in included().items():
            self.assertEqual(others - {library} - links[library], set(), library)

    def test_drawing_shows_what_is_linked(self):
        self.assertGreaterEqual(len(linked()), 20)
        self.assertEqual(reached(drawn()), reached(linked()))

    def test_arrows_go_down_only(self):
        for name, seen in reached(linked()).items():
            self.assertNotIn(name, seen, f"{name} sees itself")

    def test_picture_has_each_library(self):
        with open(os.path.join(IMAGES, "architecture.svg"), encoding="utf-8") as file:
            picture = file.read()
        self.assertEqual({f"<title>{name}</title>" in picture for name in drawn()}, {True})
        arrows = re.findall(r"<title>(CADRefine\w+)&#45;&gt;(CADRefine\w+)</title>", picture)
        self.assertEqual(sorted(arrows), sorted((name, other) for name, seen in drawn().items() for other in seen))


LINKS = sys.argv.pop(1)
unittest.main()
