// Checks that hold for every mesh that CADRefine makes.
#pragma once

#include <cadrefine/mesh/Mesh.h>

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <set>
#include <vector>

namespace cadtest
{

/// Volume or area of the cells of the mesh's own dimension, added up with their sign (cells of area
/// in space: always positive).
double measureOf(const cadrefine::Mesh& mesh);

/// Volume inside the facets of a closed surface (outward normals), by the divergence theorem.
double volumeInside(const cadrefine::Mesh& mesh);

/// No cell of the mesh's own dimension is inverted or flat, simplices by exact orientation
/// (triangles and quadrilaterals are turned to z where all of a cell lies at one height; in space
/// they have an area).
testing::AssertionResult areCellsValid(const cadrefine::Mesh& mesh);
/// The same, and there are cells.
testing::AssertionResult isValid(const cadrefine::Mesh& mesh);

/// Every side of a cell is met twice, but for those on the boundary (`onBoundary` says so of their
/// vertices), which are met once, or of cells of area any number of times: sheets may meet there.
testing::AssertionResult isWatertight(const cadrefine::Mesh& mesh,
  const std::function<bool(const std::vector<cadrefine::Point3>&)>& onBoundary);

/// Every side of a cell is met twice, but for those that are listed as cells, which are met once;
/// all listed cells of their dimension are such.
testing::AssertionResult isBoundedByListedCells(const cadrefine::Mesh& mesh);

/// Whether these points lie on one side of the unit cube, or (dimension 2) of the unit square.
bool onUnitCube(const std::vector<cadrefine::Point3>& points, int dimension);

/// No edge of the mesh has a vertex exactly in its middle.
testing::AssertionResult hasNoHangingVertex(const cadrefine::Mesh& mesh);

/// Number of sides that are met once.
std::size_t countOuterSides(const cadrefine::Mesh& mesh);

/// Vertices of the sides that are met once.
std::set<cadrefine::Index> outerVertices(const cadrefine::Mesh& mesh);

} // namespace cadtest
