// Faces of a model, or edges, that a user has chosen.
#pragma once

#include <cadrefine/cad/model/CADModel.h>

#include <string>
#include <vector>

namespace cadrefine
{

/// Entities of one dimension: faces, or edges where a mesh is planar.
struct EntitySelection
{
  int dimension = 2;
  std::vector<unsigned char> chosen;   ///< 1 for each entity that is chosen.
  std::vector<double> chordTolerances; ///< Chord tolerance of each entity; 0: none of its own.

  /// Whether the entity is chosen, or (of lower dimension) lies on the border of one that is.
  bool contains(const NurbsModel& model, EntityId entity) const;
  bool hasTolerances() const;
};

/// The entities that `wanted` names: each entry a name in the CAD file, a pattern of names as in a
/// shell (`*`, `?`, `[...]`; `*` alone is all, those without a name too), or an index, if no name
/// is like that. `!` before it takes these away (from all, if it is the first entry), `=` and a
/// length after it is their chord tolerance. Throws Error, which begins with `property`, for an
/// entry that fits nothing and for a tolerance that is no positive number; it lists what there is.
EntitySelection selectEntities(const CADModel& model, int dimension,
  const std::vector<std::string>& wanted, const std::string& property);

/// The entry of selectEntities that stands for this entity alone: its name, or its index where the
/// name is missing, or is not its own, or would be read as something else (a pattern, a tolerance).
/// (No entry does where such an index is another one's name.)
std::string entryOf(const CADModel& model, EntityId entity);

} // namespace cadrefine
