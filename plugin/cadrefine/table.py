"""The convergence table: a row a step, at most 100 columns wide."""

COLUMNS = (  # Two lines of heading, key of the step, width, format.
    ("", "step", "step", 4, "d"),
    ("", "vertices", "vertices", 9, "d"),
    ("", "cells", "cells", 10, "d"),
    ("", "on CAD", "cad_vertices", 8, "d"),
    ("", "projected", "projected_points", 10, "d"),
    ("global", "error", "global_error", 10, ".3e"),
    ("largest", "distance", "maximum_distance", 10, ".3e"),
    ("in-", "valid", "invalid_cells", 6, "d"),
    ("off", "CAD", "unprojected_vertices", 6, "d"),
    ("least", "qual.", "minimum_quality", 6, ".3f"),
)
ALARMS = {"invalid_cells": "red", "unprojected_vertices": "yellow"}  # Colours of what should be 0.


def headings(style):
    """The two lines; `style` is a function of a text and names of styles."""
    first, second = ("".join(f"{column[line]:>{column[3]}}" for column in COLUMNS) for line in (0, 1))
    return [style(f"{first}".rstrip(), "bold"), style(f"{second} seconds method", "bold")]


def row(step, style):
    entries = "".join(entry(step[key], width, kind, style, ALARMS.get(key)) for _, _, key, width, kind in COLUMNS)
    return f"{entries}{sum(step['seconds'].values()):8.2f} {step['method']}"


def entry(value, width, kind, style, alarm):
    """The value, '-' if it is None, with a space before it even where the column is too narrow."""
    text = "-" if value is None else f"{value:{kind}}"
    return " " * max(width - len(text), 1) + style(text, *([alarm] if alarm and value else []))
