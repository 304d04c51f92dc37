// Sorts out broken entities of an IGES file before Open CASCADE reads it, and repairs common
// faults. Private to geom/cad.
#pragma once

#include <cadrefine/cad/model/CADModel.h>
#include <cadrefine/cad/readers/iges/IgesText.h>

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
  /// no numbers, too few of them, or impossible degrees, knots or weights becomes a null entity,
  /// and so does what is made of itself.
  /// Repaired are: parameter lines that run one column too far; parameters without a terminator,
  /// where none is missing; and what readIgesText calls faults. Nothing is written, and the file
  /// itself is read, where nothing is wrong.
  explicit RepairedIges(const std::string& path);
  ~RepairedIges();
  RepairedIges(const RepairedIges&) = delete;
  RepairedIges& operator=(const RepairedIges&) = delete;

  const std::string& path() const { return path_; }
  const std::vector<UnreadEntity>& unread() const { return unread_; }
  /// What was repaired, each in a phrase.
  const std::vector<std::string>& repairs() const { return text_.faults; }

  /// The entities as they stand in the file given, with what each is made of (igesParts, and its
  /// transformation).
  const std::vector<IgesEntry>& entries() const { return text_.entries; }
  const std::vector<std::vector<int>>& parts() const { return parts_; }
  bool isBroken(int number) const { return broken_.count(number) > 0; }
  /// True where entity `number` is not broken itself, but is made of a broken one.
  bool dependsOnBroken(int number) const { return dependents_.count(number) > 0; }

private:
  void checkEntries();
  void checkReferences();
  void setAside(const IgesEntry& entry, const std::string& reason);
  void write();

  IgesText text_;
  std::string path_;
  int temporary_ = -1; ///< Descriptor of the file written, -1: none.
  std::vector<UnreadEntity> unread_;
  std::vector<std::vector<int>> parts_;
  std::set<int> broken_;
  std::set<int> dependents_;
};

} // namespace cadrefine
