"""Makes a mesh follow its CAD geometry: projects it, measures the geometric error, refines it.

    mpirun -np N pvbatch plugin/cadrefine.py MESH CAD [options]
    pvpython plugin/cadrefine.py MESH CAD [options]

MESH is any file with cells of area or volume that ParaView reads, CAD an IGES, STEP or BREP file. See --help.
"""

import os
import signal
import sys

for ending in (signal.SIGINT, signal.SIGTERM):  # At once; VTK's own handlers print pages, and may hang.
    signal.signal(ending, signal.SIG_DFL)
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from cadrefine.cli import main

if __name__ == "__main__":
    main(sys.argv[1:])
