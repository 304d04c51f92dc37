#!/usr/bin/python3
"""What the driver's pictures show, of which side and on which scale: on bodies made of numbers, without a run."""

import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "plugin"))

from cadrefine import drawing, views
from cadrefine.facets import FACE, Facets
from cadrefine.formats.grid import make_grid, to_vtk

TRIANGLE = 5
BODY, OTHER = 0, 1  # CAD faces.


def triangles(rows, columns):
    """Of a lattice of points, seen from where rows and columns turn to the left."""
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    return np.vstack([np.column_stack([corner, corner + columns, corner + columns + 1]),
                      np.column_stack([corner, corner + columns + 1, corner + 1])])


def sphere(radius, distance, out=True):
    """Points, triangles whose normals point out, or in, and distances from the CAD."""
    latitude, longitude = np.meshgrid(np.linspace(0.01, np.pi - 0.01, 9), np.linspace(0, 2 * np.pi, 17), indexing="ij")
    points = radius * np.column_stack([(np.sin(latitude) * np.cos(longitude)).ravel(),
                                       (np.sin(latitude) * np.sin(longitude)).ravel(), np.cos(latitude).ravel()])
    cells = triangles(9, 17)
    return points, cells if out else cells[:, ::-1], np.full(len(cells), distance)


def plane(half, distances=lambda middles: 0.0):
    x, y = np.meshgrid(np.linspace(-half, half, 9), np.linspace(-half, half, 9), indexing="ij")
    points, cells = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()]), triangles(9, 9)
    return points, cells, np.zeros(len(cells)) + distances(points[cells].mean(axis=1))


def facets_of(*parts, of_volumes=True):
    """Each part is a CAD face of its own."""
    starts = np.cumsum([0] + [len(points) for points, _, _ in parts])
    cells = np.vstack([part[1] + start for part, start in zip(parts, starts)])
    points = np.vstack([part[0] for part in parts])
    distance = np.concatenate([part[2] for part in parts])
    grid = make_grid(points, np.full(len(cells), TRIANGLE), 3 * np.arange(len(cells) + 1), cells.ravel())
    arrays = {"GeometricError": distance**2, "GeometricDistance": distance,
              "CADDimension": np.full(len(cells), FACE),
              "CADEntity": np.repeat(np.arange(len(parts)), [len(part[1]) for part in parts])}
    for name, values in arrays.items():
        grid.GetCellData().AddArray(to_vtk(name, values))
    return Facets(grid, len(parts), flat=False, quadratic=False, of_volumes=of_volumes)


def scene_of(facets, focus=None, view=None):
    return views.Scene(facets, facets, focus, view)


class Shown(unittest.TestCase):
    def shown(self, *parts, **options):
        """The CAD faces that are drawn, and those that are coloured."""
        facets = facets_of(*parts)
        scene = scene_of(facets, **options)
        drawn, coloured = scene.shows(facets), np.isfinite(scene.values(facets))
        return set(facets.face[drawn].tolist()), set(facets.face[drawn & coloured].tolist())

    def test_a_far_field_is_left_out(self):
        self.assertEqual(self.shown(sphere(1, 0.01, out=False), sphere(30, 1.0)), ({BODY}, {BODY}))

    def test_a_shell_that_is_no_far_field_is_not(self):
        self.assertEqual(self.shown(sphere(1, 0.01, out=False), sphere(3, 0.1)), ({BODY, OTHER}, {BODY, OTHER}))

    def test_what_is_inside_of_a_large_body_does_not_make_it_a_far_field(self):
        """As the spinner in an aeroplane's inlet."""
        self.assertEqual(self.shown(sphere(1, 0.01, out=False), sphere(30, 1.0, out=False))[0], {BODY, OTHER})
        self.assertEqual(self.shown(sphere(1, 0.01), sphere(30, 1.0))[0], {BODY, OTHER})

    def test_a_mesh_of_triangles_has_no_far_field(self):
        facets = facets_of(sphere(1, 0.01, out=False), sphere(30, 1.0), of_volumes=False)
        self.assertTrue(scene_of(facets).shows(facets).all())

    def test_a_box_far_off_shows_it(self):
        body = [-1, 1, -1, 1, -1, 1]
        outside = [20, 40, -10, 10, -10, 10]
        self.assertEqual(self.shown(sphere(1, 0.01, out=False), sphere(30, 1.0), focus=body)[0], {BODY})
        self.assertEqual(self.shown(sphere(1, 0.01, out=False), sphere(30, 1.0), focus=outside)[0], {BODY, OTHER})

    def test_flat_faces_are_grey_and_shown_where_they_are_near(self):
        self.assertEqual(self.shown(sphere(1, 0.01), plane(1.2)), ({BODY, OTHER}, {BODY}))
        self.assertEqual(self.shown(sphere(1, 0.01), plane(20)), ({BODY}, {BODY}))

    def test_flat_faces_are_flat_beside_curved_ones(self):
        """Where a cell has a facet on each, both have its error."""
        def at_the_rim(middles):
            return 0.01 * (np.linalg.norm(middles, axis=1) > 0.5)

        self.assertEqual(self.shown(sphere(1, 0.01), plane(1.2, at_the_rim)), ({BODY, OTHER}, {BODY}))

    def test_strips_that_are_too_coarse_to_bend_are_not_flat(self):
        self.assertEqual(self.shown(sphere(1, 0.01), plane(1.2, lambda _: 0.01))[1], {BODY, OTHER})

    def test_faces_that_coarse_facets_span_are_shown_at_the_end(self):
        body = sphere(1, 0.01)
        first, last = facets_of(body), facets_of(sphere(1, 0.001))
        first.faces = last.faces = 2
        last.face[::2] = OTHER
        scene = views.Scene(first, last, None, None)
        for each in (first, last):
            self.assertTrue(scene.shows(each).all())
            self.assertTrue(np.isfinite(scene.values(each)).all())

    def test_everything_is_shown_where_nothing_is_curved(self):
        self.assertEqual(self.shown(plane(1), plane(50)), ({BODY, OTHER}, set()))

    def test_a_mesh_off_the_cad_is_shown(self):
        facets = facets_of(sphere(1, 0.0))
        facets.face[:] = -1
        self.assertTrue(scene_of(facets).shows(facets).all())

    def test_a_mesh_in_the_plane_is_shown_round_its_error(self):
        part = plane(10, lambda middles: 0.1 * (np.linalg.norm(middles, axis=1) < 2.5))
        facets = facets_of(part)
        facets.flat, facets.face, facets.faces = True, np.full(facets.count, -1), 0
        scene = scene_of(facets)
        self.assertTrue(scene.shows(facets).all())
        self.assertEqual(np.isfinite(scene.values(facets)).sum(), (part[2] > 0).sum())
        self.assertLess(np.abs(scene.points).max(), 8)
        self.assertEqual(scene.view, views.IN_PLANE)


class Side(unittest.TestCase):
    def view(self, out, side):
        points, cells, _ = sphere(1, 0.0, out)
        distance = np.where(points[cells].mean(axis=1) @ side > 0.5, 0.1, 0.001)
        return scene_of(facets_of((points, cells, distance))).view

    def test_it_is_the_one_with_the_error(self):
        for out in (True, False):
            for side in ((1, 1, -1), (1, -1, 1), (-1, -1, 1)):
                np.testing.assert_array_equal(np.sign(self.view(out, np.array(side))), side)

    def test_it_is_the_usual_one_where_all_are_alike(self):
        self.assertEqual(scene_of(facets_of(sphere(1, 0.1))).view, views.DEFAULT_VIEW)

    def test_it_is_the_one_that_is_wanted(self):
        self.assertEqual(scene_of(facets_of(sphere(1, 0.1)), view=(1, 2, 3)).view, (1, 2, 3))


class Scale(unittest.TestCase):
    def labels(self, first, last):
        return drawing.Colours(np.array(first), np.array(last)).labels

    def test_it_holds_both_pictures(self):
        np.testing.assert_allclose(self.labels([0.03, 0.004], [0.004, 0.0006, np.nan]), [0.05, 0.005, 5e-4])
        np.testing.assert_allclose(self.labels([1e-3], [2e-3, 1e-3]), [2e-3, 1.6e-3, 1.2e-3, 8e-4, 4e-4, 0])

    def test_it_ends_somewhere(self):
        np.testing.assert_allclose(self.labels([1.0], [0.0, 1e-12]), [1, 0.1, 0.01, 1e-3, 1e-4])

    def test_nothing_to_colour(self):
        for nothing in ([], [np.nan], [0.0]):
            self.assertEqual(self.labels(nothing, nothing)[0], 1.0)


if __name__ == "__main__":
    unittest.main()
