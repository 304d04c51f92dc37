#!/usr/bin/python3
"""The example docs/examples/drag at small size: the solver and CADRefine in turns, by files."""

import json
import os
import subprocess
import tempfile
import unittest

import driver
import meshio
import numpy as np

EXAMPLE = os.path.join(driver.ROOT, "docs", "examples", "drag")
ROUNDS, TIME_STEPS = 2, 12
TIMEOUT = 600  # Seconds; the first run compiles the forms.


def run(*arguments):
    return subprocess.run(["/usr/bin/python3", "-B", *map(str, arguments)], env={**os.environ, **driver.ENVIRONMENT},
                          capture_output=True, text=True, timeout=TIMEOUT, stdin=subprocess.DEVNULL, check=False)


class Drag(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.result = run(os.path.join(EXAMPLE, "drag.py"), "--output", cls.folder, "--rounds", ROUNDS, "--uniform-steps", 1,
                         "--time-steps", TIME_STEPS, "--fraction", 0.5)

    def setUp(self):
        self.assertEqual(self.result.returncode, 0, self.result.stderr)

    def rows(self, name):
        with open(os.path.join(self.folder, name + ".json"), encoding="utf-8") as file:
            return json.load(file)

    def mesh(self, name, number):
        return meshio.read(os.path.join(self.folder, "with_cad", f"{name}{number}.vtu"))

    def test_rounds(self):
        for name, swapped in (("with_cad", 25), ("without_cad", 0)):
            rows = self.rows(name)
            self.assertEqual([row["round"] for row in rows], list(range(ROUNDS + 1)))
            for row in rows:
                self.assertTrue(np.isfinite(row["drag"]))
                self.assertGreater(row["drag"], 0.0)
                self.assertGreater(row["indicator_sum"], 0.0)
                self.assertEqual((row["invalid_cells"], row["ranks"]), (0, 2))
            cells = [row["cells"] for row in rows]
            self.assertEqual(cells[0], 8 * 228 + swapped)
            self.assertEqual(cells, sorted(set(cells)))

    def test_only_the_cad_lowers_the_geometric_error(self):
        errors = [row["global_error"] for row in self.rows("with_cad")]
        self.assertTrue(all(after < before for before, after in zip(errors, errors[1:])), errors)
        straight = [row["global_error"] for row in self.rows("without_cad")]
        self.assertTrue(all(error > 0.99 * straight[0] for error in straight), straight)
        self.assertLess(errors[-1], 0.5 * straight[-1])

    def test_solution_is_carried_over(self):
        rows = self.rows("with_cad")
        self.assertEqual([row["carried_over"] for row in rows], [False] + [True] * ROUNDS)
        for number in range(1, ROUNDS + 1):
            before, after = self.mesh("flow", number - 1), self.mesh("mesh", number)
            state = np.column_stack([after.point_data["velocity"], after.point_data["pressure"]])
            self.assertAlmostEqual(np.linalg.norm(state) / rows[number]["first_state"], 1.0, places=12)
            known = {tuple(point): place for place, point in enumerate(before.points)}
            kept = [(known[tuple(point)], place) for place, point in enumerate(after.points) if tuple(point) in known]
            self.assertGreater(len(kept), 0.9 * len(before.points))  # Others may have been moved.
            old, new = np.array(kept).T
            np.testing.assert_array_equal(before.point_data["velocity"][old], after.point_data["velocity"][new])
            self.assertLess(len(kept), len(after.points))
            speeds = np.linalg.norm(state[:, :3], axis=1)
            self.assertGreater(np.delete(speeds, new).max(), 0.5)

    def test_same_on_one_rank(self):
        """Drag and indicator, cell for cell, but for the tolerance of the linear solver."""
        start, output = (os.path.join(self.folder, *path) for path in (("with_cad", "mesh0.vtu"), ("one_rank.vtu",)))
        result = run(os.path.join(EXAMPLE, "solve.py"), start, output, "--steps", TIME_STEPS, "--averaged",
                     TIME_STEPS // 3, "--report", output + ".json")
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(output + ".json", encoding="utf-8") as file:
            self.assertAlmostEqual(json.load(file)["drag"] / self.rows("with_cad")[0]["drag"], 1.0, places=3)
        one, two = meshio.read(output), self.mesh("flow", 0)
        one, two = (mesh.cell_data_dict["indicator"]["tetra"] for mesh in (one, two))
        np.testing.assert_allclose(one, two, rtol=0.01, atol=0.001 * two.max())

    def test_flow_keeps_to_the_wing_and_the_inflow(self):
        flow = self.mesh("flow", ROUNDS)
        velocity = flow.point_data["velocity"]
        tags = flow.cell_data_dict["gmsh:physical"]["triangle"]
        wing = np.unique(flow.cells_dict["triangle"][tags == 1])
        np.testing.assert_allclose(velocity[wing], 0.0, atol=1e-12)
        inflow = flow.points[:, 0] == flow.points[:, 0].min()
        np.testing.assert_allclose(velocity[inflow][:, 0], 1.0, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
