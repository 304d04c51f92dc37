#include <cadrefine/cad/readers/EntityAttributes.h>

#include <TopExp_Explorer.hxx>

#include <algorithm>
#include <utility>

namespace cadrefine
{
namespace
{

void addMissing(EntityAttributes& attributes, const EntityAttributes& more)
{
  if (attributes.name.empty())
  {
    attributes.name = more.name;
  }
  if (!attributes.colour)
  {
    attributes.colour = more.colour;
  }
}

int countFaces(const TopoDS_Shape& shape)
{
  int count = 0;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
  {
    ++count;
  }
  return count;
}

} // namespace

AttributeMap::Known& AttributeMap::known(const TopoDS_Shape& shape)
{
  Known& known = attributes_[shape.TShape().get()];
  known.shape = shape;
  return known;
}

const AttributeMap::Known* AttributeMap::find(const TopoDS_Shape& shape) const
{
  const auto found = attributes_.find(shape.TShape().get());
  return found == attributes_.end() ? nullptr : &found->second;
}

void AttributeMap::add(
  const TopoDS_Shape& shape, const EntityAttributes& attributes, const FileEntity& entity)
{
  const auto type = TopExp_Explorer(shape, TopAbs_FACE).More() ? TopAbs_FACE : TopAbs_EDGE;
  const bool isOne = entity.number > 0 && shape.ShapeType() == type;
  if (attributes.name.empty() && !attributes.colour && !isOne)
  {
    return;
  }
  for (TopExp_Explorer explorer(shape, type); explorer.More(); explorer.Next())
  {
    Known& one = known(explorer.Current());
    addMissing(one.attributes, attributes);
    one.entity = isOne && one.entity.number == 0 ? entity : one.entity;
  }
}

void AttributeMap::follow(const TopoDS_Shape& from, const TopoDS_Shape& to)
{
  const Known* const before = find(from);
  if (before == nullptr || to.IsNull() || to.IsPartner(from))
  {
    return;
  }
  const Known copy = *before; // the map may grow
  const auto type = TopExp_Explorer(to, TopAbs_FACE).More() ? TopAbs_FACE : TopAbs_EDGE;
  for (TopExp_Explorer explorer(to, type); explorer.More(); explorer.Next())
  {
    Known& one = known(explorer.Current());
    addMissing(one.attributes, copy.attributes);
    one.entity = one.entity.number == 0 ? copy.entity : one.entity;
  }
}

EntityAttributes AttributeMap::of(const TopoDS_Shape& entity) const
{
  const Known* const one = find(entity);
  return one == nullptr ? EntityAttributes() : one->attributes;
}

UnreadEntity AttributeMap::lost(const TopoDS_Shape& entity, const std::string& reason) const
{
  const Known* const one = find(entity);
  UnreadEntity lost{ 0, entity.ShapeType() == TopAbs_FACE ? "face" : "edge", reason, "" };
  if (one != nullptr)
  {
    lost.entity = one->entity.number;
    lost.type = one->entity.type.empty() ? lost.type : one->entity.type;
    lost.name = one->attributes.name;
  }
  return lost;
}

AttributeMap sortAttributes(std::vector<FoundAttributes> found)
{
  std::vector<std::pair<int, std::size_t>> order;
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    order.emplace_back(countFaces(found[i].shape), i);
  }
  std::sort(order.begin(), order.end());
  AttributeMap attributeMap;
  for (const auto& [faces, i] : order)
  {
    attributeMap.add(found[i].shape, found[i].attributes, found[i].entity);
  }
  return attributeMap;
}

} // namespace cadrefine
