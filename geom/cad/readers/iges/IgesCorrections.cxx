#include <cadrefine/cad/readers/iges/IgesCorrections.h>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_OffsetSurface.hxx>
#include <IGESBasic_SingularSubfigure.hxx>
#include <IGESBasic_SubfigureDef.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESData_ToolLocation.hxx>
#include <IGESGeom_OffsetSurface.hxx>
#include <IGESGeom_TransformationMatrix.hxx>
#include <Precision.hxx>
#include <ShapeUpgrade_ShapeDivideContinuity.hxx>
#include <TColStd_HArray2OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <gp_GTrsf.hxx>

namespace cadrefine
{
namespace
{

/// Matrices that refer to each other in a ring are left as they are.
void compose(
  const Handle(IGESGeom_TransformationMatrix) & matrix, std::set<const IGESData_IGESEntity*>& seen)
{
  const auto outer = Handle(IGESGeom_TransformationMatrix)::DownCast(matrix->Transf());
  if (outer.IsNull() || !seen.insert(matrix.get()).second)
  {
    return;
  }
  compose(outer, seen);
  gp_GTrsf product = outer->Value();
  product.Multiply(matrix->Value());
  const Handle(TColStd_HArray2OfReal) data = new TColStd_HArray2OfReal(1, 3, 1, 4);
  for (int row = 1; row <= 3; ++row)
  {
    for (int column = 1; column <= 4; ++column)
    {
      data->SetValue(row, column, product.Value(row, column));
    }
  }
  matrix->Init(data);
  matrix->InitTransf({});
}

/// The transformation of an entity; the identity where it has none.
gp_Trsf placeOf(const Handle(IGESData_IGESEntity) & entity)
{
  constexpr double precision = 1e-4; // as Open CASCADE has it
  gp_Trsf place;
  if (entity->HasTransf())
  {
    IGESData_ToolLocation::ConvertLocation(precision, entity->CompoundLocation(), place);
  }
  return place;
}

/// Null where the transfer fails.
TopoDS_Shape transferred(IGESControl_Reader& reader, const Handle(IGESData_IGESEntity) & entity)
{
  const auto& process = reader.WS()->TransferReader()->TransientProcess();
  if (TransferBRep::ShapeResult(process, entity).IsNull())
  {
    reader.TransferEntity(entity);
  }
  return TransferBRep::ShapeResult(process, entity);
}

void bind(
  IGESControl_Reader& reader, const Handle(IGESData_IGESEntity) & entity, const TopoDS_Shape& shape)
{
  TransferBRep::SetShapeResult(reader.WS()->TransferReader()->TransientProcess(), entity, shape);
}

/// Places subfigures, those inside of others first, and each once.
class SubfigurePlacer
{
public:
  explicit SubfigurePlacer(IGESControl_Reader& reader) : reader_(reader) {}

  /// Places a subfigure by its scale, its translation and, after these, its transformation (IGES
  /// 5.3, 4.104).
  void place(const Handle(IGESBasic_SingularSubfigure) & figure)
  {
    if (!seen_.insert(figure.get()).second)
    {
      return;
    }
    const TopoDS_Shape shape = make(figure->Subfigure());
    if (!shape.IsNull())
    {
      gp_Trsf own;
      own.SetScaleFactor(figure->HasScaleFactor() ? figure->ScaleFactor() : 1);
      own.SetTranslationPart(gp_Vec(figure->Translation()));
      bind(reader_, figure, BRepBuilderAPI_Transform(shape, placeOf(figure) * own, true).Shape());
    }
  }

private:
  /// Null where there is no definition.
  TopoDS_Shape make(const Handle(IGESBasic_SubfigureDef) & definition)
  {
    if (definition.IsNull())
    {
      return {};
    }
    for (int i = 1; i <= definition->NbEntities(); ++i)
    {
      const auto inner =
        Handle(IGESBasic_SingularSubfigure)::DownCast(definition->AssociatedEntity(i));
      if (!inner.IsNull())
      {
        place(inner);
      }
    }
    return transferred(reader_, definition);
  }

  IGESControl_Reader& reader_;
  std::set<const IGESBasic_SingularSubfigure*> seen_;
};

/// The basis of an offset surface that is none itself, and the sum of the distances from it.
struct OffsetChain
{
  Handle(IGESData_IGESEntity) basis;
  double distance = 0;
  bool nested = false;
};

OffsetChain followOffsets(Handle(IGESGeom_OffsetSurface) surface)
{
  constexpr int deepest = 100;
  OffsetChain chain;
  for (int depth = 0; depth < deepest && !surface.IsNull(); ++depth)
  {
    chain.nested = depth > 0;
    chain.distance += surface->Distance();
    chain.basis = surface->Surface();
    surface = Handle(IGESGeom_OffsetSurface)::DownCast(chain.basis);
  }
  return chain;
}

/// The faces of `basis`, cut where they are not C1, each at `distance` from its own.
TopoDS_Shape offsetFaces(const TopoDS_Shape& basis, double distance)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  if (basis.IsNull())
  {
    return compound;
  }
  ShapeUpgrade_ShapeDivideContinuity divide(basis);
  divide.SetSurfaceCriterion(GeomAbs_C1);
  divide.SetTolerance(Precision::Confusion());
  divide.Perform();
  for (TopExp_Explorer explorer(divide.Result(), TopAbs_FACE); explorer.More(); explorer.Next())
  {
    const TopoDS_Face face = TopoDS::Face(explorer.Current());
    double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
    BRepTools::UVBounds(face, u0, u1, v0, v1);
    const Handle(Geom_OffsetSurface) offset =
      new Geom_OffsetSurface(BRep_Tool::Surface(face), distance);
    builder.Add(
      compound, BRepBuilderAPI_MakeFace(offset, u0, u1, v0, v1, Precision::Confusion()).Face());
  }
  return compound;
}

void makeOffset(IGESControl_Reader& reader, const Handle(IGESGeom_OffsetSurface) & entity)
{
  const OffsetChain chain = followOffsets(entity);
  const TopoDS_Shape basis = transferred(reader, chain.basis);
  const TopExp_Explorer face(basis, TopAbs_FACE);
  const bool isSmooth =
    face.More() && BRep_Tool::Surface(TopoDS::Face(face.Current()))->Continuity() != GeomAbs_C0;
  if (chain.nested || !isSmooth)
  {
    const TopoDS_Shape offset = offsetFaces(basis, chain.distance);
    bind(reader, entity, BRepBuilderAPI_Transform(offset, placeOf(entity), true).Shape());
  }
}

} // namespace

void composeMatrices(const Handle(IGESData_IGESModel) & model)
{
  std::set<const IGESData_IGESEntity*> seen;
  for (int number = 1; number <= model->NbEntities(); ++number)
  {
    const auto matrix = Handle(IGESGeom_TransformationMatrix)::DownCast(model->Entity(number));
    if (!matrix.IsNull())
    {
      compose(matrix, seen);
    }
  }
}

void makeOwnShapes(IGESControl_Reader& reader, const std::set<int>& numbers)
{
  reader.WS()->TransferReader()->BeginTransfer();
  SubfigurePlacer placer(reader);
  for (const int number : numbers)
  {
    const Handle(IGESData_IGESEntity) entity = reader.IGESModel()->Entity(number);
    if (const auto offset = Handle(IGESGeom_OffsetSurface)::DownCast(entity))
    {
      makeOffset(reader, offset);
    }
    else if (const auto figure = Handle(IGESBasic_SingularSubfigure)::DownCast(entity))
    {
      placer.place(figure);
    }
  }
}

} // namespace cadrefine
