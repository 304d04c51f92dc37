#!/usr/bin/python3
"""The nose of the aeroplane: 52 of 962 CAD faces, initial projection and refinement within a region."""

import sys
import unittest

import driver

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1
AEROPLANE = (driver.data("aeroplane_coarse.vtu"), driver.data("aeroplane.igs"))
NOSE = ("--region", 0.05, 0.2, -0.25, 0.25, -0.2, 0.2)


class Aeroplane(unittest.TestCase):
    def test_nose(self):
        report = driver.report_of(RANKS, *AEROPLANE, *NOSE, "--steps", "3", "--threshold", "1e-9")
        cad = report["cad"]
        self.assertEqual((cad["faces"], cad["unread"], cad["unit"]), (962, [], "m"))
        first = report["steps"][0]
        self.assertEqual((first["cad_vertices"], first["projected_points"]), (1269, 1269))
        errors = [step["global_error"] for step in report["steps"]]
        self.assertEqual(len(errors), 4)
        self.assertEqual(errors, sorted(errors, reverse=True))
        self.assertLess(errors[-1], 0.5 * errors[0])
        for step in report["steps"]:
            self.assertEqual((step["invalid_cells"], step["unprojected_vertices"]), (0, 0))
            self.assertGreater(step["minimum_quality"], 0.1)
        costs = first["costs"]["project"]
        self.assertGreater(costs["points imbalance before"], 1.5)
        self.assertLessEqual(costs["points imbalance after"], 1.1)
        for step in report["steps"][1:]:
            costs = step["costs"]["refine"]
            self.assertLessEqual(costs["new points imbalance after"], 1.1)
            self.assertLessEqual(costs["new cells imbalance after"], 1.1)


if __name__ == "__main__":
    unittest.main()
