"""The options of the driver, and what is wrong with them before any work is done."""

import argparse
import math

import cadrefine_pictures as pictures
import cadrefine_session as session
from cadrefine_pipeline import METHODS, STRATEGIES
from cadrefine_session import Failure

DEEPEST = 8  # Recursion depth that CADGeometricError takes.


def parse(arguments, description):
    options = option_parser(description).parse_args(arguments)
    check(options)
    return options


class OptionParser(argparse.ArgumentParser):
    def error(self, message):
        raise Failure(message)


def option_parser(description):
    parser = OptionParser(prog="cadrefine.py", description=description, allow_abbrev=False)
    parser.add_argument("mesh", metavar="MESH", help="the mesh: .vtu .pvtu .vtk .vtp ...")
    parser.add_argument("cad", metavar="CAD", help="the CAD model: .igs .iges .stp .step .brep")
    parser.add_argument("--output", metavar="FILE", help="write the last mesh, .vtu or .pvtu")

    steps = parser.add_argument_group("steps")
    steps.add_argument("--uniform-steps", type=natural, default=0, metavar="N", help="uniform steps before the others")
    steps.add_argument("--steps", type=natural, default=3, metavar="N", help="refinement steps (default 3)")
    steps.add_argument("--method", choices=list(METHODS), default="longest-edge",
                       help="of --steps: bisect the marked cells at their longest edge (default), or all cells")
    steps.add_argument("--maximum-cells", type=natural, metavar="N", help="stop before there are more cells")
    steps.add_argument("--quadratic", action="store_true",
                       help="make the last mesh one of quadratic cells, their mid-edge nodes on the CAD")
    steps.add_argument("--target-error", type=number, metavar="E", help="stop at this global geometric error")

    marking = parser.add_argument_group("marking (longest-edge; a cell that any of these marks; default: all cells)")
    marking.add_argument("--threshold", type=number, metavar="E", help="by the geometric error, those where it is larger")
    marking.add_argument("--marking", choices=list(STRATEGIES), default="threshold",
                         help="what --threshold is: a bound (default), a part of the largest error, from which on cells "
                         "are marked, or a part of the sum, which the fewest cells shall carry (bulk, Doerfler)")
    marking.add_argument("--indicator", metavar="ARRAY", help="by this cell array, a solver's error indicator")
    marking.add_argument("--indicator-threshold", type=number, metavar="E", help="those whose value is larger")
    marking.add_argument("--indicator-marking", choices=list(STRATEGIES), default="threshold",
                         help="what --indicator-threshold is, as for --marking")
    marking.add_argument("--chord-tolerance", type=limit, default=0.0, metavar="D",
                         help="those with an edge on the CAD whose middle is farther from it")
    marking.add_argument("--normal-angle", type=limit, default=0.0, metavar="DEGREES",
                         help="those with a facet that makes a larger angle with a neighbour, across no crease")
    marking.add_argument("--cut-facets", action="store_true",
                         help="bisect marked cells until their facets on the CAD are cut")

    geometry = parser.add_argument_group("geometry")
    geometry.add_argument("--region", type=number, nargs=6, metavar=("X0", "X1", "Y0", "Y1", "Z0", "Z1"),
                          help="project only vertices inside this box, X0 <= X1, Y0 <= Y1, Z0 <= Z1")
    geometry.add_argument("--maximum-distance", type=limit, default=0.0, metavar="D",
                          help="leave vertices that are farther from the CAD, 0 or more (default 0: automatic)")
    geometry.add_argument("--recursion-depth", type=depth, default=1, metavar="K",
                          help=f"of the error, 1 to {DEEPEST} (default 1)")
    geometry.add_argument("--projected", action="store_true",
                          help="go on with a mesh that an earlier run wrote: keep its places on the CAD (point arrays "
                          "CADDimension, ...), do not project it again")
    geometry.add_argument("--no-cad", action="store_true",
                          help="project the mesh, then refine straight: new vertices stay off the CAD, to compare")

    results = parser.add_argument_group("results")
    results.add_argument("--report", metavar="FILE.json", help="write what the table says, and more")
    results.add_argument("--plot", metavar="FILE.png", help="draw the global error over the number of vertices")
    results.add_argument("--compare-report", metavar="FILE.json", help="draw another run's report into the plot")
    results.add_argument("--screenshot", metavar="FILE.png", help="picture of the last mesh (needs a display)")
    results.add_argument("--screenshot-start", metavar="FILE.png", help="the same of the projected mesh")
    results.add_argument("--focus", type=number, nargs=6, metavar=("X0", "X1", "Y0", "Y1", "Z0", "Z1"),
                         help="box that the pictures show (default: all that lies on the CAD)")
    results.add_argument("--view", type=number, nargs=3, metavar=("X", "Y", "Z"),
                         help="direction from the mesh to the eye in the pictures; z is up (default -0.6 -0.64 0.48, in "
                         "the plane 0 0 1)")
    results.add_argument("--quiet", action="store_true", help="print nothing but errors")
    return parser


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
    endings = {"output": (".vtu", ".pvtu"), "report": (".json",), "plot": (".png",), "screenshot": (".png",),
               "screenshot_start": (".png",)}
    for name, allowed in endings.items():
        if getattr(options, name):
            session.check_writable(getattr(options, name), allowed)
    if options.screenshot or options.screenshot_start:
        pictures.check_display()
