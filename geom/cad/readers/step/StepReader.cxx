// STEP files, through Open CASCADE's reader.
//
// 1. See that no number is too large for double.
// 2. Load the file; find its first length unit, and make it the unit of the transfer, so that
//    nothing is scaled (parts in other units are scaled to this one).
// 3. Transfer every root.
// 4. List the entities that failed, and the faces and roots that gave no shape.

#include <cadrefine/cad/import/FileCheck.h>
#include <cadrefine/cad/import/OccGuard.h>
#include <cadrefine/cad/model/LengthUnit.h>
#include <cadrefine/cad/readers/CheckLists.h>
#include <cadrefine/cad/readers/OccProgress.h>
#include <cadrefine/cad/readers/ShapeReaders.h>
#include <cadrefine/cad/readers/step/StepAttributes.h>
#include <cadrefine/cad/readers/step/StepNumbers.h>

#include <STEPConstruct_UnitContext.hxx>
#include <STEPControl_Reader.hxx>
#include <StepBasic_DocumentFile.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <XSControl_WorkSession.hxx>

#include <set>

namespace cadrefine
{
namespace
{

using Units = Handle(StepRepr_GlobalUnitAssignedContext);

Units unitsOf(const Handle(Standard_Transient) & entity)
{
  using WithUncertainty = StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx;
  using WithoutUncertainty = StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext;
  if (const Handle(WithUncertainty) context = Handle(WithUncertainty)::DownCast(entity))
  {
    return context->GlobalUnitAssignedContext();
  }
  if (const Handle(WithoutUncertainty) context = Handle(WithoutUncertainty)::DownCast(entity))
  {
    return context->GlobalUnitAssignedContext();
  }
  return {};
}

/// STEPConstruct_UnitContext::ComputeFactors; since Open CASCADE 7.8 it takes the factors of the
/// session as well: by default, those of a session in millimetres.
template<class... SessionFactors>
void computeFactors(STEPConstruct_UnitContext& converter,
  Standard_Integer (STEPConstruct_UnitContext::*compute)(const Units&, const SessionFactors&...),
  const Units& units)
{
  (converter.*compute)(units, SessionFactors()...);
}

/// Length of the first unit that the file declares, in millimetres; 1 where it declares none.
double findLengthUnit(STEPControl_Reader& reader)
{
  reader.SetSystemLengthUnit(1.0);
  const Handle(StepData_StepModel) model = reader.StepModel();
  for (int number = 1; number <= model->NbEntities(); ++number)
  {
    const Units units = unitsOf(model->Value(number));
    if (units.IsNull())
    {
      continue;
    }
    STEPConstruct_UnitContext converter;
    computeFactors(converter, &STEPConstruct_UnitContext::ComputeFactors, units);
    if (converter.LengthDone())
    {
      return converter.LengthFactor();
    }
  }
  return 1;
}

/// What the file calls its unit, where the length is none of the usual ones.
std::string unitName(STEPControl_Reader& reader, double millimetres)
{
  TColStd_SequenceOfAsciiString lengths, angles, solidAngles;
  reader.FileUnits(lengths, angles, solidAngles);
  const std::string name = shortUnitName(millimetres);
  return lengths.IsEmpty() || !name.empty() ? name : shortUnitName(lengths(1).ToCString());
}

UnreadEntity makeUnread(
  const Handle(XSControl_WorkSession) & session, int number, const std::string& reason)
{
  const FileEntity entity = number > 0 ? stepEntity(*session, number) : FileEntity();
  return { entity.number, entity.type, reason, "" };
}

/// "" where the entity is no other file that holds a part.
std::string otherFile(const Handle(Standard_Transient) & entity)
{
  const auto file = Handle(StepBasic_DocumentFile)::DownCast(entity);
  const std::string name =
    file.IsNull() || file->Id().IsNull() ? "" : oneLine(file->Id()->ToCString());
  return formatOf(name) ? name : "";
}

/// Styles of lines, texts and their like, which no shape depends on.
bool isPresentation(const Standard_Transient& entity)
{
  return std::string(entity.DynamicType()->Name()).rfind("StepVisual_", 0) == 0;
}

std::vector<UnreadEntity> listUnread(STEPControl_Reader& reader)
{
  const Handle(StepData_StepModel) model = reader.StepModel();
  FailureMap failures = collectFailures(reader.WS());
  std::set<int> failed;
  for (const auto& [number, reason] : failures)
  {
    failed.insert(number);
  }
  const auto addLost = [&](const Handle(Standard_Transient) & entity)
  {
    if (!hasShape(reader.WS(), entity) && !refersToAny(reader.WS(), entity, failed))
    {
      failures.emplace(model->Number(entity), "gives no shape");
    }
  };
  for (int number = 1; number <= model->NbEntities(); ++number)
  {
    if (model->Value(number)->IsKind(STANDARD_TYPE(StepShape_FaceSurface)))
    {
      addLost(model->Value(number));
    }
    const std::string other = otherFile(model->Value(number));
    if (!other.empty())
    {
      failures.emplace(number, "a part of the assembly is in a file of its own, " + other);
    }
  }
  std::vector<UnreadEntity> unread;
  for (const auto& [number, reason] : failures)
  {
    if (number <= 0 || !isPresentation(*model->Value(number)))
    {
      unread.push_back(makeUnread(reader.WS(), number, reason));
    }
  }
  return unread;
}

} // namespace

ReadShape readStep(const std::string& path, OptionalSteps& steps)
{
  checkStepNumbers(path);
  STEPControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone || reader.StepModel().IsNull())
  {
    throw Error(path + ": cannot be read as a STEP file");
  }
  ReadShape result;
  const double millimetres = findLengthUnit(reader);
  result.report.unit = unitName(reader, millimetres);
  reader.SetSystemLengthUnit(millimetres);
  const Handle(OccProgress) progress = new OccProgress;
  reader.TransferRoots(progress->Start());
  result.shape = joinShapes(reader);
  steps.run(
    ReadStep::Attributes, [&] { result.attributeMap = collectStepAttributes(reader.WS()); });
  result.report.unread = listUnread(reader);
  return result;
}

} // namespace cadrefine
