#include "ModelList.h"

#include "TestShapes.h"

#include <cadrefine/cad/import/CADFile.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gp_Ax2.hxx>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace exacttest
{
namespace
{

const char* const packagedFiles[] = {
  "/usr/share/doc/libdeal.ii-doc/examples/step-54/input/DTMB-5415_bulbous_bow.iges",
  "/usr/share/opencascade/data/iges/bearing.iges",
  "/usr/share/opencascade/data/iges/hammer.iges",
  "/usr/share/opencascade/data/occ/Axis_of_bearing.brep",
  "/usr/share/opencascade/data/occ/Ball.brep",
  "/usr/share/opencascade/data/occ/Bottom.brep",
  "/usr/share/opencascade/data/occ/CrankArm.brep",
  "/usr/share/opencascade/data/occ/MAT.brep",
  "/usr/share/opencascade/data/occ/MODERN_Chair_1.brep",
  "/usr/share/opencascade/data/occ/MODERN_Cooker_1.brep",
  "/usr/share/opencascade/data/occ/MODERN_Exhaust_1.brep",
  "/usr/share/opencascade/data/occ/MODERN_Sink_1.brep",
  "/usr/share/opencascade/data/occ/MODERN_Table_1.brep",
  "/usr/share/opencascade/data/occ/Motor-c.brep",
  "/usr/share/opencascade/data/occ/Pump_Nut.brep",
  "/usr/share/opencascade/data/occ/Pump_TopCover.brep",
  "/usr/share/opencascade/data/occ/Room.brep",
  "/usr/share/opencascade/data/occ/Top.brep",
  "/usr/share/opencascade/data/occ/asahi.brep",
  "/usr/share/opencascade/data/occ/bottle.brep",
  "/usr/share/opencascade/data/occ/edge.brep",
  "/usr/share/opencascade/data/occ/face.brep",
  "/usr/share/opencascade/data/occ/face1.brep",
  "/usr/share/opencascade/data/occ/face2.brep",
  "/usr/share/opencascade/data/occ/fuse.brep",
  "/usr/share/opencascade/data/occ/hammer.brep",
  "/usr/share/opencascade/data/occ/mal_ecrou.brep",
  "/usr/share/opencascade/data/occ/mal_tige.brep",
  "/usr/share/opencascade/data/occ/mal_vis.brep",
  "/usr/share/opencascade/data/occ/shell1.brep",
  "/usr/share/opencascade/data/occ/solid.brep",
  "/usr/share/opencascade/data/occ/terrain.brep",
  "/usr/share/opencascade/data/occ/wedge_ok.brep",
  "/usr/share/opencascade/data/occ/wing.brep",
  "/usr/share/opencascade/data/step/linkrods.step",
  "/usr/share/opencascade/data/step/screw.step",
};

struct NamedShape
{
  const char* name;
  TopoDS_Shape (*make)();
};

const NamedShape shapes[] = {
  { "sphere", [] { return cadtest::sphere(2.5); } },
  { "torus", [] { return cadtest::torus(3, 1); } },
  { "box", [] { return cadtest::box(1, 2, 3); } },
  { "cylinder", [] { return cadtest::cylinder(2, 5); } },
  { "pipe", [] { return cadtest::pipe(1, 2, 5); } },
  { "circle", [] { return cadtest::circle(2); } },
  { "rectangle", [] { return cadtest::rectangle(2, 1); } },
  { "cone", [] { return BRepPrimAPI_MakeCone(2, 0, 2).Shape(); } },
  { "drilled",
    []
    {
      const gp_Ax2 axis(gp_Pnt(5, 5, -1), gp_Dir(0, 0, 1));
      return BRepAlgoAPI_Cut(
        cadtest::box(10, 10, 10), BRepPrimAPI_MakeCylinder(axis, 2, 12).Shape())
        .Shape();
    } },
};

/// A name that GoogleTest takes, with the extension, since some files differ in that only.
std::string nameOf(const std::filesystem::path& path)
{
  std::string name = path.filename().string();
  std::replace_if(
    name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

std::vector<std::string> filesOfData()
{
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(CADREFINE_DATA))
  {
    if (entry.path().extension() == ".igs")
    {
      files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

} // namespace

std::vector<TestModel> allModels()
{
  std::vector<TestModel> models;
  for (const std::string& path : filesOfData())
  {
    models.push_back({ "data_" + nameOf(path), path, {}, {} });
  }
  for (const char* path : packagedFiles)
  {
    models.push_back({ "packaged_" + nameOf(path), path, {}, {} });
  }
  for (const NamedShape& shape : shapes)
  {
    for (const char* extension : { ".brep", ".step", ".igs" })
    {
      models.push_back(
        { std::string("shape_") + shape.name + "_" + (extension + 1), {}, shape.make, extension });
    }
  }
  return models;
}

std::shared_ptr<const cadrefine::CADModel> readModel(const TestModel& model)
{
  return model.shape ? cadtest::modelOf(model.shape(), model.extension)
                     : cadrefine::readCADFile(model.path);
}

} // namespace exacttest
