"""What is wrong with the options, found before any work is done."""

import argparse
import math
import os

import cadrefine_output as output
import cadrefine_session as session
from cadrefine_display import check_display
from cadrefine_session import Failure

RESULTS = {"output": output.FORMATS, "report": (".json",), "plot": (".png",), "screenshot": (".png",),
           "screenshot_start": (".png",)}  # Options that name files to write, and how these end.
DEEPEST = 8  # Recursion depth that CADGeometricError takes.


def natural(text):
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text} is not a number of 0 or more")
    return int(text)


def depth(text):
    if not text.isdecimal() or not 1 <= int(text) <= DEEPEST:
        raise argparse.ArgumentTypeError(f"{text} is not a number from 1 to {DEEPEST}")
    return int(text)


def number(text):
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise argparse.ArgumentTypeError(f"{text} is not a number")
    return value


def limit(text):
    value = number(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"{text} is not a number of 0 or more")
    return value


def check_box(name, box):
    """`box` is x0, x1, y0, y1, z0, z1, or None."""
    for axis, lower, upper in zip("XYZ", box[0::2], box[1::2]) if box else ():
        if lower > upper:
            raise Failure(f"{name}: the box is empty, since {axis}0 is {lower:g} and {axis}1 is {upper:g}")


def check_fraction(name, strategy, value):
    if strategy != "threshold" and value is not None and not 0 < value <= 1:
        raise Failure(f"{name}: {value:g} is not a part above 0 and at most 1")


def option_of(name):
    return "--" + name.replace("_", "-")


def check(options):
    """Finds what is wrong before any work is done."""
    if (options.indicator is None) != (options.indicator_threshold is None):
        raise Failure("--indicator and --indicator-threshold go together")
    if options.indicator_marking != "threshold" and options.indicator is None:
        raise Failure(f"--indicator-marking {options.indicator_marking} needs an --indicator")
    if options.marking != "threshold" and options.threshold is None:
        raise Failure(f"--marking {options.marking} needs a --threshold")
    check_fraction("--threshold", options.marking, options.threshold)
    check_fraction("--indicator-threshold", options.indicator_marking, options.indicator_threshold)
    if options.projected and options.region:
        raise Failure("--region is for projecting, which --projected leaves out")
    check_box("--region", options.region)
    check_box("--focus", options.focus)
    if options.view and not any(options.view):
        raise Failure("--view: 0 0 0 is no direction")
    for path in (options.mesh, options.cad, options.compare_report):
        if path:
            session.check_readable(path)
    places = {}
    for name, allowed in RESULTS.items():
        place = getattr(options, name)
        if place:
            session.check_writable(place, allowed)
            other = places.setdefault(os.path.realpath(place), name)
            if other != name:
                raise Failure(f"{place}: is given twice, by {option_of(other)} and {option_of(name)}")
    if options.screenshot or options.screenshot_start:
        check_display()
