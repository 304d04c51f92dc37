"""The pages of the documentation: their blocks, headings, links and tables."""

import dataclasses
import os
import re

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DOCS = os.path.join(ROOT, "docs")
FENCE = re.compile(r"^ {0,3}```(\w*)\s*$")
HEADING = re.compile(r"^#+ +(.*?) *$")
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+)\)")


@dataclasses.dataclass
class Block:
    language: str
    first: int  # Line of the opening fence, from 1.
    lines: list


class Page:
    def __init__(self, path):
        self.path = path
        self.name = os.path.relpath(path, ROOT)
        with open(path, encoding="utf-8") as file:
            self.lines = file.read().split("\n")
        self.blocks, self.prose = [], []  # `prose`: lines outside of blocks, with their numbers.
        self.take_apart()

    def take_apart(self):
        block = None
        for number, line in enumerate(self.lines, 1):
            fence = FENCE.match(line)
            if fence and block:
                block = None
            elif fence:
                block = Block(fence.group(1), number, [])
                self.blocks.append(block)
            elif block:
                block.lines.append(line)
            else:
                self.prose.append((number, line))

    def links(self):
        """Line, whether it is a picture, and target of each link."""
        for number, line in self.prose:
            for picture, text, target in LINK.findall(re.sub(r"`[^`]*`", "", line)):
                yield number, bool(picture), target
                for inner, _, inner_target in LINK.findall(text):  # A picture that is a link.
                    yield number, bool(inner), inner_target

    def anchors(self):
        """What headings are called in links, by GitHub's rule."""
        result = set()
        for _, line in self.prose:
            heading = HEADING.match(line)
            if heading:
                text = re.sub(r"[^\w\- ]", "", heading.group(1).lower())
                result.add(text.replace(" ", "-"))
        return result

    def section(self, title):
        """Lines of the section of this title."""
        inside, result = False, []
        for _, line in self.prose:
            heading = HEADING.match(line)
            if heading:
                inside = heading.group(1) == title
            elif inside:
                result.append(line)
        return result


def table_rows(lines):
    """Rows of the tables in `lines`, without their heads: lists of texts."""
    rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines if line.startswith("|")]
    rules = [i for i, row in enumerate(rows) if all(re.fullmatch(r":?-+:?", cell) for cell in row)]
    heads = {i - 1 for i in rules} | set(rules)
    return [row for i, row in enumerate(rows) if i not in heads]


def all_pages():
    found = [os.path.join(ROOT, name) for name in os.listdir(ROOT) if name.endswith(".md")]
    found.append(os.path.join(ROOT, "data", "README.md"))
    for folder, _, names in os.walk(DOCS):
        found += [os.path.join(folder, name) for name in names if name.endswith(".md")]
    return [Page(path) for path in sorted(found)]


def pictures():
    for folder, _, names in os.walk(DOCS):
        yield from (os.path.join(folder, name) for name in names if name.endswith((".png", ".svg", ".jpg", ".gif")))
