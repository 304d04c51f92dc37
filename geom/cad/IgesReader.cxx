// IGES files, through Open CASCADE's reader.
//
// 0. Set broken entities aside and repair what can be repaired (IgesRepair).
// 1. Load the file; take its unit's name and declare the numbers to be millimetres, so that the
//    transfer scales nothing.
// 2. Transfer every root entity; keep the shapes with faces, and free curves that are meant as
//    geometry (not parameter-space, construction or blanked ones).
// 3. List the entities that failed and the top-level geometry that gave no shape.

#include "CheckLists.h"
#include "IgesRepair.h"
#include "IgesTypes.h"
#include "OccGuard.h"
#include "ShapeReaders.h"

#include <BRep_Builder.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESData_IGESType.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <set>

namespace cadrefine
{
namespace
{

constexpr int unitMillimetre = 2;

std::string takeUnit(const Handle(IGESData_IGESModel) & model)
{
  IGESData_GlobalSection section = model->GlobalSection();
  const int flag = section.UnitFlag();
  const std::string name =
    section.UnitName().IsNull() ? std::string() : section.UnitName()->ToCString();
  section.SetUnitFlag(unitMillimetre);
  section.SetCascadeUnit(1.0);
  model->SetGlobalSection(section);
  return igesUnitName(flag, name);
}

bool isModelCurve(const Handle(IGESData_IGESEntity) & entity)
{
  constexpr int useGeometry = 0;
  constexpr int independent = 0;
  return entity->UseFlag() == useGeometry && entity->BlankStatus() == 0 &&
         entity->SubordinateStatus() == independent;
}

struct RootShapes
{
  std::vector<TopoDS_Shape> withFaces;
  std::vector<TopoDS_Shape> modelCurves;
  std::vector<TopoDS_Shape> otherCurves;
};

RootShapes sortRoots(IGESControl_Reader& reader)
{
  RootShapes roots;
  for (int i = 1; i <= reader.NbRootsForTransfer(); ++i)
  {
    const Handle(IGESData_IGESEntity) entity =
      Handle(IGESData_IGESEntity)::DownCast(reader.RootForTransfer(i));
    const TopoDS_Shape shape = reader.WS()->TransferReader()->ShapeResult(entity);
    if (shape.IsNull())
    {
      continue;
    }
    auto& list = TopExp_Explorer(shape, TopAbs_FACE).More() ? roots.withFaces
                 : isModelCurve(entity)                     ? roots.modelCurves
                                                            : roots.otherCurves;
    list.push_back(shape);
  }
  return roots;
}

/// Curves that serve only as an aid are taken where the file has nothing else.
TopoDS_Shape joinRoots(const RootShapes& roots, bool holdsSurfaces)
{
  const bool onlyAids = !holdsSurfaces && roots.modelCurves.empty();
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const auto* list : { &roots.withFaces, &roots.modelCurves, &roots.otherCurves })
  {
    for (const TopoDS_Shape& shape : *list)
    {
      if (list != &roots.otherCurves || onlyAids)
      {
        builder.Add(compound, shape);
      }
    }
  }
  return compound;
}

/// Top level: nothing refers to it, or only groups and subfigures do.
bool isTopLevel(
  const Handle(XSControl_WorkSession) & session, const Handle(IGESData_IGESEntity) & entity)
{
  Interface_EntityIterator sharings = session->Graph().Sharings(entity);
  for (sharings.Start(); sharings.More(); sharings.Next())
  {
    const Handle(IGESData_IGESEntity) parent =
      Handle(IGESData_IGESEntity)::DownCast(sharings.Value());
    if (!parent.IsNull() && !isIgesGroup(parent->TypeNumber()))
    {
      return false;
    }
  }
  return true;
}

int directoryEntry(int number)
{
  return 2 * number - 1;
}

UnreadEntity makeUnread(
  const Handle(IGESData_IGESModel) & model, int number, const std::string& reason)
{
  UnreadEntity unread;
  if (number > 0)
  {
    const Handle(IGESData_IGESEntity) entity = model->Entity(number);
    unread.entity = directoryEntry(number);
    unread.type = igesTypeName(entity->IGESType().Type());
  }
  unread.reason = reason;
  return unread;
}

/// Numbers in the model of the top-level geometry that gave no shape.
std::set<int> findLost(IGESControl_Reader& reader)
{
  std::set<int> lost;
  const Handle(IGESData_IGESModel) model = reader.IGESModel();
  for (int number = 1; number <= model->NbEntities(); ++number)
  {
    const Handle(IGESData_IGESEntity) entity = model->Entity(number);
    if (isIgesGeometry(entity->IGESType().Type(), entity->IGESType().Form()) &&
        isTopLevel(reader.WS(), entity) && !hasShape(reader.WS(), entity))
    {
      lost.insert(number);
    }
  }
  return lost;
}

/// Causes only: what is lost because it refers to a broken entity is not listed again.
std::vector<UnreadEntity> listUnread(IGESControl_Reader& reader, const RepairedIges& file)
{
  const Handle(IGESData_IGESModel) model = reader.IGESModel();
  FailureMap failures = collectFailures(reader.WS());
  std::set<int> failed;
  for (const auto& [number, reason] : failures)
  {
    failed.insert(number);
  }
  for (const int number : findLost(reader))
  {
    if (!refersToAny(reader.WS(), model->Entity(number), failed))
    {
      failures.emplace(number, "gives no shape");
    }
  }
  std::vector<UnreadEntity> unread = file.unread();
  for (const auto& [number, reason] : failures)
  {
    if (!file.dependsOnBroken(directoryEntry(number)))
    {
      unread.push_back(makeUnread(model, number, reason));
    }
  }
  std::sort(unread.begin(), unread.end(),
    [](const UnreadEntity& a, const UnreadEntity& b) { return a.entity < b.entity; });
  return unread;
}

} // namespace

ReadShape readIges(const std::string& path)
{
  const RepairedIges file(path);
  IGESControl_Reader reader;
  if (reader.ReadFile(file.path().c_str()) != IFSelect_RetDone || reader.IGESModel().IsNull())
  {
    throw Error(path + ": not an IGES file that can be read");
  }
  ReadShape result;
  result.unit = takeUnit(reader.IGESModel());
  reader.TransferRoots();
  result.shape = joinRoots(sortRoots(reader), file.holdsSurfaces());
  result.unread = listUnread(reader, file);
  return result;
}

} // namespace cadrefine
