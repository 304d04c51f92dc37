#include <cadrefine/cad/readers/iges/IgesAttributes.h>

#include <cadrefine/cad/import/OccGuard.h>
#include <cadrefine/cad/readers/iges/IgesTypes.h>

#include <IGESData_IGESType.hxx>
#include <IGESGraph_Color.hxx>
#include <Interface_InterfaceModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>

#include <algorithm>

namespace cadrefine
{
namespace
{

using Colour = std::array<float, 3>;

/// Field 13 of a directory entry: 1 black, 2 red, 3 green, 4 blue, 5 yellow, 6 magenta, 7 cyan,
/// 8 white.
std::optional<Colour> colourOfNumber(int number)
{
  static const std::array<Colour, 8> colours{ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
    { 1, 1, 0 }, { 1, 0, 1 }, { 0, 1, 1 }, { 1, 1, 1 } } };
  const bool known = number >= 1 && number <= static_cast<int>(colours.size());
  return known ? std::optional(colours[number - 1]) : std::nullopt;
}

/// A colour definition gives each part in percent.
std::optional<Colour> colourOfDefinition(const Handle(IGESGraph_Color) & definition)
{
  if (definition.IsNull())
  {
    return std::nullopt;
  }
  Colour colour{};
  std::array<double, 3> percent{};
  definition->RGBIntensity(percent[0], percent[1], percent[2]);
  std::transform(percent.begin(), percent.end(), colour.begin(),
    [](double part) { return static_cast<float>(std::clamp(part / 100, 0.0, 1.0)); });
  return colour;
}

std::optional<Colour> colourOf(const IGESData_IGESEntity& entity)
{
  switch (entity.DefColor())
  {
    case IGESData_DefValue:
      return colourOfNumber(entity.RankColor());
    case IGESData_DefReference:
      return colourOfDefinition(Handle(IGESGraph_Color)::DownCast(entity.Color()));
    default:
      return std::nullopt;
  }
}

std::string nameOf(const IGESData_IGESEntity& entity)
{
  const Handle(TCollection_HAsciiString) value = entity.NameValue();
  const std::string name = value.IsNull() ? "" : oneLine(value->ToCString());
  const std::string noSubscript = "(0)";
  const std::size_t end = name.rfind(noSubscript);
  return end + noSubscript.size() == name.size() ? oneLine(name.substr(0, end)) : name;
}

} // namespace

FileEntity igesEntity(const IGESData_IGESEntity& entity, int number)
{
  return { 2 * number - 1, igesTypeName(entity.IGESType().Type()) };
}

AttributeMap collectIgesAttributes(const Handle(XSControl_WorkSession) & session)
{
  const Handle(Interface_InterfaceModel) model = session->Model();
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  std::vector<FoundAttributes> found;
  for (int number = 1; number <= model->NbEntities(); ++number)
  {
    const auto entity = Handle(IGESData_IGESEntity)::DownCast(model->Value(number));
    const TopoDS_Shape shape =
      entity.IsNull() ? TopoDS_Shape() : TransferBRep::ShapeResult(process, entity);
    if (!shape.IsNull())
    {
      found.push_back(
        { shape, { nameOf(*entity), colourOf(*entity) }, igesEntity(*entity, number) });
    }
  }
  return sortAttributes(std::move(found));
}

} // namespace cadrefine
