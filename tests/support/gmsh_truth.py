#!/usr/bin/python3
"""Meshes whose every boundary node is known to lie on some CAD entity, moved off it a little.

usage: gmsh_truth.py FOLDER [SOLID or SURFACE ...]

For each solid writes the CAD file FOLDER/SOLID.brep and, at two sizes, the meshes FOLDER/SOLID_coarse.vtu and
FOLDER/SOLID_fine.vtu of tetrahedra. Each node is moved in a random direction (of a fixed seed) by up to 5% of the mean
length of its edges. Of a wing with a blunt trailing edge, which is thinner than that, writes three sizes moved by up to
2% with three seeds each, FOLDER/blunt_wing_SIZE_SEED.vtu; moving inverts some of its cells. Of the wing and of each
solid that is read from a file, writes FOLDER/SOLID.vtu, with its nodes where gmsh put them. Point arrays:
TruthDimension and TruthTag, the dimension and tag of gmsh's entity that the node belongs to (3: inside);
ExactPosition, where gmsh had put it. Of surfaces that are read from files, writes FOLDER/SURFACE.vtu with triangles,
where nodes of different faces that lie in one place are one; of solids in TAGGED, the boundary triangles as well.
"""

import math
import os
import sys

import gmsh
import meshio
import numpy as np

# In parts of the mean length of a node's edges.
LARGEST_MOVE = 0.05
LARGEST_MOVE_OF_WING = 0.02
TRIANGLE, TETRAHEDRON = 2, 4  # Types of gmsh.
CORNERS = {TRIANGLE: 3, TETRAHEDRON: 4}
occ = gmsh.model.occ


def naca_half_thickness(x, thickness):
    """NACA four-digit series of chord 1 with a sharp trailing edge (last coefficient -0.1036)."""
    return 5 * thickness * (0.2969 * math.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)


def section_curves(thickness, chord=1.0, nose=(0.0, 0.0, 0.0)):
    """Upper and lower curve of a section in the plane y = nose[1], from the nose to the sharp trailing edge."""
    stations = [(1 - math.cos(math.pi * i / 20)) / 2 for i in range(21)]
    front = occ.addPoint(*nose)
    back = occ.addPoint(nose[0] + chord, nose[1], nose[2])
    curves = []
    for side in (1, -1):
        inner = [occ.addPoint(nose[0] + chord * x, nose[1], nose[2] + side * chord * naca_half_thickness(x, thickness))
                 for x in stations[1:-1]]
        curves.append(occ.addBSpline([front, *inner, back]))
        occ.remove([(0, point) for point in inner])
    return curves


def box_minus_cylinder():
    return occ.cut([(3, occ.addBox(0, 0, 0, 2, 1.5, 1))], [(3, occ.addCylinder(0.9, 0.7, -1, 0, 0, 3, 0.4))])[0]


def two_cones():
    """One upon the other, with an apex each."""
    return occ.fuse([(3, occ.addCone(0, 0, 0, 0, 0, 1.2, 1, 0))], [(3, occ.addCone(0, 0, 0, 0, 0, -0.8, 1, 0))])[0]


def filleted_box():
    box = occ.addBox(0, 0, 0, 2, 1.5, 1)
    occ.synchronize()
    edges = [tag for _, tag in gmsh.model.getBoundary([(3, box)], combined=False, recursive=False) for _, tag in
             gmsh.model.getBoundary([(2, abs(tag))], oriented=False)]
    return occ.fillet([box], sorted(set(edges)), [0.3])


def half_cylinder():
    """Two edges are between the same two faces."""
    cylinder = occ.addCylinder(0, 0, 0, 0, 0, 1.5, 0.6)
    return occ.intersect([(3, cylinder)], [(3, occ.addBox(-1, 0, -1, 2, 2, 4))])[0]


def torus_segment():
    return [(3, occ.addTorus(0, 0, 0, 1.5, 0.5, angle=2 * math.pi / 3))]


def naca_section():
    """The sides of a section between two walls; the air round it is meshed."""
    curves = section_curves(0.12)
    sides = occ.extrude([(1, curve) for curve in curves], 0, 0.5, 0)
    return [entity for entity in sides if entity[0] == 2]


def air_round_section():
    loop = occ.addCurveLoop(section_curves(0.12))
    wing = [entity for entity in occ.extrude([(2, occ.addPlaneSurface([loop]))], 0, 0.5, 0) if entity[0] == 3]
    occ.cut([(3, occ.addBox(-0.7, 0, -0.7, 2.4, 0.5, 1.4))], wing)


def thin_wing():
    """A wing of 4% that tapers to its tip."""
    loops = [occ.addCurveLoop(section_curves(0.04)),
             occ.addCurveLoop(section_curves(0.04, 0.6, (0.3, 1.2, 0.0)))]
    return [entity for entity in occ.addThruSections(loops, makeSolid=True, makeRuled=True) if entity[0] == 3]


def air_round_wing():
    wing = thin_wing()
    occ.cut([(3, occ.addBox(-0.6, -0.5, -0.6, 2.2, 2.2, 1.2))], wing)


def blunt_section(chord, nose):
    """A section of 12% with a trailing edge of 0.25%, of five curves: fore and aft of 30% of the chord on both sides."""
    def point(x, side):
        return occ.addPoint(nose[0] + chord * x, nose[1], nose[2] + side * chord * (
            naca_half_thickness(x, 0.12) + 0.00126 * x**4))

    def curve(first, last, side, begin, end):
        stations = [(1 - math.cos(math.pi * i / 20)) / 2 for i in range(1, 20)]
        inner = [point(x, side) for x in stations if begin < x < end]
        spline = occ.addBSpline([first, *(inner if side > 0 else inner[::-1]), last])
        occ.remove([(0, tag) for tag in inner])
        return spline

    front = occ.addPoint(*nose)
    (upper, upper_back), (lower, lower_back) = [[point(x, side) for x in (0.3, 1)] for side in (1, -1)]
    return occ.addWire([curve(front, upper, 1, 0, 0.3), curve(upper, upper_back, 1, 0.3, 1),
                        occ.addLine(upper_back, lower_back),
                        curve(lower_back, lower, -1, 0.3, 1), curve(lower, front, -1, 0, 0.3)])


def blunt_wing():
    """Two panels with a kink between them: 12 faces, two of which are the trailing edge."""
    panels = [occ.addThruSections([blunt_section(*root), blunt_section(*tip)], makeSolid=True, makeRuled=True)
              for root, tip in (((1, (0, 0, 0)), (0.7, (0.2, 1, 0))), ((0.7, (0.2, 1, 0)), (0.4, (0.6, 2, 0.1))))]
    inner, outer = [[entity for entity in panel if entity[0] == 3] for panel in panels]
    return occ.fuse(inner, outer)[0]


# Solid: what makes the CAD file, what makes the domain of the mesh (none: the same), sizes of cells. The size near
# the CAD is given where the domain is the air round it; it is a quarter of that far away.
SOLIDS = {
    "box_minus_cylinder": (box_minus_cylinder, None, (0.3, 0.15)),
    "two_cones": (two_cones, None, (0.35, 0.15)),
    "filleted_box": (filleted_box, None, (0.2, 0.12)),
    "half_cylinder": (half_cylinder, None, (0.3, 0.12)),
    "torus_segment": (torus_segment, None, (0.3, 0.15)),
    "naca_section": (naca_section, air_round_section, (0.1, 0.05)),
    "thin_wing": (thin_wing, air_round_wing, (0.12, 0.06)),
}


WING_SIZES = {"coarse": 0.12, "medium": 0.09, "fine": 0.06}
WING_SEEDS = (1, 2, 3)

# Solid: its file, and the size of cells.
FILES = {
    "bottle": ("/usr/share/opencascade/data/occ/bottle.brep", 4.7),
    "crank_arm": ("/usr/share/opencascade/data/occ/CrankArm.brep", 7.7),
    "crank_arm_coarse": ("/usr/share/opencascade/data/occ/CrankArm.brep", 12.25),
    "linkrods_coarse": ("/usr/share/opencascade/data/step/linkrods.step", 0.6),
    "crank_arm_tagged": ("/usr/share/opencascade/data/occ/CrankArm.brep", 12.25),
}
TAGGED = ("crank_arm_tagged",)


# Surface: its file, the size of cells in parts of the size of the surface, and whether gmsh is to sew its faces (which
# makes slivers of those of the bearing).
SURFACES = {
    "hammer_surface": ("/usr/share/opencascade/data/iges/hammer.iges", 0.1, True),
    "bearing_surface": ("/usr/share/opencascade/data/iges/bearing.iges", 0.2, False),
}


def write_cad(path, make):
    gmsh.clear()
    make()
    occ.synchronize()
    gmsh.write(path)


def mesh_domain(make, size, graded):
    """Points, tetrahedra, and the entity of each point."""
    gmsh.clear()
    make()
    occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", 4 * size if graded else size)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0)
    if graded:
        far = gmsh.model.getBoundingBox(-1, -1)
        inner = [entity for entity in gmsh.model.getEntities(0)
                 if all(min(abs(c - low), abs(c - high)) > 1e-6 for c, low, high in
                        zip(gmsh.model.getValue(0, entity[1], [])[::2], far[:3:2], far[3::2]))]
        gmsh.model.mesh.setSize(gmsh.model.getEntities(0), 4 * size)
        gmsh.model.mesh.setSize(inner, size)
    gmsh.model.mesh.generate(3)
    points, number = nodes()
    truth = np.full((len(points), 2), -1, dtype=np.int32)
    for dimension, tag in gmsh.model.getEntities():
        for node in gmsh.model.mesh.getNodes(dimension, tag)[0]:
            truth[number[node]] = dimension, tag
    return points, cells_of(TETRAHEDRON, number), truth


def nodes():
    """Points of gmsh's mesh, and the places of its node tags among them."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    return coordinates.reshape(-1, 3), {tag: place for place, tag in enumerate(tags)}


def cells_of(kind, number, face=-1):
    """Corners of gmsh's cells of one type, of one face or all."""
    return np.vectorize(number.get)(gmsh.model.mesh.getElementsByType(kind, face)[1]).reshape(-1, CORNERS[kind])


def boundary_triangles():
    """Corners of the triangles on faces, and the face of each."""
    _, number = nodes()
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    triangles = [cells_of(TRIANGLE, number, face) for face in faces]
    return np.vstack(triangles), np.repeat(np.array(faces, dtype=np.int32), [len(part) for part in triangles])


def mean_edge_lengths(points, cells):
    pairs = np.vstack([cells[:, [i, j]] for i in range(4) for j in range(i)])
    pairs = np.unique(np.sort(pairs, axis=1), axis=0)
    lengths = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    total = np.bincount(pairs.ravel(), np.repeat(lengths, 2), len(points))
    return total / np.bincount(pairs.ravel(), minlength=len(points))


def volumes(points, cells):
    corners = points[cells]
    return np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6


def moved(points, cells, seed, largest):
    random = np.random.default_rng(seed)
    directions = random.normal(size=points.shape)
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    lengths = largest * random.random(len(points)) * mean_edge_lengths(points, cells)
    return points + lengths[:, None] * directions


def write_mesh(path, make, size, graded=False, seed=None, largest=LARGEST_MOVE, tagged=False):
    """Moves the nodes where there is a seed. `tagged`: lists the boundary triangles, with the tags of their faces."""
    points, cells, truth = mesh_domain(make, size, graded)
    used, cells = np.unique(cells, return_inverse=True)  # No nodes of curves that the mesh does not use.
    points, truth, cells = points[used], truth[used], cells.reshape(-1, 4)
    cells[volumes(points, cells) < 0] = cells[volumes(points, cells) < 0][:, [1, 0, 2, 3]]
    after = points if seed is None else moved(points, cells, seed, largest)
    blocks = [("tetra", cells)]
    tags = {}
    if tagged:
        triangles, faces = boundary_triangles()
        blocks.append(("triangle", np.searchsorted(used, triangles)))
        tags = {"gmsh:geometrical": [np.ones(len(cells), dtype=np.int32), faces]}
    meshio.write(path, meshio.Mesh(after, blocks, cell_data=tags, point_data={
        "TruthDimension": truth[:, 0], "TruthTag": truth[:, 1], "ExactPosition": points}))
    print(f"{os.path.basename(path)}: {len(points)} vertices, {np.count_nonzero(truth[:, 0] < 3)} on the boundary, "
          f"{len(cells)} tetrahedra, {np.count_nonzero(volumes(after, cells) <= 0)} inverted")


def write_wing(folder):
    path = os.path.join(folder, "blunt_wing")
    write_cad(path + ".brep", blunt_wing)
    write_mesh(path + ".vtu", blunt_wing, WING_SIZES["fine"])
    for label, size in WING_SIZES.items():
        for seed in WING_SEEDS:
            write_mesh(f"{path}_{label}_{seed}.vtu", blunt_wing, size, seed=seed, largest=LARGEST_MOVE_OF_WING)


def write_surface(path, file, part, sewn):
    gmsh.clear()
    occ.importShapes(file)
    if sewn:
        occ.healShapes(sewFaces=True, makeSolids=False)
    occ.synchronize()
    box = np.array(gmsh.model.getBoundingBox(-1, -1)).reshape(2, 3)
    size = part * np.max(box[1] - box[0])
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    gmsh.model.mesh.generate(2)
    points, number = nodes()
    cells = cells_of(TRIANGLE, number)
    places = np.round(points / (1e-6 * np.max(box[1] - box[0])))
    _, firsts, joined = np.unique(places, axis=0, return_index=True, return_inverse=True)
    cells = joined.reshape(-1)[cells]
    cells = cells[[len(set(cell)) == 3 for cell in cells]]
    used, cells = np.unique(cells, return_inverse=True)
    points, cells = points[firsts][used], cells.reshape(-1, 3)
    meshio.write(path, meshio.Mesh(points, [("triangle", cells)]))
    print(f"{os.path.basename(path)}: {len(points)} vertices, {len(cells)} triangles")


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    for name in sys.argv[2:] or FILES:
        if name in FILES:
            file, size = FILES[name]
            write_mesh(os.path.join(folder, f"{name}.vtu"), lambda file=file: occ.importShapes(file), size,
                       tagged=name in TAGGED)
    for name in sys.argv[2:] or SURFACES:
        if name in SURFACES:
            write_surface(os.path.join(folder, f"{name}.vtu"), *SURFACES[name])
    for name in sys.argv[2:] or SOLIDS:
        if name not in SOLIDS:
            continue
        cad, domain, sizes = SOLIDS[name]
        write_cad(os.path.join(folder, name + ".brep"), cad)
        for label, size in zip(("coarse", "fine"), sizes):
            write_mesh(os.path.join(folder, f"{name}_{label}.vtu"), domain or cad, size, domain is not None,
                       seed=1 + list(SOLIDS).index(name))
    if not sys.argv[2:] or "blunt_wing" in sys.argv[2:]:
        write_wing(folder)
    gmsh.finalize()


if __name__ == "__main__":
    main()
