"""Writes cells of several shapes as a VTK XML file in readable text, every double to the last bit."""

import numpy as np

VTK_TYPE = {3: 5, 4: 10, 6: 13, 8: 12}  # Corners of a cell to VTK's number: triangle, tetrahedron, wedge, hexahedron.


def mean_ratio(points, cells):
    """Quality of triangles or tetrahedra: 1 equilateral, 0 degenerate, negative inverted (tetrahedra)."""
    corners = points[cells]
    pairs = [(i, j) for i in range(cells.shape[1]) for j in range(i)]
    squares = sum(((corners[:, i] - corners[:, j]) ** 2).sum(axis=1) for i, j in pairs)
    edges = corners[:, 1:] - corners[:, :1]
    if cells.shape[1] == 3:
        area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / 2
        return 4 * np.sqrt(3.0) * area / squares
    volume = np.linalg.det(edges) / 6
    return 12 * np.cbrt(9 * volume**2) * np.sign(volume) / squares


def write_vtu(path, points, blocks, cell_arrays=None):
    """`blocks` are arrays of cells, (n, corners); `cell_arrays` integers, over the blocks in their order."""
    offsets = np.cumsum(np.concatenate([np.full(len(block), block.shape[1]) for block in blocks]))
    types = np.concatenate([np.full(len(block), VTK_TYPE[block.shape[1]]) for block in blocks])
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write('<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n')
        file.write(f'<UnstructuredGrid>\n<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(types)}">\n')
        file.write('<Points>\n<DataArray type="Float64" NumberOfComponents="3" format="ascii">\n')
        file.writelines(" ".join(repr(float(c)) for c in point) + "\n" for point in points)
        file.write('</DataArray>\n</Points>\n<Cells>\n<DataArray type="Int64" Name="connectivity" format="ascii">\n')
        file.writelines(" ".join(map(str, cell)) + "\n" for block in blocks for cell in block)
        file.write("</DataArray>\n")
        write_array(file, "Int64", "offsets", offsets)
        write_array(file, "UInt8", "types", types)
        file.write("</Cells>\n<CellData>\n")
        for name, values in (cell_arrays or {}).items():
            write_array(file, "Int32", name, values)
        file.write("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")


def write_array(file, kind, name, values):
    file.write(f'<DataArray type="{kind}" Name="{name}" format="ascii">\n')
    file.writelines(" ".join(map(str, values[i:i + 20])) + "\n" for i in range(0, len(values), 20))
    file.write("</DataArray>\n")
