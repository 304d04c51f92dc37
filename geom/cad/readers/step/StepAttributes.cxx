#include <cadrefine/cad/readers/step/StepAttributes.h>

#include <cadrefine/cad/import/OccGuard.h>

// Before STEPConstruct_Styles.hxx, which in Open CASCADE 7.8 uses it and does not include it.
#include <StepData_StepModel.hxx>

#include <Interface_InterfaceModel.hxx>
#include <Quantity_Color.hxx>
#include <STEPConstruct_Styles.hxx>
#include <StepData_Protocol.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepSelect_StepType.hxx>
#include <StepVisual_Colour.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>

#include <cstdlib>

namespace cadrefine
{
namespace
{

/// "NONE" is what some programs write for no name.
std::string nameOf(const StepRepr_RepresentationItem& item)
{
  const Handle(TCollection_HAsciiString) name = item.Name();
  const std::string text = name.IsNull() ? "" : oneLine(name->ToCString());
  return text == "NONE" ? "" : text;
}

/// The colour of a style: that of surfaces where the shape has faces, else that of curves.
std::optional<std::array<float, 3>> colourOf(const STEPConstruct_Styles& styles,
  const Handle(StepVisual_StyledItem) & style, const TopoDS_Shape& shape)
{
  Handle(StepVisual_Colour) surface, boundary, curve, rendering;
  double transparency = 0;
  bool ofComponent = false;
  styles.GetColors(style, surface, boundary, curve, rendering, transparency, ofComponent);
  const Handle(StepVisual_Colour) ofFaces = surface.IsNull() ? rendering : surface;
  const bool hasFace = TopExp_Explorer(shape, TopAbs_FACE).More();
  const Handle(StepVisual_Colour)& found = hasFace ? ofFaces : curve;
  Quantity_Color colour;
  if (found.IsNull() || !STEPConstruct_Styles::DecodeColor(found, colour)) // which crashes on null
  {
    return std::nullopt;
  }
  std::array<double, 3> rgb{};
  colour.Values(rgb[0], rgb[1], rgb[2], Quantity_TOC_sRGB);
  return std::array<float, 3>{ static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
    static_cast<float>(rgb[2]) };
}

} // namespace

FileEntity stepEntity(const XSControl_WorkSession& session, int number)
{
  const auto model = Handle(StepData_StepModel)::DownCast(session.Model());
  const Handle(Standard_Transient) entity = model->Value(number);
  StepSelect_StepType typeOf;
  typeOf.SetProtocol(model->Protocol());
  const std::string type = typeOf.Value(entity, model);
  const std::string label = model->StringLabel(entity)->ToCString();
  return { label.size() > 1 ? std::atoi(label.c_str() + 1) : number,
    type.empty() ? "STEP" : "STEP " + type };
}

AttributeMap collectStepAttributes(const Handle(XSControl_WorkSession) & session)
{
  const Handle(Interface_InterfaceModel) model = session->Model();
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  std::vector<FoundAttributes> found;
  for (int number = 1; number <= model->NbEntities(); ++number)
  {
    const auto item = Handle(StepRepr_RepresentationItem)::DownCast(model->Value(number));
    const TopoDS_Shape shape =
      item.IsNull() ? TopoDS_Shape() : TransferBRep::ShapeResult(process, item);
    if (!shape.IsNull())
    {
      FoundAttributes& attributes = found.emplace_back();
      attributes.shape = shape;
      attributes.attributes.name = nameOf(*item);
      if (shape.ShapeType() == TopAbs_FACE || shape.ShapeType() == TopAbs_EDGE)
      {
        attributes.entity = stepEntity(*session, number);
      }
    }
  }
  STEPConstruct_Styles styles(session);
  styles.LoadStyles();
  for (int i = 1; i <= styles.NbStyles(); ++i)
  {
    const Handle(StepVisual_StyledItem) style = styles.Style(i);
    const TopoDS_Shape shape =
      style->Item().IsNull() ? TopoDS_Shape() : TransferBRep::ShapeResult(process, style->Item());
    if (!shape.IsNull())
    {
      found.push_back({ shape, { "", colourOf(styles, style, shape) }, {} });
    }
  }
  return sortAttributes(std::move(found));
}

} // namespace cadrefine
