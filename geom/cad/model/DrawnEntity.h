// What goes to the program that draws, and comes back. Private to geom/cad.
#pragma once

#include <cadrefine/cad/model/ByteRecords.h>
#include <cadrefine/cad/model/ModelDrawing.h>

namespace cadrefine
{

/// An entity, and the face whose normals its drawing has: itself, or one that holds the edge; -1:
/// without.
struct DrawnEntity
{
  EntityId entity;
  int face = -1;
};

/// What became of the drawing of an entity.
struct DrawnItem
{
  Tessellation drawing; ///< Empty where there is a fault.
  std::string fault;
};

inline void write(ByteWriter& writer, const DrawnItem& item)
{
  writer.array(item.drawing.points);
  writer.array(item.drawing.normals);
  writer.array(item.drawing.triangles);
  writer.array(item.drawing.line);
  writer.text(item.fault);
}

inline DrawnItem readItem(ByteReader& reader)
{
  DrawnItem item;
  item.drawing.points = reader.array<Point3>();
  item.drawing.normals = reader.array<Vector3>();
  item.drawing.triangles = reader.array<std::array<int, 3>>();
  item.drawing.line = reader.array<int>();
  item.fault = reader.text();
  return item;
}

} // namespace cadrefine
