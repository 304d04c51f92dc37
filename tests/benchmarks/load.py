#!/usr/bin/python3
"""Heavy runs: what each took of time and memory, and whether its result is right.

    tests/benchmarks/load.py [CASE ...]

surface    11 million vertices on the aeroplane, triangles, projected anew, on one rank
uniform    27 million tetrahedra round the aeroplane, three uniform levels, on one rank and on two
adaptive   20 million tetrahedra by longest edge bisection where the error is, on one rank and on two
ranks      64 ranks on small pieces: the tests' meshes, the same as on one rank
cycles     200 cycles of refining a few cells, in one process

Needs up to 15 GiB of memory. Processor seconds are those of all ranks and their threads, from start to end.
"""

import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests", "pvbatch"))

import driver

TESTS = os.path.join(ROOT, "build", "release", "tests", "filters", "TestDistributedFilters")
RANKS = 64
FEW = 1e-3
ON_RANKS = "Problems/Partition.*/Ring*:Problems/Partition.*/Surface*:Problems/Partition.*/WingKdTree*"
ENVIRONMENT = {**driver.ENVIRONMENT, "OMPI_MCA_mpi_yield_when_idle": "1"}


def mpirun(ranks):
    return ["mpirun", "--bind-to", "none", "-np", str(ranks)]


def started(command):
    result = subprocess.run(command, env={**os.environ, **ENVIRONMENT}, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"{' '.join(command)}: failed\n{result.stdout}{result.stderr}")
    return result.stdout


def run(case, ranks):
    """What load_ours.py tells, with the memory of each rank in MiB and the processor time of all."""
    with tempfile.TemporaryDirectory() as folder:
        command = [*mpirun(ranks), "pvbatch"] if ranks > 1 else ["pvpython"]
        output = started([*command, os.path.join(HERE, "load_ours.py"), folder, case])
        costs = []
        for name in os.listdir(folder):
            with open(os.path.join(folder, name), encoding="ascii") as file:
                costs.append(json.load(file))
    lines = [line for line in output.splitlines() if line.startswith("{")]
    if len(costs) != ranks or not lines:
        sys.exit(f"{case} on {ranks} ranks: failed\n{output}")
    return {**json.loads(lines[-1]), "ranks": ranks, "peaks": [rank["peak"] for rank in costs],
            "processor": sum(rank["seconds"] for rank in costs)}


def check(result):
    """A few vertices stop on the way to the CAD, where all of them moving would invert cells."""
    assert result["invalid"] == 0 and result["off the CAD"] <= FEW * result["CAD vertices"], result


def row(case, result):
    gib = [peak / 1024 for peak in result["peaks"]]
    print(f"| {case} | {result['cells']:,.0f} | {result['vertices']:,.0f} | {result['CAD vertices']:,.0f} "
          f"| {result['ranks']} | {result['processor']:.0f} | {result['wall']:.0f} | {max(gib):.2f} | {sum(gib):.2f} "
          f"| {result['invalid']:.0f}, {result['off the CAD']:.0f}, {result['worst']:.2g} "
          f"| {result.get('error falls', 1):,.0f} |", flush=True)


def large(case, *ranks):
    """All of them make the same mesh."""
    first = None
    for count in ranks:
        result = run(case, count)
        check(result)
        row(case, result)
        first = first or result
        assert {**result, **OWN} == {**first, **OWN}, (first, result)


OWN = dict.fromkeys(("ranks", "peaks", "processor", "wall"))  # What may differ.


def cycles():
    result = run("cycles", 1)
    check(result)
    row("cycles", result)
    for name in ("memory after 20", "memory after 200", "memory after 200, size of 20"):
        used, resident = result[name]
        print(f"cycles, {name}: {used:,} bytes in use, {resident:,} resident", flush=True)


def on_ranks():
    process = subprocess.Popen([*mpirun(RANKS), TESTS, f"--gtest_filter={ON_RANKS}"], text=True,
                               env={**os.environ, **ENVIRONMENT}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    output = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    assert status == 0 and "[  PASSED  ]" in output, output
    print(f"ranks: {output.count('[       OK ]')} meshes on {RANKS} ranks, the same as on one; processor time "
          f"{usage.ru_utime + usage.ru_stime:.0f} s, largest rank {usage.ru_maxrss / 1024:.0f} MiB", flush=True)


CASES = {"surface": lambda: large("surface", 1), "uniform": lambda: large("uniform", 1, 2),
         "adaptive": lambda: large("adaptive", 1, 2), "ranks": on_ranks, "cycles": cycles}


def main():
    print("| case | cells | vertices | on the CAD | ranks | processor s | wall s | GiB a rank | GiB in all "
          "| invalid, off the CAD, least quality | error falls to 1 / |\n" + "|---" * 11 + "|")
    for name in sys.argv[1:] or CASES:
        CASES[name]()


if __name__ == "__main__":
    main()
