"""What is wrong with the options, found before any work is done."""

import argparse
import contextlib
import math
import os

from cadrefine import output, session
from cadrefine.display import check_display
from cadrefine.parts import all_files_of
from cadrefine.session import Failure

RESULTS = {"output": output.FORMATS, "report": (".json",), "plot": (".png",), "screenshot": (".png",),
           "screenshot_start": (".png",)}  # Options that name files to write, and how these end.
DEEPEST = 8  # Recursion depth that CADGeometricError takes.
MOST_STEPS = 1_000_000
MOST_CELLS = 2**63 - 1
FARTHEST = 1e51  # The filters refuse coordinates beyond 1.5e51.


def whole(lowest, highest):
    """The type of an option that takes whole numbers of this range."""
    def parse(text):
        is_whole = text.isascii() and text.isdecimal() and len(text) <= len(str(highest))
        if not is_whole or not lowest <= int(text) <= highest:
            raise argparse.ArgumentTypeError(f"{text[:40]!r} is not a whole number from {lowest} to {highest}")
        return int(text)
    return parse


def number(text, lowest=-math.inf, highest=math.inf):
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or not lowest <= value <= highest:
        unbounded = "" if lowest == -math.inf else f" of {lowest:g} or more"
        wanted = unbounded if highest == math.inf else f" from {lowest:g} to {highest:g}"
        raise argparse.ArgumentTypeError(f"{text[:40]!r} is not a finite number{wanted}")
    return value


def names(text):
    """A list, of names that commas part."""
    parts = text.split(",")
    if "" in parts:
        raise argparse.ArgumentTypeError(f"{text[:40]!r} contains an empty name")
    return parts


def positive(text):
    return number(text, 0)


def coordinate(text):
    return number(text, -FARTHEST, FARTHEST)


def part(text):
    return number(text, 0, 1)


def angle(text):
    return number(text, 0, 180)


def check_box(name, box):
    """`box` is x0, x1, y0, y1, z0, z1, or None."""
    for axis, lower, upper in zip("XYZ", box[0::2], box[1::2]) if box else ():
        if lower > upper:
            raise Failure(f"{name}: the box is empty, since {axis}0 is {lower:g} and {axis}1 is {upper:g}")


def check_fraction(name, strategy, value):
    if strategy != "threshold" and value is not None and not 0 < value <= 1:
        raise Failure(f"{name}: {value:g} is not a fraction above 0 and at most 1")


def option_of(name):
    return "--" + name.replace("_", "-")


def check(options):
    """Finds what is wrong before any work is done."""
    if (options.indicator is None) != (options.indicator_threshold is None):
        raise Failure("--indicator and --indicator-threshold must be given together")
    if options.indicator_marking != "threshold" and options.indicator is None:
        raise Failure(f"--indicator-marking {options.indicator_marking} needs an --indicator")
    if options.marking == "threshold" and options.threshold is None:
        raise Failure("--marking threshold needs a --threshold")
    if options.marking == "off" and options.threshold is not None:
        raise Failure("--threshold cannot be combined with --marking off")
    check_fraction("--threshold", options.marking or "threshold", options.threshold)
    check_fraction("--indicator-threshold", options.indicator_marking, options.indicator_threshold)
    if options.projected and options.region:
        raise Failure("--region cannot be combined with --projected, which skips the projection")
    check_box("--region", options.region)
    check_box("--focus", options.focus)
    if options.view and not any(options.view):
        raise Failure("--view: 0 0 0 is not a direction")
    for path in (options.mesh, options.cad, options.compare_report):
        if path:
            session.check_readable(path)
    for name, allowed in RESULTS.items():
        if getattr(options, name):
            session.check_writable(getattr(options, name), allowed)
    if options.output:
        output.check(options.output, options.quadratic)
    check_places(options)
    if options.screenshot or options.screenshot_start:
        check_display()


def check_places(options):
    """No result is a file that is read, or another result, under whatever name."""
    read = {"MESH": all_files_of(options.mesh), "CAD": [options.cad], "--compare-report": [options.compare_report]}
    others = [(path, name) for name, paths in read.items() for path in paths if path]
    for name in RESULTS:
        place = getattr(options, name)
        if not place:
            continue
        for path in output.files_of(place):
            for other, reader in others:
                if is_same(path, other) and reader in read:
                    raise Failure(f"{place}: {option_of(name)} would replace {other}, which {reader} reads; choose "
                                  "another name")
                if is_same(path, other):
                    raise Failure(f"{place}: is given twice, by {reader} and {option_of(name)}")
        others += [(path, option_of(name)) for path in output.files_of(place)]


def is_same(path, other):
    """Also where a link leads there, or the file has two names."""
    with contextlib.suppress(OSError):
        return os.path.samefile(path, other)
    return os.path.realpath(path) == os.path.realpath(other)
