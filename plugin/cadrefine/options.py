"""The options of the driver."""

import argparse
import re

from cadrefine import output
from cadrefine.checks import (DEEPEST, MOST_CELLS, MOST_STEPS, RESULTS, angle, check, coordinate, number, names,
                              option_of, part, positive, whole)
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
        listed = ", ".join(map(option_of, given))
        yield f"No effect, because --method uniform refines all cells: {listed}"


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
                       help="also write the facets of the boundary (lines in 2D), each with its CAD face in the cell "
                       "arrays CADEntity, CADDimension and CADColor (default)")
    files.add_argument("--msh-version", choices=MSH_VERSIONS, default=MSH_VERSIONS[0],
                       help="version of a .msh file: 2.2, which every program that reads .msh understands (default), "
                       "or 4.1")
    files.add_argument("--ascii", action="store_true", help="write a .msh file as text, not in binary")
    add_steps(parser.add_argument_group("steps"))
    add_marking(parser.add_argument_group(
        "marking", "Longest edge bisection refines the cells that any of these options marks; without any, the\n"
        "fewest cells that carry half of the geometric error (--marking bulk --threshold 0.5)."))
    add_geometry(parser.add_argument_group("geometry"))
    add_results(parser.add_argument_group("results"))
    return parser


def add_steps(group):
    group.add_argument("--steps", type=whole(0, MOST_STEPS), default=3, metavar="N",
                       help="refinement steps (default 3)")
    group.add_argument("--method", choices=list(METHODS), default="longest-edge",
                       help="method of --steps: longest-edge bisects the marked cells at their longest edge, and "
                       "others until no hanging vertex is left (default); uniform cuts all cells into 4 or 8 of their "
                       "kind")
    group.add_argument("--uniform-steps", type=whole(0, MOST_STEPS), default=0, metavar="N",
                       help="uniform refinement steps before the others (default 0)")
    group.add_argument("--maximum-cells", type=whole(0, MOST_CELLS), metavar="N",
                       help="stop before a step would exceed this number of cells (default: no limit)")
    group.add_argument("--target-error", type=positive, metavar="E",
                       help="stop at this global geometric error, an area in 2D, a volume in 3D (default: not used)")
    group.add_argument("--coarsening-fraction", type=part, default=0.0, metavar="F",
                       help="each step also removes vertices where every criterion's values are below the fraction F "
                       "of the smallest value that it marks; the boundary keeps to --target-error or, without it, gets "
                       "no farther from the CAD (default 0: no coarsening)")
    group.add_argument("--operations", choices=list(OPERATIONS), default="all",
                       help="what may be done where vertices do not reach the CAD or cells are badly shaped: all "
                       "swaps, collapses and splits edges there (default); cut-only does not")
    group.add_argument("--minimum-quality", type=part, default=0.1, metavar="Q",
                       help="use these operations to improve cells with a mean ratio below Q, also those of MESH; 1 is "
                       "equilateral; new cells below 0.3 are improved, too, by swaps and moves (default 0.1; 0: use "
                       "them only for vertices off the CAD)")
    group.add_argument("--conserve", type=names, default=[], metavar="NAME,...",
                       help="cell arrays of MESH that are densities, per volume (per area for triangles): their "
                       "integrals are conserved whatever becomes of the cells (default: none)")
    group.add_argument("--keep-layers", action=argparse.BooleanOptionalAction, default=True,
                       help="cut boundary layers (wedges; hexahedra and quadrilaterals half as thick as long) only "
                       "along the wall, all cells of a column alike (default)")
    group.add_argument("--quadratic", action="store_true",
                       help="at the end, make the cells quadratic, with mid-edge nodes on the CAD")


def add_marking(group):
    group.add_argument("--marking", choices=[*STRATEGIES, "off"],
                       help="by the geometric error of a cell, an area in 2D, a volume in 3D: the fewest cells that "
                       "carry the fraction E of its sum (bulk, after Doerfler), those where it is at least the "
                       "fraction E of the largest one (fraction), or larger than E (threshold); off: not by it, and "
                       "all cells if there is no other criterion (default: bulk if there is no other criterion, else "
                       "off)")
    group.add_argument("--threshold", type=positive, metavar="E",
                       help="the E of --marking; for bulk and fraction it is above 0 and at most 1 (default 0.5). "
                       "Without --marking it means --marking threshold")
    group.add_argument("--indicator", metavar="ARRAY",
                       help="by this cell array of MESH, for example a solver's error indicator; needs "
                       "--indicator-threshold (default: not used)")
    group.add_argument("--indicator-threshold", type=number, metavar="E",
                       help="cells whose value is larger than E, in the array's unit, or as --indicator-marking says")
    group.add_argument("--indicator-marking", choices=list(STRATEGIES), default="threshold",
                       help="what that E means, as for --marking (default threshold)")
    group.add_argument("--chord-tolerance", type=positive, default=0.0, metavar="D",
                       help="cells with an edge on the CAD whose midpoint is farther than D from the CAD, a length "
                       "(default 0: not used)")
    group.add_argument("--normal-angle", type=angle, default=0.0, metavar="DEGREES",
                       help="cells with a facet that makes a larger angle with a neighbour, where the CAD has no "
                       "crease (default 0: not used)")
    group.add_argument("--cut-facets", action=argparse.BooleanOptionalAction,
                       help="keep bisecting marked cells until their facets on the CAD are cut (default: yes)")


def add_geometry(group):
    group.add_argument("--cad-unit", choices=UNITS, metavar="UNIT",
                       help="convert the CAD to this unit of length, which must be that of the mesh: m, cm, mm, in or "
                       "ft (default: the coordinates are the CAD file's own numbers)")
    group.add_argument("--faces", type=names, default=[], metavar="NAME[=TOLERANCE],...",
                       help="work only on these CAD faces (for a planar mesh, CAD edges): names in the CAD file, "
                       "patterns of names (*, ?, [...]) or numbers; !NAME excludes one; =TOLERANCE is their chord "
                       "tolerance, a length (default: all)")
    group.add_argument("--region", type=number, nargs=6, metavar=BOX,
                       help="project only vertices inside this box; X0 <= X1, Y0 <= Y1, Z0 <= Z1, lengths (default: "
                       "everywhere)")
    group.add_argument("--maximum-distance", type=positive, default=0.0, metavar="D",
                       help="do not project vertices that are farther than D from the CAD, a length (default 0: "
                       "D is the longest boundary edge at each vertex)")
    group.add_argument("--recursion-depth", type=whole(0, DEEPEST), default=0, metavar="K",
                       help="how often the edges of a facet are halved to measure the geometric error, 1 to "
                       f"{DEEPEST}: 1 is the published estimate, 3/4 of the exact area or volume on smooth CAD, 3 is "
                       "0.98 of it (default 0: two levels, extrapolated to the exact value)")
    group.add_argument("--projected", action="store_true",
                       help="continue with a mesh that an earlier run wrote as .vtu or .pvtu: keep its places on the "
                       "CAD (point arrays CADDimension, ...) instead of projecting it again")
    group.add_argument("--no-cad", action="store_true",
                       help="for comparison: project the mesh, then refine straight, with new vertices off the CAD")


def add_results(group):
    group.add_argument("--report", metavar="FILE.json",
                       help="write a JSON object with facts about the CAD, what could not be read of it, and for each "
                       "step all columns of the table, seconds and costs; see docs/command-line.md")
    group.add_argument("--plot", metavar="FILE.png", help="plot the global error over the number of vertices")
    group.add_argument("--compare-report", metavar="FILE.json", help="also draw the report of another run in the plot")
    group.add_argument("--screenshot", metavar="FILE.png",
                       help="picture of the last mesh: its facets on the CAD, coloured by their distance from it, with "
                       "plane faces in grey; needs a display")
    group.add_argument("--screenshot-start", metavar="FILE.png",
                       help="the same picture of the projected mesh, from the same side and on the same scale")
    group.add_argument("--focus", type=coordinate, nargs=6, metavar=BOX,
                       help="box that the pictures show, lengths (default: the curved faces of the CAD, without a "
                       "far field)")
    group.add_argument("--view", type=coordinate, nargs=3, metavar=("X", "Y", "Z"),
                       help="direction from the mesh to the eye in the pictures; z is up (default: -0.6 -0.64 0.48 "
                       "with the signs that show most of the error; for a mesh in the plane 0 0 1)")
    group.add_argument("--strict", action="store_true", help="treat every warning as an error")
    group.add_argument("--quiet", action="store_true", help="print nothing but errors")
    group.add_argument("-h", "--help", action="store_true", help="print this help and exit")
