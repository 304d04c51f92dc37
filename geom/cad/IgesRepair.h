// Sorts out broken entities of an IGES file before Open CASCADE reads it, and repairs a common
// fault. Private to geom/cad.
#pragma once

#include "CADModel.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace cadrefine
{

/// The file to read in place of the one given, and what was wrong with that.
class RepairedIges
{
public:
  /// Open CASCADE 7.6 crashes on some malformed parameters, so geometry with parameters that are
  /// no numbers, too few of them, or impossible degrees, knots or weights becomes a null entity.
  /// Parameter lines that run one column too far are wrapped anew. Nothing is written, and the
  /// file itself is read, where neither is needed.
  explicit RepairedIges(const std::string& path);
  ~RepairedIges();
  RepairedIges(const RepairedIges&) = delete;
  RepairedIges& operator=(const RepairedIges&) = delete;

  const std::string& path() const { return this->path_; }
  const std::vector<UnreadEntity>& unread() const { return this->unread_; }
  /// True where the file has surfaces, broken or not.
  bool holdsSurfaces() const { return this->holdsSurfaces_; }
  /// True where entity `number` refers to a broken one.
  bool dependsOnBroken(int number) const { return this->dependents_.count(number) > 0; }

private:
  std::string path_;
  bool temporary_ = false;
  bool holdsSurfaces_ = false;
  std::vector<UnreadEntity> unread_;
  std::set<int> dependents_;
};

} // namespace cadrefine
