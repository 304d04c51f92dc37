// The CAD models on which the closest point is tested for exactness.
#pragma once

#include <cadrefine/cad/model/CADModel.h>

#include <TopoDS_Shape.hxx>

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace exacttest
{

/// A model is either a file, or a shape that is written in the format of `extension` first.
struct TestModel
{
  std::string name;                    ///< For the test's name: letters, digits and underscores.
  std::string path;                    ///< Empty for a shape.
  std::function<TopoDS_Shape()> shape; ///< Empty for a file.
  std::string extension;
};

inline void PrintTo(const TestModel& model, std::ostream* out)
{
  *out << model.name;
}

/// Every CAD file in data/, the CAD files of the Debian packages occt-misc and libdeal.ii-doc, and
/// shapes in each format.
std::vector<TestModel> allModels();

/// Reads the model as any user of the library does; throws where its file is missing.
std::shared_ptr<const cadrefine::CADModel> readModel(const TestModel& model);

} // namespace exacttest
