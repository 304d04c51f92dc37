#include "classification/OddFacets.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/classification/CADAdjacency.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

/// What surrounds a patch of odd facets that meet at edges.
struct Surroundings
{
  static constexpr std::int32_t none = -2;

  unsigned char isSeveral = 0;  ///< It is a patch of several facets.
  unsigned char isOpen = 0;     ///< A facet off the CAD is beside it, or nothing.
  unsigned char isAtBorder = 0; ///< A CAD edge that bounds one face alone is beside it.
  /// A CAD edge between two faces is beside it, or a facet from which it turns by less than 60
  /// degrees.
  unsigned char isTied = 0;
  std::int32_t face = none; ///< That of the patch, as they tell; -1: they tell different ones.

  bool isOnCAD() const { return !isOpen && (!isSeveral || (isTied && !isAtBorder)); }

  void add(std::int32_t other)
  {
    face = face == none || face == other ? other : other == none ? face : -1;
  }
  void add(const Surroundings& other)
  {
    isSeveral = isSeveral || other.isSeveral;
    isOpen = isOpen || other.isOpen;
    isAtBorder = isAtBorder || other.isAtBorder;
    isTied = isTied || other.isTied;
    add(other.face);
  }

  friend bool operator==(const Surroundings& a, const Surroundings& b)
  {
    return a.isSeveral == b.isSeveral && a.isOpen == b.isOpen && a.isAtBorder == b.isAtBorder &&
           a.isTied == b.isTied && a.face == b.face;
  }
};

/// The face of the neighbour from which the surface turns least, for an ear, or that of all
/// neighbours; -1: they are not on one face.
std::int32_t faceOfNeighbours(const FacetRecord& facet, const std::vector<FacetRecord>& neighbours)
{
  const auto turnsLess = [&](const FacetRecord& a, const FacetRecord& b)
  {
    const double ofA = dot(a.normal, facet.normal);
    const double ofB = dot(b.normal, facet.normal);
    return ofA > ofB || (ofA == ofB && a.face < b.face);
  };
  const auto nearest = std::min_element(neighbours.begin(), neighbours.end(), turnsLess);
  const bool isDecided =
    facet.ear >= 0 || std::all_of(neighbours.begin(), neighbours.end(),
                        [&](const FacetRecord& other) { return other.face == nearest->face; });
  return isDecided ? nearest->face : -1;
}

/// What a facet beside one of a patch tells, given the CAD edges that both ends of the mesh edge
/// between them lie on.
Surroundings seenFrom(const FacetRecord& facet, const FacetRecord& other, const NurbsModel& model,
  const std::vector<std::int32_t>& edgesOfEnds)
{
  Surroundings seen;
  if (!other.onCAD)
  {
    seen.isOpen = 1;
    return seen;
  }
  const auto between = std::find_if(edgesOfEnds.begin(), edgesOfEnds.end(),
    [&](std::int32_t edge)
    {
      const auto& faces = model.edges[edge].faces;
      return std::binary_search(faces.begin(), faces.end(), other.face) &&
             !isSeam(model.edges[edge]);
    });
  if (between == edgesOfEnds.end())
  {
    seen.isTied = fitsEitherWay(other.normal, facet.normal);
    seen.face = other.face;
    return seen;
  }
  const auto& faces = model.edges[*between].faces;
  seen.isTied = 1;
  seen.isAtBorder = faces.size() == 1;
  seen.face = faces.size() == 2 ? faces[0] + faces[1] - other.face : -1;
  return seen;
}

/// For each odd facet what is round its patch. Collective.
std::vector<Surroundings> findSurroundings(RankExchange& exchange,
  const DistributedBoundary& boundary, const std::vector<EntityId>& entities,
  const NurbsModel& model, const std::vector<FacetRecord>& records,
  const std::vector<std::vector<FacetRecord>>& ofEdges, const std::vector<Index>& odd)
{
  std::vector<Surroundings> ofPatches(odd.size());
  const auto forEdges = [&](const auto& use)
  {
    for (std::size_t i = 0; i < odd.size(); ++i)
    {
      for (int k = 0; k < boundary.facets[odd[i]].edges(); ++k)
      {
        use(boundary.facetEdges[odd[i]][k], odd[i], ofPatches[i]);
      }
    }
  };
  forEdges(
    [&](Index edge, Index facet, Surroundings& patch)
    {
      const auto [a, b] = boundary.edges.edges()[edge];
      const auto onBoth = commonEntities(model, entities[a], entities[b], 1);
      int count = 0;
      for (const FacetRecord& other : ofEdges[edge])
      {
        count += other.odd;
        if (!other.odd)
        {
          patch.add(seenFrom(records[facet], other, model, onBoth));
        }
      }
      patch.isSeveral = patch.isSeveral || count > 1;
      patch.isOpen = patch.isOpen || ofEdges[edge].size() == 1;
    });
  bool changes = true;
  while (exchange.any(changes))
  {
    std::vector<Surroundings> atEdges(ofEdges.size());
    forEdges([&](Index edge, Index, const Surroundings& patch) { atEdges[edge].add(patch); });
    combineShared(exchange, boundary.sharedEdges, atEdges,
      [](Surroundings a, const Surroundings& b)
      {
        a.add(b);
        return a;
      });
    const auto before = ofPatches;
    forEdges([&](Index edge, Index, Surroundings& patch) { patch.add(atEdges[edge]); });
    changes = ofPatches != before;
  }
  return ofPatches;
}

} // namespace

bool joinOddFacets(RankExchange& exchange, const Mesh& mesh, const DistributedBoundary& boundary,
  const std::vector<EntityId>& entities, const CADModel& model,
  const std::vector<std::vector<FacetRecord>>& ofEdges, std::vector<FacetRecord>& records)
{
  const auto odd = indicesWhere(records.size(), [&](std::size_t f) { return records[f].odd; });
  if (!exchange.any(!odd.empty()))
  {
    return false;
  }
  const auto ofPatches =
    findSurroundings(exchange, boundary, entities, model.nurbs(), records, ofEdges, odd);
  for (std::size_t i = 0; i < odd.size(); ++i)
  {
    FacetRecord& record = records[odd[i]];
    const ClassifiedFacet facet = classifiedFacet(mesh, entities, boundary.facets[odd[i]]);
    std::vector<FacetRecord> neighbours;
    for (int k = 0; k < boundary.facets[odd[i]].edges(); ++k)
    {
      const auto onCAD = facetsOnCAD(ofEdges[boundary.facetEdges[odd[i]][k]]);
      neighbours.insert(neighbours.end(), onCAD.begin(), onCAD.end());
    }
    const auto faces = commonFaces(model.nurbs(), facet.entities, facet.corners);
    const auto isCommon = [&](std::int32_t face)
    { return std::binary_search(faces.begin(), faces.end(), face); };
    const Surroundings& patch = ofPatches[i];
    std::int32_t face = patch.face;
    if (!isCommon(face) && !neighbours.empty())
    {
      face = faceOfNeighbours(record, neighbours);
    }
    face = isCommon(face) ? face : -1;
    record.onCAD = patch.isOnCAD() || (record.ear >= 0 && face >= 0);
    record.face = record.onCAD ? face : -1;
  }
  return true;
}

} // namespace cadrefine
