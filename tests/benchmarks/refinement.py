#!/usr/bin/python3
"""Measures RefineWithCAD against other programs' refinement, all in one run, and prints tables with the ratios.

    tests/benchmarks/refinement.py [--edges N] [--rounds R] [--only NAME ...]

Peers (Debian packages python3-dolfin, python3-dolfinx, python3-gmsh) refine the same box of 6 N^3 tetrahedra, in memory,
each in a process of its own on one core, in turns with ours; the best of all turns counts. So does deal.II (package
libdeal.ii-dev), which refines the same box of N^3 hexahedra. Then ours alone: on two ranks, with a CAD against without,
and at sizes from 10^5 cells made on. What is timed is the refinement alone, without
making, reading or writing meshes. Seconds on one core are processor time, which a machine that does other work too
disturbs less than wall clock time; on two ranks both are told.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests", "pvbatch"))

import driver

TIMEOUT = 1800

# Program, method: how many times faster ours has to be.
TARGETS = {("dolfin", "uniform"): 5, ("gmsh", "uniform"): 10, ("dolfin", "marked"): 2, ("dolfinx", "marked"): 10}
SIZES = (14, 24, 40, 60)  # Edges of boxes whose refinement makes 10^5 to 10^7 cells.
WING = ("--around", "41", "--layers", "7")  # 1,197 tetrahedra, after four levels 4.9 million.
WING_LEVELS = 4

ENVIRONMENT = {**driver.ENVIRONMENT, "OMP_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}


def run(command, cores):
    """The JSON object that the command prints last; it may use the first so many cores."""
    environment = {**os.environ, **ENVIRONMENT}
    available = sorted(os.sched_getaffinity(0))[:cores]
    result = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=TIMEOUT, check=False,
                            preexec_fn=lambda: os.sched_setaffinity(0, available))
    lines = [line for line in result.stdout.splitlines() if line.startswith("{")]
    if result.returncode != 0 or not lines:
        sys.exit(f"{' '.join(command)}: failed\n{result.stdout}{result.stderr}")
    return json.loads(lines[-1])


def run_peer(name, method, edges):
    return run(["/usr/bin/python3", os.path.join(HERE, "refinement_peers.py"), name, method, str(edges)], 1)


def run_ours(*arguments, ranks=1):
    script = [os.path.join(HERE, "refinement_ours.py"), *map(str, arguments)]
    if ranks == 1:
        return run(["pvpython", *script], 1)
    return run(["mpirun", "--bind-to", "none", "-np", str(ranks), "pvbatch", *script], ranks)


def best_of(measurements):
    return min(measurements, key=lambda measurement: measurement["seconds"])


def rate(measurement):
    """Millions of cells made a second."""
    return measurement["made"] / measurement["seconds"] / 1e6


def against_peers(edges, rounds):
    print(f"One core, box of {6 * edges**3:,} tetrahedra, no CAD")
    print(f"{'program':>10} {'method':>8} {'cells made':>11} {'seconds':>8} {'M cells/s':>9} {'ours is':>8} {'wanted':>7}")
    for method, peers in (("uniform", ("dolfin", "dolfinx", "gmsh")), ("marked", ("dolfin", "dolfinx"))):
        results = {}
        for _ in range(rounds):
            results.setdefault("ours", []).append(run_ours("box", method, edges))
            for peer in peers:
                results.setdefault(peer, []).append(run_peer(peer, method, edges))
        ours = best_of(results["ours"])
        for name, measurements in results.items():
            best = best_of(measurements)
            ratio = f"{rate(ours) / rate(best):7.1f}x" if name != "ours" else ""
            target = f"{TARGETS[name, method]:6d}x" if (name, method) in TARGETS else ""
            print(f"{name:>10} {method:>8} {best['made']:11,} {best['seconds']:8.2f} {rate(best):9.2f} {ratio:>8} "
                  f"{target:>7}", flush=True)


def build_dealii(folder):
    """The program of dealii/; None, and why, where deal.II is not there or does not build."""
    for command in (["cmake", "-S", os.path.join(HERE, "dealii"), "-B", folder, "-DCMAKE_BUILD_TYPE=Release"],
                    ["cmake", "--build", folder]):
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            print(f"deal.II is left out ({' '.join(command[:2])} failed; package libdeal.ii-dev): "
                  f"{result.stderr.strip().splitlines()[0] if result.stderr.strip() else 'no message'}")
            return None
    return os.path.join(folder, "dealii_refinement")


def of_hexahedra(edges, rounds):
    print(f"\nOne core, box of {edges**3:,} hexahedra, uniform, no CAD")
    with tempfile.TemporaryDirectory() as folder:
        peer = build_dealii(folder)
        ours, theirs = [], []
        for _ in range(rounds):
            ours.append(run_ours("box", "uniform", edges, "--shape", "hexahedra"))
            if peer:
                theirs.append(run([peer, str(edges)], 1))
    best = best_of(ours)
    print(f"{'ours':>10}: {best['made']:,} made in {best['seconds']:.2f} s, {rate(best):.2f} million a second "
          "(wanted: 10)", flush=True)
    if theirs:
        other = best_of(theirs)
        print(f"{'deal.II':>10}: {other['made']:,} made in {other['seconds']:.2f} s, {rate(other):.2f} million a second; "
              f"ours is {rate(best) / rate(other):.1f} times as fast", flush=True)
    print_parts(best)


def on_ranks(edges, rounds):
    print(f"\nTwo ranks, box of {6 * edges**3:,} tetrahedra, no CAD; with the cells shared out first, and as they lie")
    for method in ("uniform", "marked"):
        one = best_of([run_ours("box", method, edges) for _ in range(rounds)])
        for balance in (0, 1):
            two = best_of([run_ours("box", method, edges, "--balance", balance, ranks=2) for _ in range(rounds)])
            print(f"{method:>10}, Balance {'on' if balance else 'off':<3}: {one['seconds'] / two['seconds']:.2f} times as "
                  f"fast ({one['seconds']:.2f} s, {two['seconds']:.2f} s), by the wall clock "
                  f"{one['wall'] / two['wall']:.2f} times ({one['wall']:.2f} s, {two['wall']:.2f} s); wanted: 1.7",
                  flush=True)


def with_cad(rounds):
    with tempfile.TemporaryDirectory() as folder:
        mesh = os.path.join(folder, "wing.vtu")
        subprocess.run(["/usr/bin/python3", "-B", os.path.join(ROOT, "data", "naca0012_mesh.py"), *WING, mesh],
                       check=True, stdout=subprocess.DEVNULL)
        results = {"straight": [], "cad": []}
        for _ in range(rounds):
            for case, measurements in results.items():
                measurements.append(run_ours("wing", case, mesh, "--levels", WING_LEVELS))
    straight, cad = best_of(results["straight"]), best_of(results["cad"])
    print(f"\nNACA section, {WING_LEVELS} uniform levels to {cad['made']:,} cells: without CAD {straight['seconds']:.2f} "
          f"s, with {cad['seconds']:.2f} s: {cad['seconds'] / straight['seconds']:.2f} times (wanted: at most 1.3)")
    print_parts(cad)


def at_sizes(sizes, rounds):
    print("\nOne core, uniform, boxes of several sizes")
    print(f"{'cells made':>11} {'seconds':>8} {'ns/cell':>8} {'bytes/cell at the peak':>23}")
    for edges in sizes:
        best = best_of([run_ours("box", "uniform", edges) for _ in range(rounds)])
        print(f"{best['made']:11,} {best['seconds']:8.3f} {1e9 * best['seconds'] / best['made']:8.0f} "
              f"{best['peak_bytes'] / best['made']:23.0f}", flush=True)
    print_parts(best)


def print_parts(measurement):
    parts = {name[len("seconds "):]: value for name, value in measurement["costs"].items()
             if name.startswith("seconds ")}
    if parts:
        print("            where the time went: " + ", ".join(f"{name} {value:.2f} s" for name, value in parts.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--edges", type=int, default=40, help="edges along a side of the box (default %(default)s)")
    parser.add_argument("--rounds", type=int, default=3, help="turns of each program (default %(default)s)")
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES, help="edges of the boxes of several sizes")
    parser.add_argument("--hexahedra", type=int, default=60, help="edges along a side of their box (default %(default)s)")
    parser.add_argument("--only", nargs="+", choices=("peers", "hexahedra", "ranks", "cad", "sizes"),
                        default=("peers", "hexahedra", "ranks", "cad", "sizes"))
    options = parser.parse_args()
    parts = {"peers": lambda: against_peers(options.edges, options.rounds),
             "hexahedra": lambda: of_hexahedra(options.hexahedra, options.rounds),
             "ranks": lambda: on_ranks(options.edges, options.rounds),
             "cad": lambda: with_cad(options.rounds),
             "sizes": lambda: at_sizes(options.sizes, options.rounds)}
    for name in options.only:
        parts[name]()


if __name__ == "__main__":
    main()
