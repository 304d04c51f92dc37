#!/usr/bin/python3
"""The files of data/ are what the programs beside them make, and what they say they are."""

import os
import subprocess
import sys
import tempfile
import unittest

import driver
import gmsh
import meshio
import numpy as np

sys.path.insert(0, driver.DATA)
from coarse_mesh import boundary_faces  # noqa: E402
from vtu import mean_ratio  # noqa: E402

MADE_BY = "4.8"  # gmsh that the meshes of data/ are of: another one meshes the same shapes, but not to the same cells.
GMSH = ".".join(gmsh.__version__.split(".")[:2])
PROGRAMS = {
    "naca0012_sharp.igs": ["naca0012.py"],
    "naca0012_blunt.igs": ["naca0012.py", "--trailing-edge", "blunt"],
    "naca0012_coarse.vtu": ["naca0012_mesh.py"],
    "naca0012_blunt_coarse.vtu": ["naca0012_mesh.py", "--trailing-edge", "blunt"],
    "three_arcs.igs": ["three_arcs.py"],
    "three_arcs_nurbs.igs": ["three_arcs.py", "--nurbs"],
    "three_arcs_coarse.vtu": ["three_arcs.py"],
    "part_coarse.vtu": ["solid_mesh.py", "part"],
    "ball_coarse.vtu": ["solid_mesh.py", "ball"],
    "cylinder_coarse.vtu": ["solid_mesh.py", "cylinder"],
}
MESHES = [name for name in PROGRAMS if name.endswith(".vtu")]


def rounded_cylinder(x, y, z):
    """Distance from the surface of cylinder.brep."""
    outside = np.array([np.hypot(x, y), np.abs(z - 1)]) - 0.95
    return np.abs(np.hypot(*np.maximum(outside, 0)) + np.minimum(outside.max(axis=0), 0) - 0.05)


def part(x, y, z):
    """Distance from the nearest surface of the part: planes, hole and cavity."""
    return np.min([*np.abs([x, y, z]), *np.abs([x - 2, y - 2, z - 2]), np.abs(np.hypot(x - 1.5, y - 1.5) - 0.2),
                   np.abs(np.sqrt((x - 0.7)**2 + (y - 0.7)**2 + (z - 1)**2) - 0.3)], axis=0)


def ball(x, y, z):
    return np.abs(np.sqrt(x**2 + y**2 + z**2) - 2)


# Mesh of a solid: distance from its surface, and its volume.
SOLIDS = {
    "part_coarse.vtu": (part, 8 - 2 * np.pi * 0.2**2 - 4 / 3 * np.pi * 0.3**3),
    "ball_coarse.vtu": (ball, 4 / 3 * np.pi * 2**3),
    "cylinder_coarse.vtu": (rounded_cylinder, 2 * np.pi),
}


def boundary(cells):
    """Vertices of the facets or edges that belong to one cell only."""
    if cells.shape[1] == 4:
        return np.unique(boundary_faces(cells))
    edges, count = np.unique(np.sort(cells[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0,
                             return_counts=True)
    return np.unique(edges[count == 1])


def sizes(points, cells):
    """Areas of triangles of the plane z = 0, volumes of tetrahedra."""
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    return np.linalg.det(edges) / 6 if cells.shape[1] == 4 else np.cross(edges[:, 0], edges[:, 1])[:, 2] / 2


def sorted_points(points):
    return np.array(sorted(map(tuple, points.round(8) + 0.0)))


def lines_of(path):
    with open(path, encoding="ascii") as file:
        return file.read().splitlines()


def make(name, path, *options):
    program, *arguments = PROGRAMS[name]
    subprocess.run(["/usr/bin/python3", "-B", driver.data(program), *arguments, *options, path], check=True,
                   stdout=subprocess.DEVNULL, timeout=driver.TIMEOUT)


class Meshes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Points and cells of the meshes that the programs make here, and of the files."""
        cls.made, cls.kept = {}, {}
        with tempfile.TemporaryDirectory() as folder:
            for name in MESHES:
                path = os.path.join(folder, name)
                make(name, path)
                for meshes, file in ((cls.made, path), (cls.kept, driver.data(name))):
                    mesh = meshio.read(file)
                    meshes[name] = mesh.points, mesh.cells[0].data

    @unittest.skipUnless(GMSH == MADE_BY, f"the meshes of data/ are of gmsh {MADE_BY}, this is {GMSH}")
    def test_same_gmsh_makes_the_same(self):
        for name in MESHES:
            with self.subTest(name):  # The mesh generator's last digits are its own business.
                (points, cells), (kept_points, kept_cells) = self.made[name], self.kept[name]
                self.assertTrue(np.allclose(points, kept_points, rtol=0, atol=1e-9))
                self.assertTrue((cells == kept_cells).all())

    def test_any_gmsh_makes_sound_cells(self):
        for meshes in (self.made, self.kept):
            for name, (points, cells) in meshes.items():
                with self.subTest(name, points=len(points)):
                    self.assertGreater(sizes(points, cells).min(), 0)
                    self.assertGreater(mean_ratio(points, cells).min(), 0.03)

    def test_any_gmsh_keeps_the_vertices_of_the_boundary_where_the_program_gives_them(self):
        for name in set(MESHES) - set(SOLIDS):
            with self.subTest(name):
                (points, cells), (kept_points, kept_cells) = self.made[name], self.kept[name]
                self.assertEqual((len(points), len(cells)), (len(kept_points), len(kept_cells)))
                made, kept = sorted_points(points[boundary(cells)]), sorted_points(kept_points[boundary(kept_cells)])
                self.assertTrue(np.allclose(made, kept, rtol=0, atol=1e-7))

    def test_any_gmsh_meshes_the_solids(self):
        for name, (distance, volume) in SOLIDS.items():
            for points, cells in (self.made[name], self.kept[name]):
                with self.subTest(name, points=len(points)):
                    self.assertLess(distance(*points[boundary(cells)].T).max(), 1e-9)
                    self.assertAlmostEqual(sizes(points, cells).sum() / volume, 1, delta=0.25)  # The ball: -0.23
                    self.assertAlmostEqual(len(points) / len(self.kept[name][0]), 1, delta=0.1)
                    self.assertAlmostEqual(len(cells) / len(self.kept[name][1]), 1, delta=0.2)


class Data(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def test_programs_make_the_cad(self):
        for name in PROGRAMS:
            if name.endswith(".igs"):
                with self.subTest(name):
                    path = os.path.join(self.folder, name)
                    make(name, path)
                    self.assertEqual(lines_of(path), lines_of(driver.data(name)))

    def test_iges_records(self):
        for name in PROGRAMS:
            if not name.endswith(".igs"):
                continue
            with self.subTest(name):
                lines = lines_of(driver.data(name))
                self.assertEqual({len(line) for line in lines}, {80})
                sections = "".join(line[72] for line in lines)
                counts = {letter: sections.count(letter) for letter in "SGDP"}
                self.assertEqual(lines[-1][:32], "".join(f"{key}{counts[key]:7d}" for key in "SGDP"))
                self.assertEqual(sections, "".join(key * counts[key] for key in "SGDP") + "T")

    def test_wing_is_38_surfaces_and_their_borders(self):
        for name in ("naca0012_sharp.igs", "naca0012_blunt.igs"):
            kinds = [line[:8].strip() for line in lines_of(driver.data(name)) if line[72] == "D"][::2]
            self.assertEqual((kinds.count("128"), kinds.count("126"), len(kinds)), (38, 95, 133))

    def test_wing_meshes(self):
        from naca0012 import CHORD, half_thickness

        for around in (22, 41, 60):
            with self.subTest(around=around):
                path = os.path.join(self.folder, "mesh.vtu")
                make("naca0012_coarse.vtu", path, "--around", str(around), "--boundary-triangles")
                mesh = meshio.read(path)
                self.assertGreater(mean_ratio(mesh.points, mesh.cells_dict["tetra"]).min(), 0.02)
                triangles = mesh.cells_dict["triangle"]
                tags = mesh.cell_data_dict["gmsh:physical"]["triangle"]
                wing = mesh.points[np.unique(triangles[tags == 1])] / CHORD
                self.assertEqual(len(wing), 3 * around)
                inside = wing[(wing[:, 0] > 0.02) & (wing[:, 0] < 0.95)]
                offset = np.abs(inside[:, 2]) - [half_thickness(x) for x in inside[:, 0]]
                self.assertGreater(np.abs(offset).min(), 1e-5)
                self.assertLess(np.abs(offset).max(), 0.01)


def parameters(path):
    """The numbers of each entity of an IGES file, the parts of a plane in an order that does not depend on them."""
    texts = {}
    for line in lines_of(path):
        if line[72] == "P":
            texts[line[64:72]] = texts.get(line[64:72], "") + line[:64]
    entities = ([float(value) for value in text.replace(";", ",").split(",") if value.strip()]
                for text in texts.values())
    return [plane(entity) if is_plane(entity) else entity for entity in entities]


def is_plane(entity):
    """A B-spline surface of four poles."""
    return entity[:5] == [128, 1, 1, 1, 1]


def plane(entity):
    """Its flags, the lengths of its sides' parameters, weights and corners: of a fitted plane Open CASCADE 7.6 and 7.8
    choose other directions and another origin."""
    knots, weights, ends = entity[10:18], entity[18:22], entity[34:38]
    assert ends == [knots[0], knots[3], knots[4], knots[7]] and knots[::2] == knots[1::2], entity
    corners = sorted(zip(*[iter(entity[22:34])] * 3), key=lambda corner: [round(c, 5) for c in corner])
    sides = sorted([knots[3] - knots[0], knots[7] - knots[4]])
    return [*entity[:10], *sides, *weights, *(c for corner in corners for c in corner)]


def entity_types(path):
    return [line[:8] for line in lines_of(path) if line[72] == "D"][::2]


class Aeroplane(unittest.TestCase):
    """Its programs may differ in last digits from processor to processor."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def make(self, *arguments):
        subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL, timeout=driver.TIMEOUT)

    def test_program_makes_the_cad(self):
        made, kept = os.path.join(self.folder, "aeroplane.igs"), driver.data("aeroplane.igs")
        self.make(os.environ["CADREFINE_AEROPLANE"], made)
        self.assertEqual(entity_types(made), entity_types(kept))
        self.assertEqual({line[:8].strip(): entity_types(kept).count(line) for line in ("     128", "     144")},
                         {"128": 962, "144": 136})
        made, kept = parameters(made), parameters(kept)
        self.assertEqual([len(entity) for entity in made], [len(entity) for entity in kept])
        self.assertTrue(np.allclose(np.concatenate(made), np.concatenate(kept), rtol=0, atol=1e-6))

    def test_programs_make_the_mesh(self):
        solid, made = (os.path.join(self.folder, name) for name in ("aeroplane.brep", "aeroplane.vtu"))
        self.make(os.environ["CADREFINE_AEROPLANE"], "--plain", solid)
        self.make("/usr/bin/python3", "-B", driver.data("aeroplane_mesh.py"), "--boundary-triangles", solid, made)
        made, kept = meshio.read(made), meshio.read(driver.data("aeroplane_coarse.vtu"))
        same_gmsh = GMSH == MADE_BY
        self.assertAlmostEqual(len(made.points) / len(kept.points), 1, delta=0.02 if same_gmsh else 0.05)
        tags = made.cell_data_dict["gmsh:physical"]["triangle"]
        around = made.points[np.unique(made.cells_dict["triangle"][tags == 1])]
        low, high = np.array([[0.05, -0.25, -0.2], [0.2, 0.25, 0.2]])
        nose = ((around >= low) & (around <= high)).all(axis=1).sum()
        self.assertAlmostEqual(nose, 1269, delta=60 if same_gmsh else 150)
        self.assertTrue(np.allclose(np.abs(around).max(axis=0), [2, 0.95, 0.45], rtol=0, atol=0.01))


if __name__ == "__main__":
    unittest.main()
