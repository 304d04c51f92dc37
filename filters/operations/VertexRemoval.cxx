#include "operations/VertexRemoval.h"

#include "classification/EdgeMidpoints.h"

#include <cadrefine/base/VertexBuckets.h>
#include <cadrefine/operations/EditableMesh.h>

#include <algorithm>
#include <utility>

namespace cadrefine
{
namespace
{

using Freedom = EditableMesh::Freedom;

/// How an edge lies in the boundary.
enum class EdgePlace : unsigned char
{
  Inside,
  OnFace,  ///< On a CAD face.
  OnEdge,  ///< On a CAD edge.
  OnWall,  ///< In flat boundary that is not on the CAD.
  OnCrease ///< A crease of boundary that is not on the CAD.
};

class VertexRemoval
{
public:
  VertexRemoval(RankExchange& exchange, const DistributedMesh& mesh,
    const Classification& classification, const ClassifiedBoundary& boundary,
    const std::vector<unsigned char>& mayGo)
    : exchange_(exchange), mesh_(mesh), classification_(classification), boundary_(boundary),
      edges_(findEdges(exchange, mesh, 0)), places_(placesOfEdges()),
      freedoms_(freedomsOfVertices(mayGo)), before_(neighboursBefore())
  {
  }

  std::vector<unsigned char> run()
  {
    std::vector<Index> open = candidates();
    const std::vector<unsigned char> isShared = sharedVertices();
    states_.assign(freedoms_.size(), Remains);
    for (const Index vertex : open)
    {
      states_[vertex] = Open;
    }
    while (exchange_.any(!open.empty()))
    {
      std::vector<unsigned char> seen(states_.size(), 0);
      for (const Index vertex : open)
      {
        seen[vertex] = look(vertex);
        if (!isShared[vertex])
        {
          decide(vertex, seen[vertex]);
        }
      }
      combineShared(exchange_, mesh_.shared, seen,
        [](unsigned char a, unsigned char b) { return static_cast<unsigned char>(a | b); });
      open.erase(std::remove_if(open.begin(), open.end(),
                   [&](Index vertex)
                   {
                     if (states_[vertex] == Open)
                     {
                       decide(vertex, seen[vertex]);
                     }
                     return states_[vertex] != Open;
                   }),
        open.end());
    }
    std::vector<unsigned char> flags(states_.size());
    std::transform(states_.begin(), states_.end(), flags.begin(),
      [](State state) { return static_cast<unsigned char>(state == Goes); });
    return flags;
  }

private:
  enum State : unsigned char
  {
    Remains,
    Goes,
    Open
  };
  static constexpr unsigned char remainingNeighbour = 1;
  static constexpr unsigned char openNeighbour = 2;

  /// How each edge of the piece lies in the boundary of the whole mesh. Collective.
  std::vector<EdgePlace> placesOfEdges()
  {
    const DistributedBoundary& boundary = boundary_.boundary;
    const auto ofFacets = gatherFacetRecords(exchange_, boundary, boundary_.classes.facets);
    std::vector<EdgePlace> places(edges_.table.edges.size(), EdgePlace::Inside);
    for (std::size_t e = 0; e < ofFacets.size(); ++e)
    {
      const auto [a, b] = boundary.edges.edges()[e];
      places[edges_.table.find(a, b)] = placeOf(boundary_.classes.ofEdges[e], ofFacets[e]);
    }
    combineLargest(exchange_, edges_.sharedEdges, places);
    return places;
  }

  static EdgePlace placeOf(const EdgeClass& edgeClass, const std::vector<FacetRecord>& facets)
  {
    if (edgeClass.kind != EdgeClass::Straight)
    {
      return edgeClass.kind == EdgeClass::OnEdge ? EdgePlace::OnEdge : EdgePlace::OnFace;
    }
    constexpr double parallel = 1 - 1e-12; // cosine, but for rounding
    const bool isFlat = std::all_of(facets.begin(), facets.end(),
      [&](const FacetRecord& facet)
      { return !facet.onCAD && dot(facet.normal, facets.front().normal) >= parallel; });
    return isFlat ? EdgePlace::OnWall : EdgePlace::OnCrease;
  }

  /// How freely each vertex may go; not at all without its flag in `mayGo`. Collective.
  std::vector<Freedom> freedomsOfVertices(const std::vector<unsigned char>& mayGo)
  {
    std::vector<unsigned char> has(mayGo.size(), 0); // a bit for each place of an edge at a vertex
    const auto bit = [](EdgePlace place)
    { return static_cast<unsigned char>(1U << static_cast<unsigned>(place)); };
    for (std::size_t e = 0; e < places_.size(); ++e)
    {
      for (const Index end : edges_.table.edges[e])
      {
        has[end] |= bit(places_[e]);
      }
    }
    combineShared(exchange_, mesh_.shared, has,
      [](unsigned char a, unsigned char b) { return static_cast<unsigned char>(a | b); });
    std::vector<Freedom> freedoms(mayGo.size(), Freedom::None);
    for (std::size_t v = 0; v < mayGo.size(); ++v)
    {
      const EntityId entity = classification_.entities[v];
      const auto isAt = [&](EdgePlace place) { return (has[v] & bit(place)) != 0; };
      if (!mayGo[v] || entity.dimension == 0)
      {
        continue;
      }
      if (!boundary_.boundary.onBoundary[v])
      {
        freedoms[v] = Freedom::Space;
      }
      else if (entity ? isAt(EdgePlace::OnEdge) : isAt(EdgePlace::OnCrease))
      {
        freedoms[v] = Freedom::Segment;
      }
      else if (!entity || !(isAt(EdgePlace::OnWall) || isAt(EdgePlace::OnCrease)))
      {
        freedoms[v] = Freedom::Facet;
      }
    }
    return freedoms;
  }

  bool mayGoAlong(Index vertex, EdgePlace place) const
  {
    switch (freedoms_[vertex])
    {
      case Freedom::Space:
        return true;
      case Freedom::Facet:
        return place != EdgePlace::Inside;
      case Freedom::Segment:
        return place ==
               (classification_.entities[vertex] ? EdgePlace::OnEdge : EdgePlace::OnCrease);
      default:
        return false;
    }
  }

  /// Whether the vertex is decided on before another one.
  bool comesBefore(Index a, Index b) const
  {
    return freedoms_[a] != freedoms_[b] ? freedoms_[a] < freedoms_[b]
                                        : mesh_.mesh().ids[a] < mesh_.mesh().ids[b];
  }

  /// For each vertex those that it may be collapsed into, and that are decided on before it.
  VertexBuckets<Index> neighboursBefore() const
  {
    return { freedoms_.size(), [&](const auto& use)
      {
        for (std::size_t e = 0; e < places_.size(); ++e)
        {
          auto [a, b] = edges_.table.edges[e];
          if (comesBefore(b, a))
          {
            std::swap(a, b);
          }
          if (mayGoAlong(b, places_[e]))
          {
            use(b, a);
          }
        }
      } };
  }

  /// The vertices that may go, in the order in which they are decided on.
  std::vector<Index> candidates() const
  {
    std::vector<Index> vertices;
    for (std::size_t v = 0; v < freedoms_.size(); ++v)
    {
      if (freedoms_[v] != Freedom::None)
      {
        vertices.push_back(static_cast<Index>(v));
      }
    }
    std::sort(
      vertices.begin(), vertices.end(), [&](Index a, Index b) { return comesBefore(a, b); });
    return vertices;
  }

  std::vector<unsigned char> sharedVertices() const
  {
    std::vector<unsigned char> isShared(freedoms_.size(), 0);
    for (const Index vertex : mesh_.shared.all)
    {
      isShared[vertex] = 1;
    }
    return isShared;
  }

  /// Whether a vertex has neighbours on this rank that remain, and that are still open.
  unsigned char look(Index vertex) const
  {
    unsigned char seen = 0;
    const auto [first, last] = before_.at(vertex);
    std::for_each(first, last,
      [&](Index neighbour)
      {
        seen |= states_[neighbour] == Remains ? remainingNeighbour : 0;
        seen |= states_[neighbour] == Open ? openNeighbour : 0;
      });
    return seen;
  }

  void decide(Index vertex, unsigned char seen)
  {
    if ((seen & remainingNeighbour) != 0)
    {
      states_[vertex] = Goes;
    }
    else if (seen == 0)
    {
      states_[vertex] = Remains;
    }
  }

  RankExchange& exchange_;
  const DistributedMesh& mesh_;
  const Classification& classification_;
  const ClassifiedBoundary& boundary_;
  const MarkedEdges edges_;
  const std::vector<EdgePlace> places_;
  const std::vector<Freedom> freedoms_;
  const VertexBuckets<Index> before_;
  std::vector<State> states_;
};

} // namespace

std::vector<unsigned char> verticesToRemove(RankExchange& exchange, const DistributedMesh& mesh,
  const Classification& classification, const ClassifiedBoundary& boundary,
  const std::vector<unsigned char>& mayGo)
{
  return VertexRemoval(exchange, mesh, classification, boundary, mayGo).run();
}

} // namespace cadrefine
