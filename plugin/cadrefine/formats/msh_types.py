"""gmsh's types of cells, and VTK's."""

from cadrefine.formats.cells import inverse, order_of

VTK_TYPES = {15: 1, 1: 3, 8: 21, 2: 5, 9: 22, 3: 9, 16: 23, 4: 10, 11: 24, 5: 12, 17: 25, 6: 13, 18: 26, 7: 14, 19: 27}
GMSH_TYPES = {vtk: gmsh for gmsh, vtk in VTK_TYPES.items()}
REDUCED = {10: 16, 12: 17, 13: 18, 14: 19}  # Those that have nodes on sides or inside too: what they are without.
POINTS = {1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 6: 6, 7: 5, 8: 3, 9: 6, 10: 9, 11: 10, 12: 27, 13: 18, 14: 14, 15: 1, 16: 8,
          17: 20, 18: 15, 19: 13}
# Places of the nodes of cells, by VTK's types: gmsh has its own order of edges.
GMSH_ORDERS = {kind: order_of(kind, range(corners), edges) for kind, corners, edges in (
    (24, 4, ((0, 1), (1, 2), (2, 0), (0, 3), (2, 3), (1, 3))),
    (25, 8, ((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7))),
    (26, 6, ((0, 1), (0, 2), (0, 3), (1, 2), (1, 4), (2, 5), (3, 4), (3, 5), (4, 5))),
    (27, 5, ((0, 1), (0, 3), (0, 4), (1, 2), (1, 4), (2, 3), (2, 4), (3, 4))))}
VTK_ORDERS = inverse(GMSH_ORDERS)
