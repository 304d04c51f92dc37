// IGES files, through Open CASCADE's reader.
//
// 1. Set broken entities aside and repair what can be repaired (IgesRepair).
// 2. Find the entities that stand for the model (IgesTopLevel).
// 3. Load the file; take its unit's name and declare the numbers to be millimetres, so that the
//    transfer scales nothing.
// 4. Put right what Open CASCADE reads wrongly (IgesCorrections), and transfer the roots. (Open
// CASCADE's own choice of roots takes blanked entities and aids, and
//    drops what a drawing or a dimension refers to.)
// 5. List the entities that failed and the roots that gave no shape.

#include <cadrefine/cad/import/OccGuard.h>
#include <cadrefine/cad/readers/CheckLists.h>
#include <cadrefine/cad/readers/OccProgress.h>
#include <cadrefine/cad/readers/ShapeReaders.h>
#include <cadrefine/cad/readers/iges/IgesAttributes.h>
#include <cadrefine/cad/readers/iges/IgesCorrections.h>
#include <cadrefine/cad/readers/iges/IgesRepair.h>
#include <cadrefine/cad/readers/iges/IgesTopLevel.h>
#include <cadrefine/cad/readers/iges/IgesTypes.h>

#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <TColStd_HSequenceOfTransient.hxx>
#include <TCollection_HAsciiString.hxx>
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

int directoryEntry(int number)
{
  return 2 * number - 1;
}

int numberOf(int directoryEntry)
{
  return (directoryEntry + 1) / 2;
}

void transfer(IGESControl_Reader& reader, const std::vector<int>& roots)
{
  const Handle(TColStd_HSequenceOfTransient) list = new TColStd_HSequenceOfTransient;
  for (const int root : roots)
  {
    list->Append(reader.IGESModel()->Entity(numberOf(root)));
  }
  const Handle(OccProgress) progress = new OccProgress;
  reader.TransferList(list, progress->Start());
}

/// Numbers in the model of the roots and of all that they are made of.
std::set<int> findUsed(const RepairedIges& file, const std::vector<int>& roots)
{
  std::set<int> used;
  std::vector<int> open = roots;
  while (!open.empty())
  {
    const int number = numberOf(open.back());
    open.pop_back();
    const bool exists = number >= 1 && number <= static_cast<int>(file.parts().size());
    if (exists && used.insert(number).second)
    {
      const auto& parts = file.parts()[static_cast<std::size_t>(number) - 1];
      open.insert(open.end(), parts.begin(), parts.end());
    }
  }
  return used;
}

UnreadEntity makeUnread(
  const Handle(IGESData_IGESModel) & model, int number, const std::string& reason)
{
  const FileEntity entity = number > 0 ? igesEntity(*model->Entity(number), number) : FileEntity();
  return { entity.number, entity.type, reason, "" };
}

/// Causes only: what is lost because it is made of a broken entity is not listed again.
std::vector<UnreadEntity> listUnread(
  IGESControl_Reader& reader, const RepairedIges& file, const IgesTopLevel& roots)
{
  const Handle(IGESData_IGESModel) model = reader.IGESModel();
  FailureMap failures = collectFailures(reader.WS());
  std::set<int> failed;
  for (const auto& [number, reason] : failures)
  {
    failed.insert(number);
  }
  for (const int root : roots.kept)
  {
    const Handle(IGESData_IGESEntity) entity = model->Entity(numberOf(root));
    if (!hasShape(reader.WS(), entity) && !refersToAny(reader.WS(), entity, failed))
    {
      failures.emplace(numberOf(root), "gives no shape");
    }
  }
  std::vector<UnreadEntity> unread = file.unread();
  for (const auto& [number, reason] : failures)
  {
    const int entry = directoryEntry(number);
    if (!file.isBroken(entry) && !file.dependsOnBroken(entry))
    {
      unread.push_back(makeUnread(model, number, reason));
    }
  }
  std::sort(unread.begin(), unread.end(),
    [](const UnreadEntity& a, const UnreadEntity& b) { return a.entity < b.entity; });
  return unread;
}

} // namespace

ReadShape readIges(const std::string& path, OptionalSteps& steps)
{
  const RepairedIges file(path);
  IGESControl_Reader reader;
  if (reader.ReadFile(file.path().c_str()) != IFSelect_RetDone || reader.IGESModel().IsNull())
  {
    throw Error(path + ": cannot be read as an IGES file");
  }
  ReadShape result;
  IgesTopLevel roots = findIgesRoots(file);
  result.report.unit = takeUnit(reader.IGESModel());
  composeMatrices(reader.IGESModel());
  makeOwnShapes(reader, findUsed(file, roots.kept));
  transfer(reader, roots.kept);
  result.shape = joinShapes(reader);
  result.report.unread = listUnread(reader, file, roots);
  result.report.leftOut = std::move(roots.leftOut);
  result.report.repairs = file.repairs();
  if (roots.allBlanked)
  {
    result.report.repairs.emplace_back("all of its geometry is blanked, but was read nevertheless");
  }
  steps.run(
    ReadStep::Attributes, [&] { result.attributeMap = collectIgesAttributes(reader.WS()); });
  return result;
}

} // namespace cadrefine
