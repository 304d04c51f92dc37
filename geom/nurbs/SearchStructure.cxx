#include <cadrefine/nurbs/SearchStructure.h>

#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/nurbs/LeafBuilder.h>
#include <cadrefine/nurbs/ModelCheck.h>
#include <cadrefine/nurbs/PolynomialFit.h>
#include <cadrefine/nurbs/TrimMeasure.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace cadrefine
{
namespace
{

constexpr int mostLeavesOfModel = 400000;
constexpr int fewestLeavesOfPatch = 64;
/// Points nearer to each other than this part of the model's size are one.
constexpr double sameTolerance = 1e-12;
/// Trim curves that lie off their edge by no more than this part of the model's size are covered by
/// it.
constexpr double coverTolerance = 2e-10;
/// How far curves along borders may lie off them, in terms of the model's size.
constexpr double borderTolerance = 5e-11;

/// The size of the edges and vertices, which span a trimmed model; of the patches, where there are
/// none.
double roughSize(const NurbsModel& model)
{
  BoundingBox box;
  const auto includeAll = [&box](const std::vector<ControlPoint>& points)
  {
    for (const ControlPoint& p : points)
    {
      box.include(toPoint(p));
    }
  };
  for (const NurbsEdge& edge : model.edges)
  {
    for (const BezierCurve& segment : edge.segments)
    {
      includeAll(segment.points);
    }
  }
  if (box.isEmpty() || box.diagonal() == 0)
  {
    for (const NurbsFace& face : model.faces)
    {
      for (const BezierPatch& patch : face.patches)
      {
        includeAll(patch.points);
      }
    }
  }
  return box.diagonal();
}

/// The parameters at which a trim curve passes from one patch of the face to the next.
std::vector<double> findCuts(const NurbsFace& face, const BezierCurve2& curve)
{
  std::vector<double> cuts, u, v;
  for (int i = 1; i < face.patchesU; ++i)
  {
    u.push_back(face.patches[i * face.patchesV].u0);
  }
  for (int j = 1; j < face.patchesV; ++j)
  {
    v.push_back(face.patches[j].v0);
  }
  fit::addCrossings([&](double t) { return evaluate(curve, t)[0]; }, u, cuts);
  fit::addCrossings([&](double t) { return evaluate(curve, t)[1]; }, v, cuts);
  return cuts;
}

/// Fills a SearchStructure, entity by entity.
class StructureBuilder
{
public:
  explicit StructureBuilder(SearchStructure& structure)
    : structure_(structure), model_(structure.model), roughSize_(roughSize(structure.model))
  {
  }

  void build()
  {
    chooseLimits();
    findCovers();
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

  TrimSupport supportOf(const NurbsFace& face, const BezierCurve2& curve) const
  {
    return std::isfinite(curve.deviation) ? TrimSupport{ curve.edge, curve.deviation }
                                          : trimSupport(model_, face, curve);
  }

  bool isCovered(const TrimSupport& support) const
  {
    return support.deviation <= coverTolerance * roughSize_;
  }

  /// Finds for each edge the first face whose border it covers all along.
  void findCovers()
  {
    coveredFace_.assign(model_.edges.size(), -1);
    for (int i = model_.count(2) - 1; i >= 0; --i)
    {
      std::set<std::int32_t> covered, uncovered;
      for (const TrimLoop& loop : model_.faces[i].loops)
      {
        for (const BezierCurve2& curve : loop)
        {
          const TrimSupport support = supportOf(model_.faces[i], curve);
          (isCovered(support) ? covered : uncovered).insert(support.edge);
        }
      }
      for (const std::int32_t edge : covered)
      {
        if (edge >= 0 && uncovered.count(edge) == 0)
        {
          coveredFace_[edge] = i;
        }
      }
    }
  }

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
    structure_.entities[leaf.entity].stray = firstFaceAt(model_, { 0, index }) < 0;
    BoundingBox box;
    box.include(point);
    addLeaf(leaf, box);
  }

  void addEdge(int index)
  {
    const NurbsEdge& edge = model_.edges[index];
    const int entity = addEntity({ 1, index });
    structure_.entities[entity].sharp = edge.sharp;
    structure_.entities[entity].stray = edge.faces.empty();
    structure_.entities[entity].face = coveredFace_[index];
    startGrid(entity, static_cast<int>(edge.segments.size()), 1);
    for (const BezierCurve& segment : edge.segments)
    {
      addPatch(
        { viewOf(segment), { segment.t0, segment.t1, 0.0, 0.0 }, entity, {}, nullptr }, nullptr);
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
                 { row > 0, row + 1 < face.patchesU, column > 0, column + 1 < columns }, nullptr },
        structure_.entities[entity].trim.get());
    }
    for (const TrimLoop& loop : face.loops)
    {
      for (const BezierCurve2& curve : loop)
      {
        if (!isCovered(supportOf(face, curve)))
        {
          addBorder(face, curve, entity);
        }
      }
    }
  }

  /// Adds curves in space that follow a trim curve.
  void addBorder(const NurbsFace& face, const BezierCurve2& curve, int entity)
  {
    const double tolerance = borderTolerance * roughSize_;
    const auto pieces = fit::pieces<3>([&](double t) { return pointOnFace(face, curve, t); },
      findCuts(face, curve), Point3{ tolerance, tolerance, tolerance });
    for (const auto& piece : pieces)
    {
      std::vector<ControlPoint>& points = structure_.borders.emplace_back();
      for (const Point3& p : piece.coefficients)
      {
        points.push_back({ p[0], p[1], p[2], 1 });
      }
      addPatch(
        { { points.data(), fit::degree, 0 }, { piece.from, piece.to, 0, 0 }, entity, {}, &curve },
        nullptr);
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

  /// Builds a tree for each entity, whose leaves are consecutive, and one over all of them.
  void buildTrees()
  {
    BoundingBox box;
    for (const BoundingBoxTree::Entry& entry : entries_)
    {
      box.include(entry.box);
    }
    structure_.centre = box.isEmpty() ? Point3{} : box.middle();
    structure_.size = box.diagonal();
    structure_.tree = BoundingBoxTree(structure_.centre, structure_.size);
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

  /// The tree's entries for the leaves of one entity, which are consecutive.
  Entries entriesOf(int entity) const
  {
    const auto isBefore = [&](const BoundingBoxTree::Entry& e, int number)
    { return structure_.leaves[e.item].entity < number; };
    const auto begin = entries_.begin();
    return { std::lower_bound(begin, entries_.end(), entity, isBefore),
      std::lower_bound(begin, entries_.end(), entity + 1, isBefore) };
  }

  /// The tree's entries for the leaves of a face's edges and their vertices.
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
    sortUniquely(numbers);
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
  double roughSize_ = 0;
  std::vector<int> coveredFace_; ///< The face that each edge covers, see findCovers.
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

std::array<double, 2> SearchStructure::onGrid(
  int entity, const std::array<double, 2>& parameters) const
{
  const SearchEntity& e = entities[entity];
  const ParameterRectangle& first = patches[e.firstPatch].range;
  const ParameterRectangle& last = patches[e.firstPatch + e.rows * e.columns - 1].range;
  return { std::clamp(parameters[0], first.s0, last.s1),
    std::clamp(parameters[1], first.t0, last.t1) };
}

SearchStructure::SearchStructure(const NurbsModel& nurbsModel) : model(nurbsModel)
{
  checkModel(model);
  StructureBuilder(*this).build();
}

} // namespace cadrefine
