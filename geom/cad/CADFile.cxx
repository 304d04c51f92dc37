// 1. See that the file is there, can be read and begins as its kind of file does.
// 2. Read it, sew and heal what it holds, convert it to NURBS.
// 3. Write the model's bytes and build the model from them: so it is the same on every rank.

#include "CADFile.h"

#include "CADModelBuilder.h"
#include "FileCheck.h"
#include "ModelBytes.h"
#include "OccGuard.h"
#include "ShapePreparation.h"
#include "ShapeReaders.h"

#include <BRepBndLib.hxx>
#include <Bnd_Box.hxx>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace cadrefine
{
namespace
{

ReadShape readShape(const std::string& path, CADFormat format)
{
  switch (format)
  {
    case CADFormat::Iges:
      return readIges(path);
    case CADFormat::Step:
      return readStep(path);
    default:
      return readBrep(path);
  }
}

double diagonalOf(const TopoDS_Shape& shape)
{
  constexpr bool useTriangulation = false;
  constexpr bool useTolerance = false;
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape, box, useTriangulation, useTolerance);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

std::string listOf(const std::vector<UnreadEntity>& unread)
{
  constexpr std::size_t most = 5;
  std::string list;
  for (std::size_t i = 0; i < std::min(unread.size(), most); ++i)
  {
    const UnreadEntity& u = unread[i];
    const std::string entity = u.entity > 0 ? std::to_string(u.entity) + " " + u.type + ": " : "";
    list += (list.empty() ? " (unread: " : "; ") + entity + u.reason;
  }
  if (unread.size() > most)
  {
    list += "; and " + std::to_string(unread.size() - most) + " more";
  }
  return list.empty() ? list : list + ")";
}

ModelContent readContent(const std::string& path, CADFormat format)
{
  static std::mutex readersAreNotReentrant;
  const std::lock_guard<std::mutex> lock(readersAreNotReentrant);
  const QuietMessages quiet;
  ReadShape read = readShape(path, format);
  ModelContent content;
  content.shape = prepareShape(read.shape);
  if (content.shape.IsNull())
  {
    throw Error(path + ": holds no face and no curve that can be read" + listOf(read.unread));
  }
  content.unit = std::move(read.unit);
  content.unread = std::move(read.unread);
  content.size = diagonalOf(content.shape);
  return content;
}

} // namespace

std::shared_ptr<const CADModel> readCADFile(const std::string& path)
{
  const CADFormat format = checkFile(path);
  const ModelContent content = guardOcc(path, [&] { return readContent(path, format); });
  try
  {
    return CADModelBuilder::build(encodeModel(content));
  }
  catch (const Error& error)
  {
    throw Error(path + ": " + error.what());
  }
}

} // namespace cadrefine
