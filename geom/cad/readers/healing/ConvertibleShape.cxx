// 1. Convert each face; one that fails is healed by itself, with its edges, and converted again;
//    one that fails again is removed.
// 2. The same for each edge of what is left. One without a curve in space gets that of its trim
//    curve. One that fails again is removed if it is free; in a face it is marked as degenerated,
//    which leaves its trim curve.
// 3. See that the shape can be written and read back; if not, make splines of the surfaces that
//    cannot.

#include <cadrefine/cad/readers/healing/ConvertibleShape.h>

#include <cadrefine/cad/extraction/NurbsExtraction.h>
#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/import/OwnThreads.h>
#include <cadrefine/cad/model/ModelBytes.h>
#include <cadrefine/nurbs/ModelCheck.h>

#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepLib.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Curve.hxx>
#include <ShapeFix_Face.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>

namespace cadrefine
{
namespace
{

/// Why the face or edge cannot be converted; empty: it can.
std::string conversionFault(const TopoDS_Shape& entity)
{
  try
  {
    return entity.ShapeType() == TopAbs_FACE ? faultOf(extractFace(TopoDS::Face(entity)))
                                             : faultOf(extractEdge(TopoDS::Edge(entity)));
  }
  catch (const Standard_Failure& failure)
  {
    return describe(failure);
  }
  catch (const Error& error)
  {
    return error.what();
  }
}

/// Why each of `count` entities cannot be converted (see conversionFault), the first of them being
/// item `first` of ReadStep::Conversion.
template<typename EntityAt>
std::vector<std::string> findFaults(
  int count, int first, const EntityAt& entityAt, const ReadOptions& options)
{
  std::vector<std::string> faults(count);
  forEachIndex(forOnOwnThreads(options.threads), faults.size(), 1,
    [&](std::size_t i)
    {
      const int item = first + static_cast<int>(i);
      const auto leftOut = options.withoutConversions.find(item);
      options.noteItem(ReadStep::Conversion, item);
      faults[i] = leftOut != options.withoutConversions.end()
                    ? leftOut->second
                    : conversionFault(entityAt(static_cast<int>(i)));
    });
  return faults;
}

/// The faces that `face` becomes where it is healed.
TopoDS_Shape healFace(const TopoDS_Face& face)
{
  ShapeFix_Face fix(face);
  fix.Perform();
  return fix.Result();
}

/// The edge with a curve in space that is made of its trim curve.
TopoDS_Shape healEdge(const TopoDS_Edge& edge)
{
  constexpr bool withoutOrientation = false;
  const BRep_Builder builder;
  TopoDS_Edge copy = TopoDS::Edge(edge.EmptyCopied());
  for (TopoDS_Iterator vertex(edge, withoutOrientation); vertex.More(); vertex.Next())
  {
    builder.Add(copy, vertex.Value());
  }
  builder.UpdateEdge(copy, Handle(Geom_Curve)(), BRep_Tool::Tolerance(edge));
  return BRepLib::BuildCurve3d(copy) ? copy : TopoDS_Edge();
}

/// The shape that `heal` makes of the entity, where all of that converts; else null.
template<typename Heal>
TopoDS_Shape healed(const TopoDS_Shape& entity, const Heal& heal)
{
  try
  {
    const TopoDS_Shape shape = heal();
    const auto parts =
      shape.IsNull() ? TopTools_IndexedMapOfShape() : entitiesOf(shape, entity.ShapeType());
    bool converts = parts.Extent() > 0;
    for (int i = 1; i <= parts.Extent() && converts; ++i)
    {
      converts = conversionFault(parts(i)).empty();
    }
    return converts ? shape : TopoDS_Shape();
  }
  catch (const Standard_Failure&)
  {
    return {};
  }
}

std::string repairOf(const UnreadEntity& entity)
{
  return entity.type + (entity.entity > 0 ? " " + std::to_string(entity.entity) : "") +
         " was healed: " + entity.reason;
}

/// Collects what is to be changed of a shape.
class Sorting
{
public:
  Sorting(AttributeMap& attributeMap, const ReadOptions& options, ConvertibleShape& result)
    : attributes_(attributeMap), options_(options), result_(result)
  {
  }

  /// Takes an entity that cannot be converted: heals it with `heal` or else gives it up with
  /// `giveUp`.
  template<typename Heal, typename GiveUp>
  void take(const TopoDS_Shape& entity, int item, const std::string& fault, const Heal& heal,
    const GiveUp& giveUp)
  {
    noteStep(static_cast<int>(ReadStep::Conversion), item);
    const bool isLeftOut = options_.withoutConversions.count(item) > 0;
    const TopoDS_Shape better = isLeftOut ? TopoDS_Shape() : healed(entity, heal);
    if (better.IsNull())
    {
      result_.unread.push_back(attributes_.lost(entity, fault));
      giveUp();
    }
    else
    {
      result_.repairs.push_back(repairOf(attributes_.lost(entity, fault)));
      attributes_.follow(entity, better);
      changes_.Replace(entity, better);
    }
  }

  void remove(const TopoDS_Shape& entity) { changes_.Remove(entity); }
  TopoDS_Shape apply(const TopoDS_Shape& shape) { return changes_.Apply(shape); }

private:
  AttributeMap& attributes_;
  const ReadOptions& options_;
  ConvertibleShape& result_;
  BRepTools_ReShape changes_;
};

/// Sorts out faces that cannot be converted. Returns the number of faces before.
int sortFaces(AttributeMap& attributeMap, const ReadOptions& options, ConvertibleShape& result)
{
  Sorting sorting(attributeMap, options, result);
  const auto faces = entitiesOf(result.shape, TopAbs_FACE);
  const auto faceAt = [&](int i) { return TopoDS::Face(faces(i + 1).Oriented(TopAbs_FORWARD)); };
  const std::vector<std::string> faults = findFaults(faces.Extent(), 0, faceAt, options);
  for (int i = 0; i < faces.Extent(); ++i)
  {
    if (!faults[i].empty())
    {
      const TopoDS_Face face = faceAt(i);
      sorting.take(
        face, i, faults[i], [&] { return healFace(face); }, [&] { sorting.remove(face); });
    }
  }
  result.shape = sorting.apply(result.shape);
  return faces.Extent();
}

void sortEdges(
  int faces, AttributeMap& attributeMap, const ReadOptions& options, ConvertibleShape& result)
{
  Sorting sorting(attributeMap, options, result);
  TopTools_IndexedMapOfShape ofFaces;
  for (TopExp_Explorer face(result.shape, TopAbs_FACE); face.More(); face.Next())
  {
    TopExp::MapShapes(face.Current(), TopAbs_EDGE, ofFaces);
  }
  const ShapeIndex index(result.shape);
  const auto edgeAt = [&](int i)
  { return TopoDS::Edge(index.edges()[i].Oriented(TopAbs_FORWARD)); };
  const int edges = static_cast<int>(index.edges().size());
  const std::vector<std::string> faults = findFaults(edges, faces, edgeAt, options);
  for (int i = 0; i < edges; ++i)
  {
    if (faults[i].empty())
    {
      continue;
    }
    const TopoDS_Edge edge = edgeAt(i);
    const auto giveUp = [&]
    {
      if (ofFaces.Contains(edge))
      {
        BRep_Builder().Degenerated(edge, true);
      }
      else
      {
        sorting.remove(edge);
      }
    };
    sorting.take(
      edge, faces + i, faults[i], [&] { return healEdge(edge); }, giveUp);
  }
  result.shape = sorting.apply(result.shape);
}

/// Open CASCADE writes some surfaces that it refuses to read. As splines they are fitted.
void replaceUnwritable(AttributeMap& attributeMap, ConvertibleShape& result)
{
  if (result.shape.IsNull() || canBeWritten(result.shape))
  {
    return;
  }
  BRepTools_ReShape changes;
  const auto faces = entitiesOf(result.shape, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i)
  {
    const TopoDS_Shape& face = faces(i);
    if (canBeWritten(face))
    {
      continue;
    }
    const TopoDS_Shape spline =
      healed(face, [&] { return BRepBuilderAPI_NurbsConvert(face).Shape(); });
    const UnreadEntity lost = attributeMap.lost(face, "has an invalid surface definition");
    if (!spline.IsNull() && canBeWritten(spline))
    {
      result.repairs.push_back(repairOf(lost));
      attributeMap.follow(face, spline);
      changes.Replace(face, spline);
    }
    else
    {
      result.unread.push_back(lost);
      changes.Remove(face);
    }
  }
  result.shape = changes.Apply(result.shape);
}

} // namespace

ConvertibleShape keepConvertible(
  const TopoDS_Shape& shape, AttributeMap& attributeMap, const ReadOptions& options)
{
  ConvertibleShape result;
  result.shape = shape;
  const int faces = sortFaces(attributeMap, options, result);
  if (!result.shape.IsNull())
  {
    sortEdges(faces, attributeMap, options, result);
  }
  noteStep(static_cast<int>(ReadStep::Other));
  replaceUnwritable(attributeMap, result);
  const bool isEmpty =
    result.shape.IsNull() || !TopExp_Explorer(result.shape, TopAbs_VERTEX).More();
  result.shape = isEmpty ? TopoDS_Shape() : result.shape;
  return result;
}

} // namespace cadrefine
