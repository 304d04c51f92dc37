// A model to measure on, with points near it.
#pragma once

#include <cadrefine/cad/model/CADModel.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cadbenchmark
{

struct Region
{
  cadrefine::Point3 low, high;
};

/// Where a case comes from. The first of `paths` that exists is read.
struct CaseSource
{
  std::string name;
  std::vector<std::string> paths;
  std::optional<Region>
    region; ///< Keeps only the faces whose middle lies in it, with their border.
};

/// A point off the surface.
struct Sample
{
  cadrefine::Point3 point;
  int face = -1;     ///< The face that it was made from, in the case's own model.
  int readFace = -1; ///< The same face in the model that was read.
};

/// What it took to prepare a case.
struct Preparation
{
  double readSeconds = 0; ///< Elapsed, from the file to NURBS.
  double buildSeconds = 0;
  std::size_t bytes = 0; ///< Heap memory of the search structure.
  std::size_t patches = 0;
};

/// A model, its search structure and points. `scattered` are drawn evenly over the area of the
/// trimmed faces, and moved along the normal to either side by up to 1e-3 of the model's size.
struct Case
{
  std::string name;
  std::shared_ptr<const cadrefine::CADModel> model; ///< All of the file.
  cadrefine::NurbsModel nurbs;                      ///< All of it, or what is in the region.
  std::unique_ptr<const cadrefine::ClosestPointSearch> search; ///< Over `nurbs`.
  std::vector<Sample> scattered;
  Preparation preparation;
};

/// Null where none of the paths exists.
std::unique_ptr<const Case> loadCase(const CaseSource& source, int points);

} // namespace cadbenchmark
