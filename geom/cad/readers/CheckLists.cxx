#include <cadrefine/cad/readers/CheckLists.h>

#include <cadrefine/cad/import/OccGuard.h>

#include <BRep_Builder.hxx>
#include <Interface_Check.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Interface_InterfaceModel.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>

#include <vector>

namespace cadrefine
{
namespace
{

void addFailures(const Interface_CheckIterator& checks, FailureMap& failures)
{
  for (checks.Start(); checks.More(); checks.Next())
  {
    const Handle(Interface_Check)& check = checks.Value();
    if (!check.IsNull() && check->NbFails() > 0)
    {
      failures.emplace(checks.Number(), oneLine(check->CFail(1)));
    }
  }
}

bool isNotEmpty(const TopoDS_Shape& shape)
{
  return !shape.IsNull() && (TopExp_Explorer(shape, TopAbs_EDGE).More() ||
                              TopExp_Explorer(shape, TopAbs_VERTEX).More());
}

} // namespace

FailureMap collectFailures(const Handle(XSControl_WorkSession) & session)
{
  FailureMap failures;
  addFailures(session->ModelCheckList(false), failures);
  addFailures(session->TransferReader()->LastCheckList(), failures);
  return failures;
}

bool hasShape(
  const Handle(XSControl_WorkSession) & session, const Handle(Standard_Transient) & entity)
{
  const Handle(XSControl_TransferReader) transfer = session->TransferReader();
  return isNotEmpty(transfer->ShapeResult(entity)) ||
         isNotEmpty(TransferBRep::ShapeResult(transfer->TransientProcess(), entity));
}

bool refersToAny(const Handle(XSControl_WorkSession) & session,
  const Handle(Standard_Transient) & entity, const std::set<int>& numbers)
{
  const Interface_Graph& graph = session->Graph();
  std::set<int> seen;
  std::vector<int> open{ graph.EntityNumber(entity) };
  while (!open.empty())
  {
    const int number = open.back();
    open.pop_back();
    if (numbers.count(number) > 0)
    {
      return true;
    }
    if (number <= 0 || !seen.insert(number).second)
    {
      continue;
    }
    Interface_EntityIterator shared = graph.Shareds(graph.Entity(number));
    for (shared.Start(); shared.More(); shared.Next())
    {
      open.push_back(graph.EntityNumber(shared.Value()));
    }
  }
  return false;
}

TopoDS_Shape joinShapes(const XSControl_Reader& reader)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (int i = 1; i <= reader.NbShapes(); ++i)
  {
    builder.Add(compound, reader.Shape(i));
  }
  return compound;
}

} // namespace cadrefine
