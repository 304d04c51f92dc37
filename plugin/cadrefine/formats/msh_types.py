"""gmsh's types of cells, and VTK's."""

VTK_TYPES = {15: 1, 1: 3, 8: 21, 2: 5, 9: 22, 3: 9, 4: 10, 11: 24, 5: 12, 6: 13, 7: 14}  # By gmsh's types.
GMSH_TYPES = {vtk: gmsh for gmsh, vtk in VTK_TYPES.items()}
SWAPPED = {11: [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]}  # Nodes of quadratic tetrahedra: gmsh's order and VTK's.
