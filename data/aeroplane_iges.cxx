#include "aeroplane_iges.h"

#include <BRepToIGES_BRShell.hxx>
#include <BRep_Tool.hxx>
#include <GeomToIGES_GeomSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESData_IGESWriter.hxx>
#include <IGESData_Protocol.hxx>
#include <IGESSelect_WorkLibrary.hxx>
#include <Interface_FloatWriter.hxx>
#include <Interface_Static.hxx>
#include <TCollection_HAsciiString.hxx>
#include <Transfer_FinderProcess.hxx>

#include <fstream>
#include <stdexcept>

namespace aeroplane
{
namespace
{

Handle(TCollection_HAsciiString) text(const char* characters)
{
  return new TCollection_HAsciiString(characters);
}

void describe(IGESControl_Writer& writer)
{
  const Handle(IGESData_IGESModel)& model = writer.Model();
  IGESData_GlobalSection head = model->GlobalSection();
  head.SetSendName(text("aeroplane"));
  head.SetFileName(text("aeroplane.igs"));
  head.SetSystemId(text("CADRefine"));
  head.SetInterfaceVersion(text("aeroplane.cxx"));
  head.SetReceiveName(text("aeroplane"));
  head.SetAuthorName(text("CADRefine"));
  head.SetCompanyName(text("CADRefine"));
  head.SetDate(text("20240101.000000"));
  head.SetLastChangeDate(text("20240101.000000"));
  model->SetGlobalSection(head);
  model->AddStartLine("Aeroplane, made by data/aeroplane.cxx of CADRefine.");
}

Handle(IGESData_IGESEntity) convert(const NamedFace& named, IGESControl_Writer& writer)
{
  if (named.whole)
  {
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(named.face);
    GeomToIGES_GeomSurface converter;
    converter.SetModel(writer.Model());
    double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
    surface->Bounds(u0, u1, v0, v1);
    return converter.TransferSurface(surface, u0, u1, v0, v1);
  }
  BRepToIGES_BREntity settings;
  settings.SetModel(writer.Model());
  BRepToIGES_BRShell converter(settings);
  return converter.TransferFace(named.face);
}

} // namespace

void writeIges(const std::vector<NamedFace>& faces, const std::string& path)
{
  constexpr int trimmedSurfaces = 0, splinePlanes = 1;
  IGESControl_Controller::Init();
  Interface_Static::SetIVal("write.iges.plane.mode", splinePlanes);
  IGESControl_Writer writer("M", trimmedSurfaces);
  describe(writer);
  for (const NamedFace& named : faces)
  {
    const Handle(IGESData_IGESEntity) entity = convert(named, writer);
    if (entity.IsNull() || !writer.AddEntity(entity))
    {
      throw std::runtime_error(std::string("a face cannot be written: ") + named.name);
    }
    entity->SetLabel(text(named.name));
    entity->InitColor({}, named.color);
  }
  writer.ComputeModel();
  IGESData_IGESWriter sender(writer.Model());
  sender.FloatWriter().SetFormat("%.10G");
  sender.SendModel(IGESSelect_WorkLibrary::DefineProtocol());
  std::ofstream file(path, std::ios::binary);
  if (!sender.Print(file))
  {
    throw std::runtime_error("cannot write " + path);
  }
}

} // namespace aeroplane
