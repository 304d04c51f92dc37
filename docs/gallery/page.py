"""What docs/gallery.md says, case by case, and how pictures and figures get there."""

import os
import re

from PIL import Image

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PAGE = os.path.join(ROOT, "docs", "gallery.md")
IMAGES = os.path.join(ROOT, "docs", "images")
BEFORE_AFTER = os.path.join(IMAGES, "before_after.png")
SCALE = 2  # How many times smaller pictures are in the pages.
BAR_SHARE = 0.16  # Of the width of the driver's pictures: the colour bar, on the left.
FIRST_PAGE = "linkrods"  # The case whose two pictures, side by side, README.md begins with.

SECTION = re.compile(r"^## (?P<name>\w+): (?P<title>.*)\n(?P<text>(?:(?!^## ).*\n)*)", re.MULTILINE)
BLOCK = re.compile(r"^```console\n(.*?)^```$", re.MULTILINE | re.DOTALL)
TABLE = re.compile(r"^\| step \|.*\n(?:\|.*\n)*", re.MULTILINE)

COLUMNS = (  # Heading, key of the step, format.
    ("step", "step", "d"),
    ("vertices", "vertices", ",d"),
    ("cells", "cells", ",d"),
    ("error", "global_error", ".2e"),
    ("largest distance", "maximum_distance", ".1e"),
    ("off the CAD", "unprojected_vertices", "d"),
    ("invalid cells", "invalid_cells", "d"),
    ("least quality", "minimum_quality", ".2f"),
)


class Case:
    def __init__(self, section):
        self.name = section["name"]
        self.title = section["title"]
        lines = BLOCK.search(section["text"])[1].replace("\\\n", " ").splitlines()
        self.commands = [" ".join(line.split()) for line in lines]


def read():
    with open(PAGE, encoding="utf-8") as file:
        return file.read()


def cases():
    """The cases by name, in the page's order."""
    return {section["name"]: Case(section) for section in SECTION.finditer(read())}


def publish(run, report, seconds):
    """Puts the pictures of a run beside the page, and its figures into it; `seconds` are those of the processor."""
    for name in sorted(os.listdir(run.path(""))):
        if name.endswith(".png") and name != "both.png":
            shrink(run.path(name), os.path.join(IMAGES, f"gallery_{run.case.name}_{name}"))
    if run.case.name == FIRST_PAGE:
        shrink(run.path("both.png"), BEFORE_AFTER)

    def with_figures(section):
        if section["name"] != run.case.name:
            return section[0]
        return TABLE.sub(lambda _: table(report, seconds), section[0], count=1)

    text = SECTION.sub(with_figures, read())
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(text)


def side_by_side(first, last, path):
    """Two pictures of the driver with the colour bar once: they have the same one."""
    with Image.open(first) as left, Image.open(last) as right:
        right = right.crop((round(BAR_SHARE * right.width), 0, right.width, right.height))
        both = Image.new("RGB", (left.width + right.width, left.height), "white")
        both.paste(left, (0, 0))
        both.paste(right, (left.width, 0))
    both.save(path)


def shrink(picture, path):
    with Image.open(picture) as image:
        size = image.width // SCALE, image.height // SCALE
        image.convert("RGB").resize(size, Image.Resampling.LANCZOS).save(path, optimize=True)


def table(report, seconds):
    """First and last step."""
    steps = report["steps"][0], report["steps"][-1]
    headings = [heading if heading != "error" else f"error ({report['error_measure']})" for heading, _, _ in COLUMNS]
    first, last = ([format(step[key], style) for _, key, style in COLUMNS] for step in steps)
    rows = [*headings, "processor seconds"], ["---"] * (len(COLUMNS) + 1), [*first, ""], [*last, f"{seconds:.1f}"]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)
