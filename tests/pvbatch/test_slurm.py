#!/usr/bin/python3
"""The job script of docs/examples/slurm, with a stand-in for srun."""

import json
import os
import subprocess
import tempfile
import unittest

import driver

SCRIPT = os.path.join(driver.ROOT, "docs", "examples", "slurm", "cadrefine.sbatch")
RANKS = 2
# Takes the options of the script's srun, and starts the ranks of the job by mpirun.
SRUN = """#!/bin/bash
printf '%s\\n' "$@" VTK_SMP_MAX_THREADS=$VTK_SMP_MAX_THREADS >"$(dirname "$0")/told"
while [[ $1 == --* ]]; do shift; done
exec mpirun -np "$SLURM_NTASKS" "$@"
"""
CASE = [driver.data("three_arcs_coarse.vtu"), driver.data("three_arcs.igs"), "--steps", "1"]


class Slurm(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        with open(self.path("srun"), "w", encoding="ascii") as file:
            file.write(SRUN)
        os.chmod(self.path("srun"), 0o755)

    def path(self, name):
        return os.path.join(self.folder, name)

    def job(self, *arguments, **variables):
        environment = {**os.environ, **driver.ENVIRONMENT, "PATH": f"{self.folder}:{os.environ['PATH']}",
                       "SLURM_JOB_ID": "1", "SLURM_NTASKS": str(RANKS), "SLURM_CPUS_PER_TASK": "1",
                       "CADREFINE_DRIVER": driver.DRIVER, **variables}
        return subprocess.run(["bash", SCRIPT, *arguments], env=environment, cwd=self.folder, capture_output=True,
                              text=True, timeout=driver.TIMEOUT, stdin=subprocess.DEVNULL, check=False)

    def test_syntax_and_directives(self):
        subprocess.run(["bash", "-n", SCRIPT], check=True)
        with open(SCRIPT, encoding="ascii") as file:
            lines = file.read().splitlines()
        self.assertEqual(lines[0], "#!/bin/bash")
        commands = [number for number, line in enumerate(lines) if line and not line.startswith("#")]
        directives = [number for number, line in enumerate(lines) if line.startswith("#SBATCH --")]
        self.assertGreater(len(directives), 3)
        self.assertLess(max(directives), min(commands), "sbatch reads no directive after the first command")

    def test_a_job(self):
        result = self.job(*CASE, "--output", "fine.pvtu", "--report", "fine.json")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn(f"{RANKS} ranks on 1 nodes, job 1", result.stdout)
        with open(self.path("fine.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["ranks"], RANKS)
        self.assertTrue(os.path.isfile(self.path("fine.pvtu")))
        with open(self.path("told"), encoding="utf-8") as file:
            told = file.read().splitlines()
        self.assertEqual(told[:3], ["--mpi=pmix", "--cpu-bind=cores", "pvbatch"])
        self.assertEqual(told[-1], "VTK_SMP_MAX_THREADS=1")

    def test_a_job_that_fails(self):
        result = self.job("none.vtu", *CASE[1:], CADREFINE_LAUNCH=f"mpirun -np {RANKS}")
        self.assertEqual(result.returncode, 1)
        self.assertIn("cadrefine: none.vtu: no such file", result.stderr.splitlines())
        self.assertFalse(os.path.exists(self.path("told")))


if __name__ == "__main__":
    unittest.main()
