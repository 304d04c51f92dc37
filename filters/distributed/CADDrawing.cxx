#include "CADDrawing.h"

#include "CADArrays.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>

namespace cadrefine
{
namespace
{

/// A face that holds the entity, for the normals there; -1 in a model of curves.
int faceAt(const NurbsModel& model, EntityId id)
{
  if (id.dimension == 2)
  {
    return id.index;
  }
  if (id.dimension == 1)
  {
    const auto& faces = model.edges[id.index].faces;
    return faces.empty() ? -1 : faces.front();
  }
  const auto& edges = model.vertices[id.index].edges;
  return edges.empty() ? -1 : faceAt(model, { 1, edges.front() });
}

/// Poly data in the making. All parts have normals if the model has faces: ParaView shades a
/// collection smoothly only where all of it has them.
class Drawing
{
public:
  Drawing(const CADModel& model, double deflection) : model_(model), deflection_(deflection)
  {
    points_->SetDataTypeToDouble();
    entities_->SetName(arrays::entity);
    normals_->SetName("Normals");
    normals_->SetNumberOfComponents(3);
    names_->SetName("Name");
    colours_->SetName("Color");
    colours_->SetNumberOfComponents(3);
  }

  void addVertex(int entity)
  {
    Tessellation drawing;
    drawing.points.push_back(model_.nurbs().vertices[entity].point);
    const vtkIdType id = addPoints({ 0, entity }, drawing);
    cells_->InsertNextCell(1, &id);
    addCell({ 0, entity });
  }

  void addEdge(int entity)
  {
    const Tessellation drawing = model_.tessellate({ 1, entity }, deflection_);
    const vtkIdType first = addPoints({ 1, entity }, drawing);
    cells_->InsertNextCell(static_cast<vtkIdType>(drawing.line.size()));
    for (const int point : drawing.line)
    {
      cells_->InsertCellPoint(first + point);
    }
    addCell({ 1, entity });
  }

  void addFace(int entity)
  {
    const Tessellation drawing = model_.tessellate({ 2, entity }, deflection_);
    const vtkIdType first = addPoints({ 2, entity }, drawing);
    for (const auto& triangle : drawing.triangles)
    {
      cells_->InsertNextCell({ first + triangle[0], first + triangle[1], first + triangle[2] });
      addCell({ 2, entity });
    }
  }

  vtkSmartPointer<vtkPolyData> finish(int dimension)
  {
    auto result = vtkSmartPointer<vtkPolyData>::New();
    result->SetPoints(points_);
    (dimension == 0)   ? result->SetVerts(cells_)
    : (dimension == 1) ? result->SetLines(cells_)
                       : result->SetPolys(cells_);
    result->GetCellData()->SetScalars(entities_);
    addLooks(dimension, *result->GetCellData());
    if (model_.count(2) > 0)
    {
      result->GetPointData()->SetNormals(normals_);
    }
    return result;
  }

private:
  void addCell(EntityId entity)
  {
    constexpr std::array<float, 3> white{ 1, 1, 1 };
    entities_->InsertNextValue(entity.index);
    const EntityLook& look = model_.look(entity);
    names_->InsertNextValue(look.name);
    for (const float part : look.colour.value_or(white))
    {
      colours_->InsertNextValue(static_cast<unsigned char>(std::lround(255 * part)));
    }
  }

  /// The same arrays on every rank, whatever it draws.
  void addLooks(int dimension, vtkCellData& data) const
  {
    bool named = false;
    bool coloured = false;
    for (int entity = 0; entity < model_.count(dimension); ++entity)
    {
      const EntityLook& look = model_.look({ static_cast<std::int8_t>(dimension), entity });
      named = named || !look.name.empty();
      coloured = coloured || look.colour.has_value();
    }
    if (named)
    {
      data.AddArray(names_);
    }
    if (coloured)
    {
      data.AddArray(colours_);
    }
  }

  vtkIdType addPoints(EntityId entity, const Tessellation& drawing)
  {
    const vtkIdType first = points_->GetNumberOfPoints();
    const int face = faceAt(model_.nurbs(), entity);
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
  double deflection_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> cells_;
  vtkNew<vtkIntArray> entities_;
  vtkNew<vtkFloatArray> normals_;
  vtkNew<vtkStringArray> names_;
  vtkNew<vtkUnsignedCharArray> colours_;
};

} // namespace

vtkSmartPointer<vtkPolyData> draw(const CADModel& model, int dimension, const DrawingShare& share)
{
  Drawing drawing(model, share.tolerance * model.size());
  for (int entity = share.rank; entity < model.count(dimension); entity += share.size)
  {
    (dimension == 0)   ? drawing.addVertex(entity)
    : (dimension == 1) ? drawing.addEdge(entity)
                       : drawing.addFace(entity);
  }
  return drawing.finish(dimension);
}

} // namespace cadrefine
