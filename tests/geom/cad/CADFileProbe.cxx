// Reads one CAD file and prints one line of JSON:
//   cad_file_probe here FILE [THREADS]     as CADRefine does: faces, edges, what is lost, or the
//   error cad_file_probe drawn FILE [THREADS]    the same, and draws what it read cad_file_probe
//   plain FILE              as Open CASCADE's plain reader does: faces, edges; may crash
// Or writes one, for measurements:
//   cad_file_probe boxes FILE COUNT        so many boxes, in STEP
// See cad_files.py, and tests/benchmarks/reading.py.

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/cad/model/ModelDrawing.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <IGESControl_Reader.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Compound.hxx>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace
{

std::string extensionOf(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension)
  {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return extension;
}

template<typename Reader>
TopoDS_Shape readWith(const std::string& path)
{
  Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
  {
    return {};
  }
  reader.TransferRoots();
  return reader.OneShape();
}

TopoDS_Shape readBrep(const std::string& path)
{
  std::string start(40, '\0');
  std::ifstream(path, std::ios::binary).read(start.data(), static_cast<long>(start.size()));
  TopoDS_Shape shape;
  if (start.find("Open CASCADE Topology") != std::string::npos)
  {
    BinTools::Read(shape, path.c_str());
  }
  else
  {
    BRepTools::Read(shape, path.c_str(), BRep_Builder());
  }
  return shape;
}

int countOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum type)
{
  TopTools_IndexedMapOfShape map;
  if (!shape.IsNull())
  {
    TopExp::MapShapes(shape, type, map);
  }
  return map.Extent();
}

void probePlain(const std::string& path)
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const std::string extension = extensionOf(path);
  const TopoDS_Shape shape = extension == ".brep" ? readBrep(path)
                             : extension == ".stp" || extension == ".step"
                               ? readWith<STEPControl_Reader>(path)
                               : readWith<IGESControl_Reader>(path);
  std::printf(
    "{\"faces\": %d, \"edges\": %d}\n", countOf(shape, TopAbs_FACE), countOf(shape, TopAbs_EDGE));
}

std::string quoted(const std::string& text)
{
  std::string result = "\"";
  for (const char c : text)
  {
    result += c == '"' || c == '\\' ? std::string("\\") + c
              : static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e
                ? std::string("?")
                : std::string(1, c);
  }
  return result + "\"";
}

std::string listed(const std::vector<cadrefine::UnreadEntity>& entities)
{
  std::string list;
  for (const auto& entity : entities)
  {
    list += list.empty() ? "" : ", ";
    list += quoted(std::to_string(entity.entity) + " " + entity.type + ": " + entity.reason);
  }
  return "[" + list + "]";
}

void probeHere(const std::string& path, int threads, bool drawn)
{
  try
  {
    const auto model = cadrefine::readCADFile(path, "", threads);
    if (drawn)
    {
      drawModel(*model, 1e-3 * model->size(), {}, threads);
    }
    std::printf("{\"faces\": %d, \"edges\": %d, \"unread\": %s, \"left_out\": %s}\n",
      model->count(2), model->count(1), listed(model->unread()).c_str(),
      listed(model->report().leftOut).c_str());
  }
  catch (const cadrefine::Error& error)
  {
    std::printf("{\"error\": %s}\n", quoted(error.what()).c_str());
  }
}

void writeBoxes(const std::string& path, int count)
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  constexpr int inARow = 60;
  const BRep_Builder builder;
  TopoDS_Compound boxes;
  builder.MakeCompound(boxes);
  for (int i = 0; i < count; ++i)
  {
    const int row = i / inARow;
    const gp_Pnt corner(2 * (i % inARow), 2 * row, 0);
    builder.Add(boxes, BRepPrimAPI_MakeBox(corner, 1, 1, 1).Shape());
  }
  STEPControl_Writer writer;
  writer.Transfer(boxes, STEPControl_AsIs);
  writer.Write(path.c_str());
}

void run(const std::string& what, const std::string& path, int number)
{
  if (what == "plain")
  {
    probePlain(path);
  }
  else if (what == "boxes")
  {
    writeBoxes(path, number);
  }
  else
  {
    probeHere(path, number, what == "drawn");
  }
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 3 && argc != 4)
  {
    std::fprintf(stderr, "usage: cad_file_probe here|drawn|plain|boxes FILE [THREADS|COUNT]\n");
    return 2;
  }
  try
  {
    run(argv[1], argv[2], argc == 4 ? std::atoi(argv[3]) : 1);
    return 0;
  }
  catch (const Standard_Failure& failure)
  {
    std::fprintf(stderr, "%s\n", failure.GetMessageString());
    return 1;
  }
}
