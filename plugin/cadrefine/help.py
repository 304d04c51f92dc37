"""What --help says besides the options, and its layout."""

import argparse

WIDTH = 100  # Columns.

USAGE = """mpirun -np N pvbatch cadrefine.py MESH CAD [options]
       pvpython cadrefine.py MESH CAD [options]"""

DESCRIPTION = """\
Makes a mesh follow its CAD geometry: projects its boundary onto the CAD model, measures the
geometric error between them, and refines the mesh so that new boundary vertices lie on the CAD.
Lengths are in the unit of the CAD file, whose numbers are used as they are; the mesh must have the
same unit. The result is the same on any number of ranks."""

EPILOG = """\
course of a run:
  Step 0 is the projected mesh. It is followed by --uniform-steps uniform steps, then by --steps
  steps of --method. The run ends early at --target-error, at --maximum-cells, and when no cell is
  marked.

examples:
  Three steps that refine all cells, and a report:
    pvpython cadrefine.py wing.msh wing.step --method uniform --report wing.json --output fine.msh
  Refine the cells that carry 30 % of the error, until the error is 1e-4, on 8 ranks:
    mpirun -np 8 pvbatch cadrefine.py wing.vtu wing.igs --steps 40 --marking bulk --threshold 0.3 \\
        --target-error 1e-4 --output fine.pvtu
  Refine where a solver's cell array "eta" exceeds 1e-3, in a mesh that an earlier run wrote:
    pvpython cadrefine.py flow.vtu wing.igs --projected --steps 1 --indicator eta \\
        --indicator-threshold 1e-3 --output next.vtu
  Quadratic cells whose mid-edge nodes lie on the CAD:
    pvpython cadrefine.py wing.msh wing.step --steps 0 --quadratic --output curved.msh
  Project only the nose, and take a picture of the result on a machine without a screen:
    xvfb-run -a pvpython cadrefine.py plane.vtu plane.igs --region 0 0.2 -1 1 -1 1 \\
        --screenshot nose.png

formats of MESH (hexahedra, wedges, pyramids and tetrahedra, or quadrilaterals and triangles;
cells of lower dimension carry tags):
  .vtu .pvtu .vtk .vtp ...  VTK's files, and whatever else ParaView reads
  .msh                      gmsh, versions 2.2 and 4.1, text and binary, with physical groups
  .xdmf                     as written by meshio, DOLFIN, DOLFINx, ParaView; all grids of the domain
  .e .ex2 .exo              Exodus: element blocks and side sets
  .mesh .meshb .vol         Medit and Netgen, through python3-meshio
  .inp                      Abaqus and CalculiX: element sets and surfaces
  .bdf .nas .fem            Nastran: properties
  .unv                      I-DEAS, SALOME: element groups
  .su2                      SU2, with marker names
  .cgns                     CGNS in HDF5: boundary conditions, families, zones; through python3-h5py
  .med                      SALOME and code_aster, with groups; needs python3-h5py
  CASE/NAME.foam, CASE      OpenFOAM, with patches and zones; only cells of the shapes above
  Tags become cell arrays: gmsh:physical and gmsh:geometrical for gmsh, medit:ref for Medit,
  ObjectId for Exodus. Group names become field data of the mesh, and are written with the groups.
  Quadratic cells are read as linear ones (their corners), and made quadratic again at the end.
  Of a time series, the first time step is read.

formats of --output (all but .vtu and .pvtu have groups with their names):
  .vtu   one file
  .pvtu  one file per rank, in a folder beside it: for large meshes
  .xdmf  with an .h5 file beside it, for DOLFIN, DOLFINx and ParaView: the grid "mesh", and the grid
         "facets" with the boundary tags as "facet_tags"
  .msh   gmsh: 2.2 in binary, or see --msh-version, --ascii
  .med   SALOME and code_aster; needs python3-h5py
  .exo   Exodus (also .e), for MOOSE: blocks, side sets, node sets; needs python3-scipy
  .inp   Abaqus and CalculiX: element sets, surfaces, node sets
  .cgns  CGNS in HDF5: boundary conditions, subregions; needs python3-h5py
  .bdf   Nastran: properties
  .unv   SALOME, I-DEAS: element groups
  .mesh  Medit, Mmg: group numbers
  .su2   SU2: markers
  .foam  OpenFOAM: constant/polyMesh beside the file, with patches and zones; the folder of a case
         can be given instead

table:
  step; vertices and cells of the mesh; vertices on the CAD; points looked up on the CAD in this
  step; global geometric error (area in 2D, volume in 3D); largest distance from the boundary to the
  CAD; inverted or degenerate cells; vertices that had to stop on the way to the CAD; lowest quality
  of a cell (mean ratio or scaled Jacobian, 1 is best); seconds the step took; what was done in it.

environment:
  CADREFINE_PLUGIN     path of the plugin CADRefine.so, if it is in none of the usual places
  NO_COLOR             if set, no colours (otherwise they are used on terminals only)
  VTK_SMP_MAX_THREADS  most threads per rank (default: the cores that mpirun bound it to)

exit status:
  0     done; all results are written
  1     bad input or a failure: one line on standard error names the file and the reason; no result
        is left behind. The status is the same on every rank.
  130   ended by Ctrl-C (SIGINT); 143 by SIGTERM; 129 by SIGHUP. The mesh after the last whole step
        is left as --output, with the report up to that step; a line says so. mpirun returns 1.

docs/command-line.md has more details; docs/cluster.md explains how to run on a cluster."""


class Layout(argparse.RawDescriptionHelpFormatter):
    def __init__(self, prog):
        super().__init__(prog, max_help_position=30, width=WIDTH)
