#!/usr/bin/python3
"""What adaptive refinement saves, on a cylinder with small fillets."""

import sys
import unittest

import driver

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1
CYLINDER = (driver.data("cylinder_coarse.vtu"), driver.data("cylinder.brep"))


class Economy(unittest.TestCase):
    def test_economy(self):
        """Bulk marking reaches the error of four uniform levels with at most a third of their cells."""
        uniform = driver.report_of(RANKS, *CYLINDER, "--method", "uniform", "--steps", "4")["steps"][-1]
        bulk = ("--marking", "bulk", "--threshold", "0.3", "--cut-facets", "--steps", "40")
        report = driver.report_of(RANKS, *CYLINDER, *bulk, "--target-error", uniform["global_error"])
        adaptive = report["steps"][-1]
        self.assertLessEqual(adaptive["global_error"], uniform["global_error"])
        self.assertLessEqual(adaptive["cells"], uniform["cells"] / 3)
        self.assertEqual(adaptive["invalid_cells"], 0)
        self.assertLessEqual(adaptive["unprojected_vertices"], 0.001 * adaptive["cad_vertices"])


if __name__ == "__main__":
    unittest.main()
