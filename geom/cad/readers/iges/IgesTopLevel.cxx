// Parts are told from wholes by what the entities are made of, not by their subordinate switch,
// which many writers set wrongly.

#include <cadrefine/cad/readers/iges/IgesTopLevel.h>

#include <cadrefine/cad/readers/iges/IgesTypes.h>

#include <algorithm>
#include <set>

namespace cadrefine
{
namespace
{

enum class Role
{
  Model,
  Aid,     ///< Part of the model where there is nothing else.
  Blanked, ///< Part of the model where there is not even an aid.
  None
};

struct Judgement
{
  Role role = Role::Model;
  const char* reason = "";
};

/// Linear paths (106): other forms are sets of points, centre lines, sections and witness lines.
bool isPath(int form)
{
  return (form >= 11 && form <= 13) || form == 63;
}

/// What the type and form alone tell.
Judgement judgeForm(const IgesEntry& entry)
{
  switch (entry.type)
  {
    case 106:
      return entry.form >= 1 && entry.form <= 3 ? Judgement{ Role::Aid, "a set of points" }
             : isPath(entry.form)               ? Judgement{}
                                                : Judgement{ Role::None, "annotation" };
    case 108:
      return entry.form == 1    ? Judgement{}
             : entry.form == -1 ? Judgement{ Role::None, "a hole that no plane refers to" }
                                : Judgement{ Role::None, "an unbounded plane" };
    case 110:
      return entry.form == 0 ? Judgement{} : Judgement{ Role::None, "an unbounded line" };
    case 116:
      return { Role::None, "a point" };
    case 308:
      return { Role::None, "a subfigure that is placed nowhere" };
    default:
      return {};
  }
}

Judgement judgeUse(int use)
{
  switch (use)
  {
    case 1:
      return { Role::None, "annotation (use flag 01)" };
    case 2:
      return { Role::None, "a definition (use flag 02) that is placed nowhere" };
    case 3:
      return { Role::Aid, "of other use (use flag 03)" };
    case 4:
      return { Role::None, "logical (use flag 04)" };
    case 5:
      return { Role::None, "a curve in a parameter plane (use flag 05)" };
    case 6:
      return { Role::Aid, "construction geometry (use flag 06)" };
    default:
      return {};
  }
}

class RootFinder
{
public:
  explicit RootFinder(const RepairedIges& file) : file_(file)
  {
    const auto& entries = file.entries();
    for (std::size_t i = 0; i < entries.size(); ++i)
    {
      referred_.insert(file.parts()[i].begin(), file.parts()[i].end());
    }
    for (const IgesEntry& entry : entries)
    {
      if (referred_.count(entry.number) == 0)
      {
        visit(entry, entry.status.blanked);
      }
    }
  }

  IgesTopLevel finish()
  {
    IgesTopLevel roots;
    const auto& kept = !model_.empty() ? model_ : !aids_.empty() ? aids_ : blanked_;
    roots.allBlanked = &kept == &blanked_ && !kept.empty();
    for (const IgesEntry* entry : kept)
    {
      if (!file_.isBroken(entry->number))
      {
        roots.kept.push_back(entry->number);
      }
    }
    std::sort(roots.kept.begin(), roots.kept.end());
    for (const auto& [entry, reason] : leftOut_)
    {
      if (&kept == &model_ || std::find(kept.begin(), kept.end(), entry) == kept.end())
      {
        roots.leftOut.push_back({ entry->number, igesTypeName(entry->type), reason });
      }
    }
    return roots;
  }

private:
  /// `blanked`: by its own status, or by that of the group it is physically a part of.
  void visit(const IgesEntry& entry, bool blanked)
  {
    if (!visited_.insert(entry.number).second)
    {
      return;
    }
    if (isOpenGroup(entry))
    {
      visitMembers(entry, blanked);
    }
    else if (isIgesPartOfModel(entry.type) || isPlaced(entry))
    {
      judge(entry, blanked);
    }
  }

  void visitMembers(const IgesEntry& group, bool blanked)
  {
    for (const int number : file_.parts()[static_cast<std::size_t>(group.number) / 2])
    {
      const std::size_t index = static_cast<std::size_t>(number) / 2;
      if (number % 2 == 1 && index < file_.entries().size())
      {
        const IgesEntry& member = file_.entries()[index];
        const bool follows = group.status.hierarchy == 0 && member.status.subordinate % 2 == 1;
        visit(member, follows ? blanked : member.status.blanked);
      }
    }
  }

  void judge(const IgesEntry& entry, bool blanked)
  {
    Judgement judgement = judgeForm(entry);
    if (judgement.role == Role::Model)
    {
      judgement = judgeUse(entry.status.use);
    }
    if (!file_.unread().empty() && entry.status.subordinate % 2 == 1)
    {
      judgement = { Role::None, "a part of another entity, which is broken" };
    }
    if (blanked)
    {
      judgement = { judgement.role == Role::Model ? Role::Blanked : Role::None, "blanked" };
    }
    if (judgement.role != Role::None)
    {
      auto& list = judgement.role == Role::Model ? model_
                   : judgement.role == Role::Aid ? aids_
                                                 : blanked_;
      list.push_back(&entry);
    }
    if (judgement.role != Role::Model)
    {
      leftOut_.emplace_back(&entry, judgement.reason);
    }
  }

  /// A group without a place of its own; its members stand for themselves.
  static bool isOpenGroup(const IgesEntry& entry)
  {
    return entry.type == 402 && entry.form != 9 && entry.matrix == 0;
  }

  static bool isPlaced(const IgesEntry& entry)
  {
    return isIgesGroup(entry.type) && (entry.type != 402 || entry.form == 9 || entry.matrix != 0);
  }

  const RepairedIges& file_;
  std::set<int> referred_;
  std::set<int> visited_;
  std::vector<const IgesEntry*> model_;
  std::vector<const IgesEntry*> aids_;
  std::vector<const IgesEntry*> blanked_;
  std::vector<std::pair<const IgesEntry*, std::string>> leftOut_;
};

} // namespace

IgesTopLevel findIgesRoots(const RepairedIges& file)
{
  return RootFinder(file).finish();
}

} // namespace cadrefine
