"""The options of the driver."""

import argparse
import re

from cadrefine import output
from cadrefine.checks import (DEEPEST, MOST_CELLS, MOST_STEPS, RESULTS, angle, check, coordinate, number, names,
                              part, positive, whole)
from cadrefine.help import DESCRIPTION, EPILOG, USAGE, Layout
from cadrefine.pipeline import METHODS, OPERATIONS, STRATEGIES
from cadrefine.session import Failure, flush, speaks

UNITS = ("m", "cm", "mm", "in", "inch", "ft")  # Of the CAD Reader.
BOX = ("X0", "X1", "Y0", "Y1", "Z0", "Z1")
NEGATIVE = re.compile(r"-(\.?\d|inf|nan)", re.IGNORECASE)  # How negative numbers begin.
MSH_VERSIONS = ("2.2", "4.1")
MARKING = ("threshold", "marking", "indicator", "chord_tolerance", "normal_angle", "cut_facets",
           "coarsening_fraction")


def parse(arguments):
    """The options, checked; None where the help was wanted, and printed."""
    if "--help" in arguments or "-h" in arguments:
        if speaks():
            print(option_parser().format_help(), end="")
            flush()
        return None
    options = option_parser().parse_args([as_given(text) for text in arguments])
    options.output = options.output and output.place_of(options.output)
    check(options)
    return options


def as_given(argument):
    """ParaView makes --1e3 of -1e3."""
    return argument[1:] if argument.startswith("--") and NEGATIVE.match(argument[1:]) else argument


def results(options):
    """The files that shall be written."""
    return [place for place in (getattr(options, name) for name in RESULTS) if place]


def remarks(options):
    """What is worth a word, though it is no mistake."""
    given = [name for name in MARKING if getattr(options, name) not in (None, 0.0)]
    if options.method == "uniform" and given:
        names = ", ".join("--" + name.replace("_", "-") for name in given)
        yield f"Without effect, as --method uniform refines all cells: {names}"


class OptionParser(argparse.ArgumentParser):
    def __init__(self, **arguments):
        super().__init__(**arguments)
        self._negative_number_matcher = NEGATIVE  # Also -1e-3 is no option.

    def error(self, message):
        raise Failure(message)


def option_parser():
    parser = OptionParser(prog="cadrefine.py", usage=USAGE, description=DESCRIPTION, epilog=EPILOG, allow_abbrev=False,
                          formatter_class=Layout, add_help=False)
    files = parser.add_argument_group("files")
    files.add_argument("mesh", metavar="MESH", help="the mesh: .vtu .pvtu .vtk .msh .xdmf .e .med "
                       ".inp .foam ...; see below")
    files.add_argument("cad", metavar="CAD", help="the CAD model: .igs .iges .stp .step .brep")
    files.add_argument("--output", metavar="FILE", help="write the last mesh: .vtu .pvtu .xdmf .msh .med .exo .inp "
                       ".cgns .bdf .unv .mesh .su2 .foam; see below")
    files.add_argument("--boundary-cells", action=argparse.BooleanOptionalAction, default=True,
                       help="write the boundary's facets (in 2D, lines) too, each with its CAD face: cell arrays "
                       "CADEntity, CADDimension and CADColor (default)")
    files.add_argument("--msh-version", choices=MSH_VERSIONS, default=MSH_VERSIONS[0],
                       help="of a .msh file: 2.2, which all programs know that take .msh (default), or 4.1")
    files.add_argument("--ascii", action="store_true", help="write a .msh file as text, not binary")
    add_steps(parser.add_argument_group("steps"))
    add_marking(parser.add_argument_group(
        "marking", "Longest edge bisection refines cells that any of these marks; where none is given, the fewest\n"
        "  cells that carry half of the geometric error (--marking bulk --threshold 0.5)."))
    add_geometry(parser.add_argument_group("geometry"))
    add_results(parser.add_argument_group("results"))
    return parser


def add_steps(group):
    group.add_argument("--steps", type=whole(0, MOST_STEPS), default=3, metavar="N",
                       help="refinement steps (default 3)")
    group.add_argument("--method", choices=list(METHODS), default="longest-edge",
                       help="of --steps: longest-edge bisects the marked cells at their longest edge, and others until "
                       "no vertex hangs (default); uniform cuts all cells into 4 or 8 of their kind")
    group.add_argument("--uniform-steps", type=whole(0, MOST_STEPS), default=0, metavar="N",
                       help="uniform steps before the others (default 0)")
    group.add_argument("--maximum-cells", type=whole(0, MOST_CELLS), metavar="N",
                       help="end before there are more cells than that (default: no limit)")
    group.add_argument("--target-error", type=positive, metavar="E",
                       help="end at this global geometric error, an area in 2D, a volume in 3D (default: not used)")
    group.add_argument("--coarsening-fraction", type=part, default=0.0, metavar="F",
                       help="each step also takes vertices out where all values are below the part F of the smallest "
                       "that each criterion marks; the boundary keeps to --target-error, or gets no farther from the "
                       "CAD (default 0: no coarsening)")
    group.add_argument("--operations", choices=list(OPERATIONS), default="all",
                       help="what may be done with cells where vertices do not reach the CAD or cells are badly "
                       "shaped: all swaps, collapses and splits edges there (default); cut-only does not")
    group.add_argument("--minimum-quality", type=part, default=0.1, metavar="Q",
                       help="improve cells of a smaller mean ratio by these operations, those of MESH too; 1 is "
                       "equilateral (default 0.1; 0: only vertices off the CAD call for them)")
    group.add_argument("--conserve", type=names, default=[], metavar="NAME,...",
                       help="cell arrays of MESH that are densities, per volume (of triangles per area): their "
                       "integrals stay whatever becomes of the cells (default: none)")
    group.add_argument("--keep-layers", action=argparse.BooleanOptionalAction, default=True,
                       help="cut boundary layers (wedges; hexahedra and quadrilaterals half as thick as long) along the "
                       "wall only, all cells over each other alike (default)")
    group.add_argument("--quadratic", action="store_true",
                       help="at the end, make the cells quadratic, with mid-edge nodes on the CAD")


def add_marking(group):
    group.add_argument("--marking", choices=[*STRATEGIES, "off"],
                       help="by the geometric error of a cell, an area in 2D, a volume in 3D: the fewest cells that carry "
                       "the part E of its sum (bulk, after Doerfler), those where it is at least the part E of the "
                       "largest one (fraction), or larger than E (threshold); off: not by it, and with no other "
                       "criterion all cells (default: bulk if there is no other criterion, else off)")
    group.add_argument("--threshold", type=positive, metavar="E",
                       help="the E of --marking: for bulk and fraction above 0 and at most 1 (default 0.5); alone it "
                       "means --marking threshold")
    group.add_argument("--indicator", metavar="ARRAY",
                       help="by this cell array of MESH, such as a solver's error indicator; needs "
                       "--indicator-threshold (default: not used)")
    group.add_argument("--indicator-threshold", type=number, metavar="E",
                       help="those whose value is larger than E, in the array's unit; or what --indicator-marking "
                       "makes of E")
    group.add_argument("--indicator-marking", choices=list(STRATEGIES), default="threshold",
                       help="what that E is, as for --marking (default threshold)")
    group.add_argument("--chord-tolerance", type=positive, default=0.0, metavar="D",
                       help="those with an edge on the CAD whose middle is farther than D from it, a length (default "
                       "0: not used)")
    group.add_argument("--normal-angle", type=angle, default=0.0, metavar="DEGREES",
                       help="those with a facet that makes a larger angle with a neighbour, across no crease of the "
                       "CAD (default 0: not used)")
    group.add_argument("--cut-facets", action=argparse.BooleanOptionalAction,
                       help="bisect marked cells on until their facets on the CAD are cut (default: yes)")


def add_geometry(group):
    group.add_argument("--cad-unit", choices=UNITS, metavar="UNIT",
                       help="convert the CAD to this unit of length, that of the mesh: m, cm, mm, in or ft (default: "
                       "the coordinates are the CAD file's own numbers)")
    group.add_argument("--faces", type=names, default=[], metavar="NAME[=TOLERANCE],...",
                       help="work only on these CAD faces (of a planar mesh, CAD edges): names in the CAD file, patterns "
                       "of names (*, ?, [...]) or numbers, !NAME to leave one out; =TOLERANCE is their chord tolerance, "
                       "a length (default: all)")
    group.add_argument("--region", type=number, nargs=6, metavar=BOX,
                       help="project only vertices inside this box; X0 <= X1, Y0 <= Y1, Z0 <= Z1, lengths (default: "
                       "everywhere)")
    group.add_argument("--maximum-distance", type=positive, default=0.0, metavar="D",
                       help="do not project vertices that are farther than D from the CAD, a length (default 0: "
                       "farther than the longest edge of the boundary at the vertex)")
    group.add_argument("--recursion-depth", type=whole(0, DEEPEST), default=0, metavar="K",
                       help=f"how often the geometric error halves the edges of a facet, 1 to {DEEPEST}: 1 is the "
                       "published estimate, 3/4 of the exact area or volume on smooth CAD, 3 is 0.98 of it (default "
                       "0: two levels, extrapolated to the exact one)")
    group.add_argument("--projected", action="store_true",
                       help="go on with a mesh that an earlier run wrote as .vtu or .pvtu: keep its places on the CAD "
                       "(point arrays CADDimension, ...), do not project it again")
    group.add_argument("--no-cad", action="store_true",
                       help="project the mesh, then refine straight: new vertices stay off the CAD, to compare")


def add_results(group):
    group.add_argument("--report", metavar="FILE.json",
                       help="write a JSON object: CAD, what of it was not read, and of each step all of the table, "
                       "seconds and costs; see docs/command-line.md")
    group.add_argument("--plot", metavar="FILE.png", help="draw the global error over the number of vertices")
    group.add_argument("--compare-report", metavar="FILE.json", help="draw another run's report into the plot")
    group.add_argument("--screenshot", metavar="FILE.png",
                       help="picture of the last mesh: its facets on the CAD, coloured by their distance from it, "
                       "plane ones grey; needs a display")
    group.add_argument("--screenshot-start", metavar="FILE.png",
                       help="the same of the projected mesh, from the same side and on the same scale")
    group.add_argument("--focus", type=coordinate, nargs=6, metavar=BOX,
                       help="box that the pictures show, lengths (default: the curved faces of the CAD, without a "
                       "far field)")
    group.add_argument("--view", type=coordinate, nargs=3, metavar=("X", "Y", "Z"),
                       help="direction from the mesh to the eye in the pictures; z is up (default: -0.6 -0.64 0.48 "
                       "with the signs that show most of the error, of a mesh in the plane 0 0 1)")
    group.add_argument("--strict", action="store_true", help="make each warning an error")
    group.add_argument("--quiet", action="store_true", help="print nothing but errors")
    group.add_argument("-h", "--help", action="store_true", help="print this help, and do nothing else")
