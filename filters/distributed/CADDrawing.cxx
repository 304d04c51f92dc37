#include "CADDrawing.h"

#include "CADArrays.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

namespace cadrefine
{
namespace
{

class Drawing
{
public:
  Drawing()
  {
    points_->SetDataTypeToDouble();
    entities_->SetName(arrays::entity);
  }

  void addVertex(int entity, const Point3& point)
  {
    const vtkIdType id = points_->InsertNextPoint(point.data());
    cells_->InsertNextCell(1, &id);
    entities_->InsertNextValue(entity);
  }

  void addLine(int entity, const Tessellation& drawing)
  {
    const vtkIdType first = addPoints(drawing);
    cells_->InsertNextCell(static_cast<vtkIdType>(drawing.line.size()));
    for (const int point : drawing.line)
    {
      cells_->InsertCellPoint(first + point);
    }
    entities_->InsertNextValue(entity);
  }

  void addTriangles(int entity, const Tessellation& drawing)
  {
    const vtkIdType first = addPoints(drawing);
    for (const auto& triangle : drawing.triangles)
    {
      cells_->InsertNextCell({ first + triangle[0], first + triangle[1], first + triangle[2] });
      entities_->InsertNextValue(entity);
    }
  }

  vtkSmartPointer<vtkPolyData> finish(int dimension)
  {
    auto result = vtkSmartPointer<vtkPolyData>::New();
    result->SetPoints(points_);
    (dimension == 0)   ? result->SetVerts(cells_)
    : (dimension == 1) ? result->SetLines(cells_)
                       : result->SetPolys(cells_);
    result->GetCellData()->AddArray(entities_);
    return result;
  }

private:
  vtkIdType addPoints(const Tessellation& drawing)
  {
    const vtkIdType first = points_->GetNumberOfPoints();
    for (const Point3& point : drawing.points)
    {
      points_->InsertNextPoint(point.data());
    }
    return first;
  }

  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> cells_;
  vtkNew<vtkIntArray> entities_;
};

} // namespace

vtkSmartPointer<vtkPolyData> draw(const CADModel& model, int dimension, const DrawingShare& share)
{
  Drawing drawing;
  const double deflection = share.tolerance * model.size();
  for (int entity = share.rank; entity < model.count(dimension); entity += share.size)
  {
    const EntityId id{ static_cast<std::int8_t>(dimension), entity };
    if (dimension == 0)
    {
      drawing.addVertex(entity, model.nurbs().vertices[entity].point);
    }
    else if (dimension == 1)
    {
      drawing.addLine(entity, model.tessellate(id, deflection));
    }
    else
    {
      drawing.addTriangles(entity, model.tessellate(id, deflection));
    }
  }
  return drawing.finish(dimension);
}

} // namespace cadrefine
