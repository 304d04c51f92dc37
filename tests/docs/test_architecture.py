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


class Architecture(unittest.TestCase):
    def test_drawing_shows_what_is_linked(self):
        self.assertGreaterEqual(len(linked()), 9)
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
