#include "SearchStructure.h"

#include "LeafBuilder.h"
#include "ModelCheck.h"

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

constexpr int mostLeavesOfModel = 400000;
constexpr int fewestLeavesOfPatch = 64;
/// Of the model's size: points nearer to each other than this are one.
constexpr double sameTolerance = 1e-12;

/// Fills a SearchStructure, entity by entity.
class StructureBuilder
{
public:
  explicit StructureBuilder(SearchStructure& structure)
    : structure_(structure), model_(structure.model)
  {
  }

  void build()
  {
    chooseLimits();
    structure_.firstEntity = { 0, model_.count(0), model_.count(0) + model_.count(1) };
    for (int i = 0; i < model_.count(0); ++i)
    {
      addVertex(i);
    }
    for (int i = 0; i < model_.count(1); ++i)
    {
      addEdge(i);
    }
    for (int i = 0; i < model_.count(2); ++i)
    {
      addFace(i);
    }
    buildTrees();
    findSeams();
  }

private:
  using Entries = std::vector<BoundingBoxTree::Entry>;

  void chooseLimits()
  {
    BoundingBox box;
    std::size_t patches = 1;
    const auto includeAll = [&box](const std::vector<ControlPoint>& points)
    {
      for (const ControlPoint& p : points)
      {
        box.include(toPoint(p));
      }
    };
    for (const NurbsEdge& edge : model_.edges)
    {
      for (const BezierCurve& segment : edge.segments)
      {
        includeAll(segment.points);
      }
    }
    for (const NurbsFace& face : model_.faces)
    {
      patches += face.patches.size();
      for (const BezierPatch& patch : face.patches)
      {
        includeAll(patch.points);
      }
    }
    limits_.smallestRadius = 3e-4 * box.diagonal();
    limits_.largestRadius = 0.02 * box.diagonal(); // measured: smaller ones no longer pay
    limits_.mostLeaves =
      std::max(fewestLeavesOfPatch, mostLeavesOfModel / static_cast<int>(patches));
  }

  void addVertex(int index)
  {
    const Point3& point = model_.vertices[index].point;
    SearchLeaf leaf;
    leaf.entity = addEntity({ 0, index });
    BoundingBox box;
    box.include(point);
    addLeaf(leaf, box);
  }

  void addEdge(int index)
  {
    const NurbsEdge& edge = model_.edges[index];
    const int entity = addEntity({ 1, index });
    structure_.entities[entity].sharp = edge.sharp;
    structure_.entities[entity].face = edge.faces.empty() ? -1 : edge.faces.front();
    startGrid(entity, static_cast<int>(edge.segments.size()), 1);
    for (const BezierCurve& segment : edge.segments)
    {
      addPatch({ viewOf(segment), { segment.t0, segment.t1, 0.0, 0.0 }, entity, {} }, nullptr);
    }
  }

  void addFace(int index)
  {
    const NurbsFace& face = model_.faces[index];
    const int entity = addEntity({ 2, index });
    if (!face.loops.empty())
    {
      structure_.entities[entity].trim = std::make_unique<TrimRegion>(face.loops);
    }
    const int columns = std::max(face.patchesV, 1);
    startGrid(entity, static_cast<int>(face.patches.size()) / columns, columns);
    for (std::size_t i = 0; i < face.patches.size(); ++i)
    {
      const BezierPatch& patch = face.patches[i];
      const int row = static_cast<int>(i) / columns;
      const int column = static_cast<int>(i) % columns;
      addPatch({ viewOf(patch), { patch.u0, patch.u1, patch.v0, patch.v1 }, entity,
                 { row > 0, row + 1 < face.patchesU, column > 0, column + 1 < columns } },
        structure_.entities[entity].trim.get());
    }
  }

  int addEntity(EntityId id)
  {
    structure_.entities.emplace_back();
    structure_.entities.back().id = id;
    return static_cast<int>(structure_.entities.size()) - 1;
  }

  void startGrid(int entity, int rows, int columns)
  {
    structure_.entities[entity].firstPatch = static_cast<int>(structure_.patches.size());
    structure_.entities[entity].rows = rows;
    structure_.entities[entity].columns = columns;
  }

  void addLeaf(const SearchLeaf& leaf, const BoundingBox& box)
  {
    entries_.push_back({ box, static_cast<int>(structure_.leaves.size()) });
    structure_.leaves.push_back(leaf);
  }

  /// Adds the leaves of one patch of the last entity.
  void addPatch(const SearchPatch& patch, const TrimRegion* trim)
  {
    structure_.patches.push_back(patch);
    for (BuiltLeaf& built : buildLeaves(patch, trim, limits_))
    {
      built.leaf.patch = static_cast<int>(structure_.patches.size()) - 1;
      built.leaf.entity = patch.entity;
      addLeaf(built.leaf, built.box);
    }
  }

  /// One tree for each entity, whose leaves are consecutive, and one over all of them.
  void buildTrees()
  {
    BoundingBox box;
    for (const BoundingBoxTree::Entry& entry : entries_)
    {
      box.include(entry.box);
    }
    structure_.size = box.diagonal();
    structure_.tree = BoundingBoxTree(box.isEmpty() ? Point3{} : box.middle(), structure_.size);
    for (SearchEntity& entity : structure_.entities)
    {
      Entries own = entriesOf(structure_.entityNumber(entity.id));
      entity.root = structure_.tree.build(own);
    }
    for (int i = 0; i < model_.count(2); ++i)
    {
      SearchEntity& face = structure_.entities[structure_.entityNumber({ 2, i })];
      Entries border = borderOf(model_.faces[i]);
      face.closure = structure_.tree.join(structure_.tree.build(border), face.root);
    }
    structure_.root = structure_.tree.build(entries_);
  }

  void findSeams()
  {
    for (SearchEntity& entity : structure_.entities)
    {
      if (entity.rows > 0)
      {
        entity.seams = Seams(&structure_.patches[entity.firstPatch], entity.rows, entity.columns,
          sameTolerance * structure_.size);
      }
    }
  }

  /// Of the leaves of one entity, which are consecutive.
  Entries entriesOf(int entity) const
  {
    const auto isBefore = [&](const BoundingBoxTree::Entry& e, int number)
    { return structure_.leaves[e.item].entity < number; };
    const auto begin = entries_.begin();
    return { std::lower_bound(begin, entries_.end(), entity, isBefore),
      std::lower_bound(begin, entries_.end(), entity + 1, isBefore) };
  }

  /// Of the leaves of a face's edges and their vertices.
  Entries borderOf(const NurbsFace& face) const
  {
    std::vector<int> numbers;
    for (const std::int32_t index : face.edges)
    {
      const NurbsEdge& edge = model_.edges[index];
      numbers.push_back(structure_.entityNumber({ 1, index }));
      for (const std::int32_t vertex : { edge.firstVertex, edge.lastVertex })
      {
        if (vertex >= 0)
        {
          numbers.push_back(structure_.entityNumber({ 0, vertex }));
        }
      }
    }
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    Entries border;
    for (const int number : numbers)
    {
      const Entries own = entriesOf(number);
      border.insert(border.end(), own.begin(), own.end());
    }
    return border;
  }

  SearchStructure& structure_;
  const NurbsModel& model_;
  LeafLimits limits_;
  Entries entries_;
};

} // namespace

const SearchPatch& SearchStructure::patchAt(
  int entity, const std::array<double, 2>& parameters) const
{
  const SearchEntity& e = entities[entity];
  const SearchPatch* grid = &patches[e.firstPatch];
  int row = 0;
  int column = 0;
  while (row + 1 < e.rows && parameters[0] > grid[row * e.columns].range.s1)
  {
    ++row;
  }
  while (column + 1 < e.columns && parameters[1] > grid[column].range.t1)
  {
    ++column;
  }
  return grid[row * e.columns + column];
}

SearchStructure::SearchStructure(const NurbsModel& nurbsModel) : model(nurbsModel)
{
  checkModel(model);
  StructureBuilder(*this).build();
}

} // namespace cadrefine
