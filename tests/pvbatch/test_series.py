#!/usr/bin/python3
"""Time series: on a mesh that stays the geometry is worked on once, on one that moves at every time step."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

import driver
import meshio

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1
SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "series_steps.py")
MESH = driver.data("naca0012_coarse.vtu")
CAD = driver.data("naca0012_sharp.igs")


def write_series(folder, name, stretch):
    """Three time steps; `stretch` is what the mesh grows by in each, of itself."""
    names = []
    for step in range(3):
        mesh = meshio.read(MESH)
        mesh.points *= 1 + step * stretch
        mesh.point_data["Pressure"] = mesh.points[:, 0] + 10 * step
        names.append(f"{name}{step}.vtu")
        mesh.write(os.path.join(folder, names[-1]))
    sets = "".join(f'<DataSet timestep="{step}" part="0" file="{file}"/>\n' for step, file in enumerate(names))
    path = os.path.join(folder, f"{name}.pvd")
    with open(path, "w", encoding="ascii") as file:
        file.write(f'<VTKFile type="Collection" version="0.1">\n<Collection>\n{sets}</Collection>\n</VTKFile>\n')
    return path


def run():
    """Of a mesh that stays, and of one that moves."""
    with tempfile.TemporaryDirectory() as folder:
        series = [write_series(folder, "still", 0), write_series(folder, "moving", 1e-3)]
        result = os.path.join(folder, "result.json")
        command = ["mpirun", "-np", str(RANKS), "pvbatch"] if RANKS else ["pvpython"]
        ended = subprocess.run(command + [SCRIPT, os.environ["CADREFINE_PLUGIN"], CAD, result, *series],
                               env={**os.environ, **driver.ENVIRONMENT}, capture_output=True, text=True,
                               timeout=driver.TIMEOUT, stdin=subprocess.DEVNULL, check=False)
        assert os.path.isfile(result), ended.stdout + ended.stderr
        with open(result, encoding="utf-8") as file:
            return json.load(file)


class Series(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.still, cls.moving = run()

    def compare_last_step(self, result):
        """The last step's output is that of filters that have seen no other step."""
        for name, expected in result["fresh"].items():
            self.assertEqual({**result["steps"][-1][name], "reused": 0}, {**expected, "reused": 0}, name)
            self.assertEqual(expected["reused"], 0, name)

    def reuse(self, result):
        return [{filter["reused"] for filter in step.values()} for step in result["steps"]]

    def test_mesh_that_stays(self):
        result = self.still
        self.assertEqual(result["times"], [0, 1, 2])
        self.assertEqual(self.reuse(result), [{0}, {1}, {1}])
        self.compare_last_step(result)
        first, last = result["steps"][0]["adapt"], result["steps"][-1]["adapt"]
        self.assertNotEqual(first["arrays"][0]["Pressure"], last["arrays"][0]["Pressure"])
        self.assertEqual(first["arrays"][1], last["arrays"][1])

    def test_mesh_that_moves(self):
        self.assertEqual(self.reuse(self.moving), [{0}, {0}, {0}])
        self.compare_last_step(self.moving)


if __name__ == "__main__":
    unittest.main()
