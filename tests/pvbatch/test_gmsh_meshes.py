#!/usr/bin/python3
"""The driver on meshes that gmsh makes and saves by its defaults. Without physical groups it lists the surfaces of all
volumes: also those that are not in the CAD."""

import itertools
import json
import sys
import unittest

import driver
import gmsh
import meshio
import numpy as np

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1


def facets_in(mesh, axis, place, tolerance, shape="triangle"):
    """The facets of this shape in a plane across the axis."""
    facets = mesh.cells_dict[shape]
    return facets[(np.abs(mesh.points[:, axis] - place) < tolerance)[facets].all(axis=1)]


class GmshMeshes(driver.Case):
    def generate(self, dimension, make_cad, make_mesh, size, cad="cad.brep"):
        gmsh.initialize()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            for make, name in ((make_cad, cad), (make_mesh, "mesh.msh")):
                gmsh.clear()
                make()
                gmsh.model.occ.synchronize()
                if make is make_mesh:
                    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
                    gmsh.model.mesh.generate(dimension)
                gmsh.write(self.path(name))
        finally:
            gmsh.finalize()

    def expect_on_cad(self, ratio, mesh="mesh.msh", levels=2):
        report = driver.report_of(RANKS, self.path(mesh), self.path("cad.brep"), "--method", "uniform",
                                  "--steps", str(levels))
        errors = np.array([step["global_error"] for step in report["steps"]])
        self.assertEqual([step["unprojected_vertices"] for step in report["steps"]], [0] * (levels + 1))
        self.assertEqual([step["invalid_cells"] for step in report["steps"]], [0] * (levels + 1))
        self.assertGreater(min(errors[:-1] / errors[1:]), ratio)
        return report

    def test_thin_ring_of_tetrahedra(self):
        """Round a hole, thinner than the CAD bulges over a facet."""
        occ = gmsh.model.occ

        def box():
            return occ.cut([(3, occ.addBox(-3, -3, 0, 6, 6, 2))], [(3, occ.addCylinder(0, 0, -1, 0, 0, 4, 1))])[0]

        def with_ring():
            pieces = occ.fragment(box(), [(3, occ.addCylinder(0, 0, 0, 0, 0, 2, 1.02))])[0]
            occ.synchronize()
            occ.remove([piece for piece in pieces if gmsh.model.getBoundingBox(*piece)[3] < 1.01], recursive=True)

        self.generate(3, box, with_ring, 0.6)
        self.expect_on_cad(3.0)

    def test_layer_on_a_core(self):
        """In the plane, of quadrilaterals, on a disc that is meshed too: its rim is in the CAD."""
        occ = gmsh.model.occ

        def two_parts():
            occ.fragment([(2, occ.addRectangle(-3, -3, 0, 6, 6))], [(2, occ.addDisk(0, 0, 0, 1, 1))])

        def with_layer():
            middle = occ.addPoint(0, 0, 0)
            places = [(np.cos(angle), np.sin(angle)) for angle in np.arange(4) * np.pi / 2]
            rims = [[occ.addPoint(radius * x, radius * y, 0) for x, y in places] for radius in (1, 1.1)]
            arcs = [[occ.addCircleArc(rim[k], middle, rim[(k + 1) % 4]) for k in range(4)] for rim in rims]
            lines = [occ.addLine(*ends) for ends in zip(*rims)]
            corners = [occ.addPoint(x, y, 0) for x, y in ((-3, -3), (3, -3), (3, 3), (-3, 3))]
            sides = [occ.addLine(corners[k], corners[(k + 1) % 4]) for k in range(4)]
            inner, outer, square = (occ.addCurveLoop(curves) for curves in (*arcs, sides))
            occ.addPlaneSurface([inner])
            occ.addPlaneSurface([square, outer])
            parts = [occ.addPlaneSurface([occ.addCurveLoop([lines[k], arcs[1][k], lines[(k + 1) % 4], arcs[0][k]])])
                     for k in range(4)]
            occ.remove([(0, middle)])
            occ.synchronize()
            for k in range(4):
                for curve, count in ((arcs[0][k], 4), (arcs[1][k], 4), (lines[k], 2)):
                    gmsh.model.mesh.setTransfiniteCurve(curve, count)
                gmsh.model.mesh.setTransfiniteSurface(parts[k])
                gmsh.model.mesh.setRecombine(2, parts[k])

        self.generate(2, two_parts, with_layer, 1.0)
        self.expect_on_cad(3.9)

    def test_bodies_that_touch(self):
        """A ball in a shell in a box, on which a cylinder stands: the faces between them twice in the CAD, as in
        assemblies, and triangulated in two ways, with few vertices in common."""
        occ = gmsh.model.occ
        assembly = self.path("assembly.step")
        gmsh.initialize(["", "-v", "0"])
        occ.fragment([(3, occ.addBox(-3, -3, -3, 6, 6, 6))], [(3, occ.addCylinder(0, 0, 3, 0, 0, 2, 1.5))] +
                     [(3, occ.addSphere(0, 0, 0, radius)) for radius in (1, 1.8)])
        occ.synchronize()
        gmsh.write(assembly)
        gmsh.finalize()

        def bodies():
            occ.importShapes(assembly)

        self.generate(3, bodies, bodies, 0.7)
        self.expect_on_cad(3.5)

    def test_plane_in_space(self):
        """The same where the plane is turned: as in the plane z = 0, the error is an area."""
        occ = gmsh.model.occ

        def discs():
            parts = occ.fragment([(2, occ.addDisk(0, 0, 0, 1, 1))], [(2, occ.addDisk(0, 0, 0, 0.5, 0.5))])[0]
            occ.rotate(parts, 0, 0, 0, 1, 2, 3, 1.0)
            occ.synchronize()
            gmsh.model.mesh.setRecombine(*parts[0])
            gmsh.model.mesh.setReverse(*parts[0])

        self.generate(2, discs, discs, 0.3)
        report = self.expect_on_cad(3.9)
        self.assertEqual((report["dimension"], report["error_measure"]), (2, "area"))

    def test_hole_in_a_flat_part_of_a_shell(self):
        """The volume between mesh and CAD is zero, whatever the edges round the hole miss: a warning names the remedy,
        which refines there."""
        occ = gmsh.model.occ

        def shell():
            plate = occ.cut([(2, occ.addRectangle(-2, -2, 0, 4, 4))], [(2, occ.addDisk(0, 0, 0, 1, 1))])[0]
            wall = [(2, occ.addRectangle(-2, -2, 0, 4, 2))]
            occ.rotate(wall, -2, -2, 0, 1, 0, 0, np.pi / 2)
            occ.fragment(plate, wall)

        self.generate(2, shell, shell, 0.8)
        run = driver.Run(RANKS, self.path("mesh.msh"), self.path("cad.brep"), "--steps", "0")
        self.assertEqual(run.status, 0)
        self.assertIn("mark cells by ChordTolerance", "".join([run.output, *run.errors]))
        run = driver.Run(RANKS, self.path("mesh.msh"), self.path("cad.brep"), "--chord-tolerance", "0.01", "--steps", "9",
                         "--report", self.path("report.json"))
        with open(self.path("report.json"), encoding="utf-8") as file:
            steps = json.load(file)["steps"]
        self.assertGreater(steps[0]["maximum_distance"], 0.03)
        self.assertLessEqual(steps[-1]["maximum_distance"], 0.01)

    def test_bores_narrower_than_the_cells(self):
        """Where bores meet, the mesh leads across them: at an edge of four facets, which becomes two. It also has an
        ear, a triangle with all corners on one CAD edge, whose normal fits the face on the other side of that. In the
        other block an edge leads so far across that its middle is nearer to the other side of the bore."""
        occ = gmsh.model.occ

        def block(radius, y):
            whole = occ.addBox(0, 0, 0, 230, 110, 70)
            bores = [occ.addCylinder(-1, y, 34, 232, 0, 0, radius)]
            bores += [occ.addCylinder(40 + 70 * k, y + (-1) ** k * 3, 34, 0, 60, 0, 9) for k in range(3)]
            occ.cut([(3, whole)], [(3, bore) for bore in bores])
            gmsh.option.setNumber("Mesh.MeshSizeMin", 23)

        self.generate(3, lambda: block(7, 40), lambda: block(7, 40), 23, "cad.step")
        steps = driver.report_of(RANKS, self.path("mesh.msh"), self.path("cad.step"), "--steps", "8")["steps"]
        self.assertEqual(steps[-1]["unprojected_vertices"], 0)
        self.assertLess(steps[-1]["maximum_distance"], 1)
        self.generate(3, lambda: block(4.5, 22), lambda: block(4.5, 22), 23)
        report = self.expect_on_cad(3.3)
        self.assertEqual(report["fit"]["conflicts"], [])
        last = report["steps"][-1]
        self.assertGreater(last["minimum_quality"], 0.1)
        self.assertLess(last["maximum_distance"], 0.5)

    def test_fillet_narrower_than_its_rim_bulges(self):
        """The middle of an edge across the fillet is over the face beyond its rim."""
        occ = gmsh.model.occ

        def lens():
            balls = [occ.addSphere(0, 0, side * 0.8, 1.2) for side in (-1, 1)]
            occ.intersect([(3, balls[0])], [(3, balls[1])])
            occ.synchronize()
            (_, body), = gmsh.model.getEntities(3)
            edges = [edge for _, edge in gmsh.model.getEntities(1)]
            rim = [edge for edge in edges if np.abs(gmsh.model.getBoundingBox(1, edge)[2::3]).max() < 1e-6]
            occ.fillet([body], rim, [0.02])
            gmsh.option.setNumber("Mesh.MeshSizeMin", 0.35)

        self.generate(3, lens, lens, 0.35)
        report = self.expect_on_cad(3.3)
        self.assertLess(report["steps"][-1]["maximum_distance"], 4e-3)

    def test_gap_round_a_body(self):
        """The bore is not in the CAD, but nearer to it than half of a facet is long."""
        occ = gmsh.model.occ

        def piston():
            occ.addCylinder(0, 0, 0, 0, 0, 1, 0.5)

        def bore():
            piston()
            occ.cut([(3, occ.addCylinder(0, 0, -0.5, 0, 0, 2, 0.6))], [(3, 1)])

        self.generate(3, piston, bore, 0.25)
        self.expect_on_cad(3.9)
        # In the plane a tunnel, whose walls are 0.05 from the body, with facets of 0.3.
        self.generate(2, lambda: occ.addDisk(0, 0, 0, 0.5, 0.5),
                      lambda: occ.cut([(2, occ.addRectangle(-2, -0.55, 0, 5, 1.1))],
                                      [(2, occ.addDisk(0, 0, 0, 0.5, 0.5))]), 0.3)
        self.expect_on_cad(3.9)

    def test_walls_that_cut_the_cad(self):
        """They are not in the CAD, which goes on through them, and stay plane: those of a channel that turn by 55 degrees
        from a cylinder, and the floor under a sphere, by 26 degrees."""
        occ = gmsh.model.occ

        def cylinder():
            occ.addCylinder(-1, 0, -1.5, 2, 0, 3, 0.5)

        def sphere():
            occ.addSphere(0, 0, 0.9, 1)

        def around(body, height):
            body()
            occ.cut([(3, occ.addBox(-2.5, -2.5, 0, 5, 5, height))], [(3, 1)])

        for body, size, height, walls in (cylinder, 0.4, 1, (0, 1)), (sphere, 0.5, 2.5, (0,)):
            self.generate(3, body, lambda body=body, height=height: around(body, height), size)
            self.expect_planes(2, walls)
            self.expect_on_cad(3.5)

    def test_half_a_body_with_flat_ends(self):
        """A chord of an end leads across it in the plane of symmetry, from one side of its rim to the other."""
        occ = gmsh.model.occ

        def fuselage():
            rims = [occ.addCircle(0, 0, z, radius) for z, radius in ((0, 0.05), (1, 0.5), (2, 0.1))]
            occ.rotate([(1, rim) for rim in rims], 0, 0, 0, 0, 0, 1, np.pi / 2)
            occ.addThruSections([occ.addCurveLoop([rim]) for rim in rims])

        def half_around():
            fuselage()
            occ.cut([(3, occ.addBox(-2, 0, -2, 4, 2, 6))], [(3, 1)])

        self.generate(3, fuselage, half_around, 0.5)
        self.expect_planes(1, (0,))
        self.expect_on_cad(3.5)

    def test_shell_with_walls_that_are_not_in_the_cad(self):
        """A thin skin with a bulkhead in its middle and one at each end, whose triangles have all corners on the skin."""
        occ = gmsh.model.occ

        def skin():
            for side in (1, -1):
                arc = occ.addCircleArc(occ.addPoint(-0.5, 0, 0), occ.addPoint(0, side * -2, 0), occ.addPoint(0.5, 0, 0))
                for z in (0, 1):
                    part = occ.copy([(1, arc)])
                    occ.translate(part, 0, 0, z)
                    occ.extrude(part, 0, 0, 1)
                    occ.remove(part)
                occ.remove([(1, arc)])
            occ.removeAllDuplicates()

        def with_bulkheads():
            skin()
            for z in range(3):
                occ.synchronize()
                rim = [curve for _, curve in gmsh.model.getEntitiesInBoundingBox(-1, -1, z - 0.1, 1, 1, z + 0.1, 1)]
                occ.addPlaneSurface([occ.addCurveLoop(rim)])
            occ.removeAllDuplicates()

        self.generate(2, skin, with_bulkheads, 0.25)
        self.expect_planes(2, (0, 1, 2))
        self.expect_on_cad(3.5)

    def expect_planes(self, axis, places, shape="triangle"):
        """After one level, these planes of the mesh have their vertices, the midpoints of their edges and, in
        quadrilaterals, one more."""
        run = driver.Run(RANKS, self.path("mesh.msh"), self.path("cad.brep"), "--method", "uniform", "--steps", "1",
                         "--output", self.path("fine.vtu"))
        self.assertEqual(run.status, 0)
        coarse, fine = (meshio.read(self.path(name)) for name in ("mesh.msh", "fine.vtu"))
        for place in places:
            facets = facets_in(coarse, axis, place, 1e-9, shape)
            edges = {tuple(sorted((facet[k - 1], facet[k]))) for facet in facets for k in range(len(facet))}
            vertices = len(np.unique(facets)) + len(edges) + (len(facets) if shape == "quad" else 0)
            self.assertEqual(len(np.unique(facets_in(fine, axis, place, 1e-12, shape))), vertices)

    def test_layers_beside_the_end_of_a_body(self):
        """Planes of symmetry, which the ends of a solid cylinder continue. The lines of the layers lean, so that facets
        there do not become shorter when their corners are projected, only lower."""
        occ = gmsh.model.occ
        self.generate(3, lambda: occ.addCylinder(0, 0, 0, 0, 0, 1, 1), lambda: occ.addBox(0, 0, 0, 1, 1, 1), 1.0)
        around = 16
        heights = np.array([0, *0.01 * np.cumsum(1.5 ** np.arange(10)), 3])
        angles = 2 * np.pi * np.arange(around) / around + np.log1p(heights)[:, None]
        z, x, y = (np.stack([along] * 3) for along in (0 * angles, (1 + heights[:, None]) * np.cos(angles),
                                                       (1 + heights[:, None]) * np.sin(angles)))
        z += np.array([0, 0.5, 1])[:, None, None]
        numbers = np.arange(z.size).reshape(z.shape)
        beside = np.roll(numbers, -1, axis=2)
        square = [numbers[:, :-1], numbers[:, 1:], beside[:, 1:], beside[:, :-1]]
        hexahedra = np.stack([side[:-1] for side in square] + [side[1:] for side in square], axis=-1)
        meshio.Mesh(np.column_stack([x.ravel(), y.ravel(), z.ravel()]), [("hexahedron", hexahedra.reshape(-1, 8))]
                    ).write(self.path("mesh.vtu"))
        report = self.expect_on_cad(3.9, "mesh.vtu")
        self.assertEqual(report["fit"]["conflicts"], [])

    def test_layers_on_a_curved_surface(self):
        """Quadrilaterals round a hole in the wall of a cylinder. Over a chord its rim bulges by thirteen of their
        heights, so that the middles of the first ones are in the hole."""
        occ = gmsh.model.occ

        def ring():
            body = occ.addCylinder(0, 0, -1, 0, 0, 2, 1, angle=np.pi)
            occ.rotate([(3, body)], 0, 0, 0, 0, 0, 1, -np.pi / 2)
            occ.synchronize()
            wall = [face for face in gmsh.model.getBoundary([(3, body)], oriented=False) if
                    gmsh.model.getType(*face) == "Cylinder"]
            outer, inner = (occ.addCylinder(0, 0, 0, 2, 0, 0, radius) for radius in (0.7, 0.4))
            walls = occ.copy(wall)
            occ.remove([(3, body)], recursive=True)
            occ.intersect(walls, occ.cut([(3, outer)], [(3, inner)])[0])

        self.generate(2, ring, ring, 0.5)
        around = 12
        radii = 0.4 + np.array([0, *1e-3 * np.cumsum(1.5 ** np.arange(12)), 0.3])
        angles = 2 * np.pi * (np.arange(around) + 0.3) / around
        y, z = (np.outer(radii, way(angles)).ravel() for way in (np.cos, np.sin))
        first = (around * np.arange(len(radii) - 1)[:, None] + np.arange(around)).ravel()
        beside = first - first % around + (first + 1) % around
        meshio.Mesh(np.column_stack([np.sqrt(1 - y**2), y, z]),
                    [("quad", np.column_stack([first, first + around, beside + around, beside]))]
                    ).write(self.path("mesh.vtu"))
        report = self.expect_on_cad(3.8, "mesh.vtu", 3)
        self.assertGreater(report["steps"][-1]["minimum_quality"], 0.9)

    def test_wall_of_one_cell(self):
        """Hexahedra between two cylinders, over which these bulge by seven times as much as they are apart."""
        occ = gmsh.model.occ

        def pipe():
            occ.cut([(3, occ.addCylinder(0, 0, 0, 0, 0, 1.5, 1))], [(3, occ.addCylinder(0, 0, 0, 0, 0, 1.5, 0.995))])

        def with_hexahedra():
            side = [(2, occ.addRectangle(0.995, 0, 0, 0.005, 1.5))]
            occ.rotate(side, 0, 0, 0, 1, 0, 0, np.pi / 2)
            occ.rotate(side, 0, 0, 0, 0, 0, 1, np.pi / 12)  # the seams of the cylinders are over middles of facets
            for _ in range(2):
                side = occ.revolve(side, 0, 0, 0, 0, 0, 1, np.pi, numElements=[6], recombine=True)[:1]
            occ.removeAllDuplicates()
            occ.synchronize()
            for _, curve in gmsh.model.getEntities(1):
                gmsh.model.mesh.setTransfiniteCurve(curve, 2)
            for _, surface in gmsh.model.getEntities(2):
                gmsh.model.mesh.setTransfiniteSurface(surface)
                gmsh.model.mesh.setRecombine(2, surface)

        self.generate(3, pipe, with_hexahedra, 5.0)
        self.assertEqual(len(meshio.read(self.path("mesh.msh")).cells_dict["hexahedron"]), 12)
        self.expect_on_cad(3.9)

    def test_cells_swept_round_a_bend(self):
        """The CAD bulges over them by a quarter of their thickness, and by as much on the other side of the pipe."""
        occ = gmsh.model.occ

        def bend(**options):
            ring = occ.cut([(2, occ.addDisk(2, 0, 0, 0.5, 0.5))], [(2, occ.addDisk(2, 0, 0, 0.2, 0.2))])[0]
            occ.revolve(ring, 0, 0, 0, 0, 1, 0, np.pi / 2, **options)

        def of_cells(recombined):
            bend(numElements=[6], recombine=True)
            gmsh.option.setNumber("Mesh.RecombineAll", recombined)

        for recombined, shape in ((1, "hexahedron"), (0, "wedge")):
            self.generate(3, bend, lambda recombined=recombined: of_cells(recombined), 0.1)
            self.assertEqual(list(meshio.read(self.path("mesh.msh")).cells_dict)[-1], shape)
            steps = self.expect_on_cad(3.6)["steps"]
            self.assertGreater(steps[-1]["minimum_quality"], 0.75 * steps[0]["minimum_quality"])

    def test_flat_interface_between_hexahedra(self):
        """Columns from the wall end at it, as it is not in the CAD: also where cells alone tell it."""
        occ = gmsh.model.occ

        def with_interface(is_listed):
            halves = [(2, occ.addRectangle(-2, *side)) for side in ((-2, 0, 4, 2.8), (0.8, 0, 4, 1.2))]
            pieces = occ.cut(occ.fragment(halves[:1], halves[1:])[0], [(2, occ.addDisk(0, 0, 0, 0.5, 0.5))])[0]
            occ.extrude(pieces, 0, 0, 1, numElements=[3], recombine=True)
            gmsh.option.setNumber("Mesh.RecombineAll", 1)
            occ.synchronize()
            for tag, (_, volume) in enumerate(gmsh.model.getEntities(3) * (not is_listed), 1):
                gmsh.model.addPhysicalGroup(3, [volume], tag)

        def tunnel():
            occ.extrude([(1, occ.addCircle(0, 0, 0, 0.5))], 0, 0, 1)

        self.generate(3, tunnel, lambda: with_interface(True), 0.3)
        self.expect_planes(1, (0.8,), "quad")
        self.expect_on_cad(3.6)
        self.generate(3, tunnel, lambda: with_interface(False), 0.3)
        self.expect_interface("hexahedron", 1, 0.8)

    def expect_interface(self, shape, axis, place):
        """Expects a mesh that lists no facets; between its two materials it is flat, also when it is refined."""
        self.assertEqual(list(meshio.read(self.path("mesh.msh")).cells_dict), [shape])
        outputs = {self.path("adapted.vtu"): ("--steps", "3"),
                   self.path("uniform.vtu"): ("--method", "uniform", "--steps", "1")}
        driver.reports_of(RANKS, [[self.path("mesh.msh"), self.path("cad.brep"), *steps, "--no-boundary-cells",
                                   "--output", path] for path, steps in outputs.items()])
        for path in outputs:
            fine = meshio.read(path)
            of_tags = [set(), set()]
            for block, tags in zip(fine.cells, fine.cell_data["gmsh:physical"]):
                for tag in (1, 2):
                    of_tags[tag - 1].update(block.data[tags == tag].ravel())
            between = sorted(of_tags[0] & of_tags[1])
            self.assertGreater(len(between), 9)
            self.assertAlmostEqual(np.abs(fine.points[between, axis] - place).max(), 0, delta=1e-12)

    def test_flat_interface_that_cells_alone_tell(self):
        """Physical groups of volumes, none of surfaces: so no triangles are listed."""
        occ = gmsh.model.occ

        def two_materials():
            boxes = [(3, occ.addBox(-1, -1, *side)) for side in ((-1, 2, 2, 1.6), (0.6, 2, 2, 0.4))]
            occ.cut(occ.fragment(boxes[:1], boxes[1:])[0], [(3, occ.addSphere(0, 0, 0, 0.5))])
            occ.synchronize()
            for tag, (_, volume) in enumerate(gmsh.model.getEntities(3), 1):
                gmsh.model.addPhysicalGroup(3, [volume], tag)

        self.generate(3, lambda: occ.addSphere(0, 0, 0, 0.5), two_materials, 0.3)
        self.expect_interface("tetra", 2, 0.6)

    def test_one_cell_high(self):
        """Wedges on either side of an interface that is in the CAD, which is listed either way round: all of its
        vertices are on the CAD's edges."""
        occ = gmsh.model.occ

        def extrusion(**options):
            discs = occ.fragment([(2, occ.addDisk(0, 0, 0, 0.6, 0.6))], [(2, occ.addDisk(0, 0, 0, 1, 1))])[0]
            occ.extrude(discs, 0, 0, 1.5, **options)

        self.generate(3, extrusion, lambda: extrusion(numElements=[1], recombine=True), 0.5)
        self.expect_on_cad(3.7)
        cells = meshio.read(self.path("mesh.msh"))
        quads, wedges = cells.cells_dict["quad"], cells.cells_dict["wedge"]
        runs = []
        for way, digits in itertools.product((1, -1), (16, 5)):
            path = self.path(f"{way}-{digits}.vtu")
            meshio.Mesh(np.round(cells.points, digits), [("quad", quads[:, ::way]), ("wedge", wedges)]).write(path)
            runs.append([path, self.path("cad.brep"), "--steps", "0"])
        for report in driver.reports_of(RANKS, runs):
            self.assertEqual(report["fit"]["conflicts"], [])
            self.assertGreater(report["fit"]["cad_covered"], 0.9)


if __name__ == "__main__":
    unittest.main()
