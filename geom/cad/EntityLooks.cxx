#include "EntityLooks.h"

#include <TopExp_Explorer.hxx>

#include <algorithm>
#include <utility>

namespace cadrefine
{
namespace
{

void addMissing(EntityLook& look, const EntityLook& more)
{
  if (look.name.empty())
  {
    look.name = more.name;
  }
  if (!look.colour)
  {
    look.colour = more.colour;
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

void LookMap::add(const TopoDS_Shape& shape, const EntityLook& look)
{
  if (look.name.empty() && !look.colour)
  {
    return;
  }
  const auto type = TopExp_Explorer(shape, TopAbs_FACE).More() ? TopAbs_FACE : TopAbs_EDGE;
  for (TopExp_Explorer explorer(shape, type); explorer.More(); explorer.Next())
  {
    Known& known = looks_[explorer.Current().TShape().get()];
    known.shape = explorer.Current();
    addMissing(known.look, look);
  }
}

void LookMap::follow(const TopoDS_Shape& from, const TopoDS_Shape& to)
{
  if (!to.IsNull() && !to.IsPartner(from))
  {
    add(to, of(from));
  }
}

LookMap sortLooks(std::vector<FoundLook> found)
{
  std::vector<std::pair<int, std::size_t>> order;
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    order.emplace_back(countFaces(found[i].shape), i);
  }
  std::sort(order.begin(), order.end());
  LookMap looks;
  for (const auto& [faces, i] : order)
  {
    looks.add(found[i].shape, found[i].look);
  }
  return looks;
}

EntityLook LookMap::of(const TopoDS_Shape& entity) const
{
  const auto found = looks_.find(entity.TShape().get());
  return found == looks_.end() ? EntityLook() : found->second.look;
}

} // namespace cadrefine
