#include <cadrefine/motion/MovesOntoCAD.h>

#include <cadrefine/classification/CADAdjacency.h>

namespace cadrefine
{

ClosestPoint placeToReach(Index vertex, const Point3& point, const BoundaryProjector& projector,
  const Classification& classification)
{
  const CADModel& model = projector.model();
  const EntityId entity = classification.entities[vertex];
  ClosestPoint place = projector.nearestOn(entity, point);
  if (place.entity != entity && !isWithin(model.nurbs(), entity, place.entity))
  {
    place.entity = entity;
    place.parameters = classification.parameters[vertex];
    place.point = model.evaluate(entity, place.parameters);
    place.distance = distance(place.point, point);
  }
  return place;
}

Moves movesOntoCAD(
  const Mesh& mesh, const BoundaryProjector& projector, Classification& classification)
{
  Moves moves(mesh.points);
  for (std::size_t v = 0; v < classification.entities.size(); ++v)
  {
    if (classification.distances[v] > 0)
    {
      const auto vertex = static_cast<Index>(v);
      const ClosestPoint place = placeToReach(vertex, mesh.points[v], projector, classification);
      classification.set(vertex, place);
      moves.add(vertex, place.point);
    }
  }
  return moves;
}

} // namespace cadrefine
