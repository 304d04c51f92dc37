// The drawing of a model, or of a share of it.
#pragma once

#include <cadrefine/cad/model/CADModel.h>

#include <string>
#include <vector>

namespace cadrefine
{

/// Triangles or line segments that show one entity.
struct Tessellation
{
  std::vector<Point3> points;
  /// Outward normals at the points, of the face, or the first face that holds the edge; zero where
  /// there is none. Empty for an edge outside of faces.
  std::vector<Vector3> normals;
  std::vector<std::array<int, 3>> triangles; ///< The triangles of a face.
  std::vector<int> line;                     ///< The polyline of an edge.
};

/// The entities with the indices rank, rank + size, ...
struct DrawingShare
{
  int rank = 0;
  int size = 1;

  bool has(int entity) const { return entity % size == rank; }
};

struct ModelDrawing
{
  /// One for each edge; empty where it cannot be drawn, or is neither in the share nor the first
  /// one of a vertex of the share, which has its normal.
  std::vector<Tessellation> edges;
  /// One for each face; empty where it cannot be drawn, or is not in the share.
  std::vector<Tessellation> faces;
  /// A line for each edge or face that cannot be drawn, and one where a failure on several threads
  /// did not come again on one.
  std::vector<std::string> undrawn;
};

/// Draws edges and faces, to `deflection` (a length), by the program cadrefine-read-cad on so many
/// threads: what makes Open CASCADE crash, or takes it far too long, is left out. The same on any
/// number of threads. Throws Error where nothing can be drawn.
ModelDrawing drawModel(
  const CADModel& model, double deflection, const DrawingShare& share = {}, int threads = 1);

} // namespace cadrefine
