#include "cad/CADDrawing.h"

#include "fields/CADArrays.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

namespace cadrefine
{
namespace
{

/// Draws a vertex, with the normal that its first edge has there.
Tessellation drawVertex(const NurbsModel& model, int entity, const std::vector<Tessellation>& edges)
{
  const NurbsVertex& vertex = model.vertices[entity];
  Tessellation drawing;
  drawing.points.push_back(vertex.point);
  const int edge = vertex.edges.empty() ? -1 : vertex.edges.front();
  if (edge >= 0 && !edges[edge].normals.empty())
  {
    const bool isFirst = model.edges[edge].firstVertex == entity;
    drawing.normals.push_back(isFirst ? edges[edge].normals.front() : edges[edge].normals.back());
  }
  return drawing;
}

/// Poly data in the making. All parts have normals if the model has faces: ParaView shades a
/// collection smoothly only where all of it has them.
class Drawing
{
public:
  explicit Drawing(const CADModel& model) : model_(model)
  {
    points_->SetDataTypeToDouble();
    normals_->SetName("Normals");
    normals_->SetNumberOfComponents(3);
  }

  void addVertex(int entity, const std::vector<Tessellation>& edges)
  {
    const Tessellation drawing = drawVertex(model_.nurbs(), entity, edges);
    const vtkIdType id = addPoints({ 0, entity }, drawing);
    cells_->InsertNextCell(1, &id);
    entities_.push_back({ 0, entity });
  }

  void addEdge(int entity, const Tessellation& drawing)
  {
    const vtkIdType first = addPoints({ 1, entity }, drawing);
    cells_->InsertNextCell(static_cast<vtkIdType>(drawing.line.size()));
    for (const int point : drawing.line)
    {
      cells_->InsertCellPoint(first + point);
    }
    entities_.push_back({ 1, entity });
  }

  void addFace(int entity, const Tessellation& drawing)
  {
    const vtkIdType first = addPoints({ 2, entity }, drawing);
    for (const auto& triangle : drawing.triangles)
    {
      cells_->InsertNextCell({ first + triangle[0], first + triangle[1], first + triangle[2] });
      entities_.push_back({ 2, entity });
    }
  }

  vtkSmartPointer<vtkPolyData> finish(int dimension)
  {
    auto result = vtkSmartPointer<vtkPolyData>::New();
    result->SetPoints(points_);
    (dimension == 0)   ? result->SetVerts(cells_)
    : (dimension == 1) ? result->SetLines(cells_)
                       : result->SetPolys(cells_);
    writeEntities(result->GetCellData(), entities_);
    result->GetCellData()->SetActiveScalars(arrays::entity);
    addAttributes(dimension, *result->GetCellData());
    if (model_.count(2) > 0)
    {
      result->GetPointData()->SetNormals(normals_);
    }
    return result;
  }

private:
  /// Adds the attribute arrays: the same ones on every rank, whatever it draws.
  void addAttributes(int dimension, vtkCellData& data) const
  {
    bool named = false;
    bool coloured = false;
    for (int entity = 0; entity < model_.count(dimension); ++entity)
    {
      const EntityAttributes& attributes =
        model_.attributes({ static_cast<std::int8_t>(dimension), entity });
      named = named || !attributes.name.empty();
      coloured = coloured || attributes.colour.has_value();
    }
    if (named)
    {
      writeNames(&data, "Name", model_, entities_);
    }
    if (coloured)
    {
      writeColours(&data, "Color", model_, entities_);
    }
  }

  vtkIdType addPoints(EntityId entity, const Tessellation& drawing)
  {
    const vtkIdType first = points_->GetNumberOfPoints();
    const int face = firstFaceAt(model_.nurbs(), entity);
    for (std::size_t i = 0; i < drawing.points.size(); ++i)
    {
      Vector3 normal = i < drawing.normals.size() ? drawing.normals[i] : Vector3{};
      if (face >= 0 && norm(normal) == 0)
      {
        normal = model_.normalNear(face, drawing.points[i]);
      }
      points_->InsertNextPoint(drawing.points[i].data());
      normals_->InsertNextTuple(normal.data());
    }
    return first;
  }

  const CADModel& model_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> cells_;
  std::vector<EntityId> entities_; ///< CAD entities of the cells.
  vtkNew<vtkFloatArray> normals_;
};

} // namespace

vtkSmartPointer<vtkPolyData> draw(
  const CADModel& model, const ModelDrawing& drawing, int dimension, const DrawingShare& share)
{
  Drawing result(model);
  for (int entity = share.rank; entity < model.count(dimension); entity += share.size)
  {
    (dimension == 0)   ? result.addVertex(entity, drawing.edges)
    : (dimension == 1) ? result.addEdge(entity, drawing.edges[entity])
                       : result.addFace(entity, drawing.faces[entity]);
  }
  return result.finish(dimension);
}

vtkSmartPointer<vtkPolyData> drawNothing(const CADModel& model, int dimension)
{
  return Drawing(model).finish(dimension);
}

} // namespace cadrefine
