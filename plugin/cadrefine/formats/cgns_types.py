"""CGNS's types of elements, and VTK's."""

from cadrefine.formats.cells import TYPES

# VTK's types by CGNS's numbers; of types with nodes on sides or inside too, those that they are without.
VTK_TYPES = {2: 1, 3: 3, 4: 21, 5: 5, 6: 22, 7: 9, 8: 23, 9: 23, 10: 10, 11: 24, 12: 14, 21: 27, 13: 27, 14: 13, 15: 26,
             16: 26, 17: 12, 18: 25, 19: 25}
SIZES = {kind: TYPES[vtk][2] for kind, vtk in VTK_TYPES.items()}  # Nodes.
SIZES.update({9: 9, 13: 14, 16: 18, 19: 27})
CGNS_TYPES = {vtk: kind for kind, vtk in VTK_TYPES.items() if SIZES[kind] == TYPES[vtk][2]}
MIXED = 20
NAMES = {22: "NGON_n", 23: "NFACE_n"}  # Of types that are no cells of a mesh, but common.
