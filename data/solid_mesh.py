#!/usr/bin/python3
"""Coarse tetrahedra in a part with a small round cavity, in a ball or in a filleted cylinder, with python3-gmsh.

The part: the box from (0, 0, 0) to (2, 2, 2) without a cylinder (axis x = y = 1.5, radius 0.2, all the way through) and
without a ball (centre (0.7, 0.7, 1), radius 0.3), which a dozen facets stand for. The ball: centre (0, 0, 0), radius 2.
The coarsest meshes of a ball have tetrahedra with two facets on it, which become ever flatter under refinement.
The cylinder: axis z, radius 1, from z = 0 to 2, both rims rounded with radius 0.05. With --cad its CAD is written too.
"""
import argparse

import gmsh

from coarse_mesh import finished_mesh
from vtu import mean_ratio, write_vtu


def make_part(occ):
    box = occ.addBox(0, 0, 0, 2, 2, 2)
    hole = occ.addCylinder(1.5, 1.5, 0, 0, 0, 2, 0.2)
    cavity = occ.addSphere(0.7, 0.7, 1, 0.3)
    occ.cut([(3, box)], [(3, hole), (3, cavity)])


def make_ball(occ):
    occ.addSphere(0, 0, 0, 2)


def make_cylinder(occ):
    cylinder = occ.addCylinder(0, 0, 0, 0, 0, 2, 1)
    occ.synchronize()
    circles = [curve for _, curve in gmsh.model.getEntities(1) if gmsh.model.getType(1, curve) == "Circle"]
    occ.fillet([cylinder], circles, [0.05])


def mesh_of(make, size, cad=None):
    """Points (n, 3) and tetrahedra of a solid, with edges of about `size`; writes the solid to the file `cad`."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    make(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    if cad:
        gmsh.write(cad)
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.model.mesh.generate(3)
    return finished_mesh()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=float, help="edge length (default 2 for the ball, else 0.5)")
    parser.add_argument("--cad", metavar="FILE.brep", help="write the solid too")
    parser.add_argument("solid", choices=("part", "ball", "cylinder"))
    parser.add_argument("output", help="the .vtu file")
    arguments = parser.parse_args()
    make, size = {"part": (make_part, 0.5), "ball": (make_ball, 2.0), "cylinder": (make_cylinder, 0.5)}[arguments.solid]
    points, cells = mesh_of(make, arguments.size or size, arguments.cad)
    write_vtu(arguments.output, points, [cells])
    quality = mean_ratio(points, cells)
    print(f"{arguments.output}: {len(points)} vertices, {len(cells)} tetrahedra, "
          f"quality {quality.min():.3f} to {quality.max():.3f}")


if __name__ == "__main__":
    main()
