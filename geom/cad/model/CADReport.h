// What is told of a CAD file beside its geometry.
#pragma once

#include <cadrefine/base/Vector3.h>

#include <array>
#include <string>
#include <vector>

namespace cadrefine
{

/// Something in the file that is no part of the model.
struct UnreadEntity
{
  int entity = 0;        ///< IGES directory entry number, STEP instance number, number of a BREP
                         ///< file's face or edge from 1; 0: not known, or the file itself.
  std::string type;      ///< For example "IGES 128 (rational B-spline surface)".
  std::string reason;    ///< One line.
  std::string name = {}; ///< The name that the file gives it; empty: none.
};

/// Two edges of one face each that run beside each other, farther apart than was sewn.
struct Gap
{
  double width = 0; ///< The largest width found.
  Point3 point{};   ///< On the first edge, where it is that wide.
  std::array<int, 2> edges{};
};

struct CADReport
{
  /// Name of the length unit of the file, for example "mm", "m", "in"; empty where it has none.
  std::string unit;
  std::vector<UnreadEntity> unread; ///< What could not be read.
  /// Geometry that by the rules of the file's format is no part of the model, such as blanked
  /// entities.
  std::vector<UnreadEntity> leftOut;
  /// What was wrong with the file and has been repaired, each in a phrase.
  std::vector<std::string> repairs;
  /// Edges of faces that the file leaves apart are one edge where they were this near to each
  /// other; 0 where nothing had to be sewn.
  double sewingTolerance = 0;
  /// Gaps that were not sewn, the widest first: at most 1% of the model's size, and a quarter of
  /// the edges' length, wide.
  std::vector<Gap> gaps;
};

} // namespace cadrefine
