#!/usr/bin/python3
"""Draws drag and geometric error of each round, with CAD and without: plot.py FOLDER FILE.png, FOLDER that of drag.py."""

import json
import os
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot


def load(folder, name):
    with open(os.path.join(folder, name + ".json"), encoding="utf-8") as file:
        return json.load(file)


def main():
    folder, picture = sys.argv[1:]
    figure, (drag, error) = pyplot.subplots(1, 2, figsize=(9.0, 3.8), layout="constrained")
    for name, label, style in (("with_cad", "with CAD", "o-"), ("without_cad", "without CAD", "s--")):
        rows = load(folder, name)
        cells = [row["cells"] for row in rows]
        drag.plot(cells, [row["drag_coefficient"] for row in rows], style, label=label)
        error.loglog(cells, [row["global_error"] for row in rows], style, label=label)
    drag.set_xscale("log")
    drag.set_ylabel("drag coefficient")
    error.set_ylabel("volume between mesh and CAD")
    for axes in (drag, error):
        axes.set_xlabel("cells")
        axes.grid(True, which="both", linewidth=0.3)
        axes.legend()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main()
