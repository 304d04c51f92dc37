#include "balancing/WeightedPartition.h"

#include "comm/RankExchangeLink.h"

#include <zoltan_cpp.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

/// A point is known by its rank and its place there.
constexpr int idEntries = 2;

struct WeightedPoints
{
  const std::vector<Point3>& points;
  const std::vector<std::int64_t>& weights;
  int rank;
};

int countPoints(void* data, int* status)
{
  *status = ZOLTAN_OK;
  return static_cast<int>(static_cast<const WeightedPoints*>(data)->points.size());
}

// The parameters are those that Zoltan calls with, here and below.
void listPoints( // NOLINT(readability-function-size)
  void* data, int, int, ZOLTAN_ID_PTR ids, ZOLTAN_ID_PTR places, int, float* weights, int* status)
{
  const auto& all = *static_cast<const WeightedPoints*>(data);
  for (std::size_t i = 0; i < all.points.size(); ++i)
  {
    ids[idEntries * i] = static_cast<ZOLTAN_ID_TYPE>(all.rank);
    ids[idEntries * i + 1] = static_cast<ZOLTAN_ID_TYPE>(i);
    places[i] = static_cast<ZOLTAN_ID_TYPE>(i);
    weights[i] = static_cast<float>(all.weights[i]);
  }
  *status = ZOLTAN_OK;
}

int countCoordinates(void*, int* status)
{
  *status = ZOLTAN_OK;
  return 3;
}

void listCoordinates( // NOLINT(readability-function-size)
  void* data, int, int, int count, ZOLTAN_ID_PTR, ZOLTAN_ID_PTR places, int, double* coordinates,
  int* status)
{
  const auto& points = static_cast<const WeightedPoints*>(data)->points;
  for (int i = 0; i < count; ++i)
  {
    std::copy_n(points[places[i]].begin(), 3, coordinates + 3 * i);
  }
  *status = ZOLTAN_OK;
}

void setUp(Zoltan& zoltan, WeightedPoints& points)
{
  zoltan.Set_Param("DEBUG_LEVEL", "0");
  zoltan.Set_Param("LB_METHOD", "RCB");
  zoltan.Set_Param("IMBALANCE_TOL", "1.02");
  zoltan.Set_Param("NUM_GID_ENTRIES", std::to_string(idEntries));
  zoltan.Set_Param("OBJ_WEIGHT_DIM", "1");
  // The points that move. (A list of all fails on ranks without points where none moves.)
  zoltan.Set_Param("RETURN_LISTS", "EXPORT");
  zoltan.Set_Num_Obj_Fn(countPoints, &points);
  zoltan.Set_Obj_List_Fn(listPoints, &points);
  zoltan.Set_Num_Geom_Fn(countCoordinates, nullptr);
  zoltan.Set_Geom_Multi_Fn(listCoordinates, &points);
}

/// Runs Zoltan, and sets the rank of each point that moves.
bool runZoltan(Zoltan& zoltan, std::vector<int>& ranks)
{
  int changed = 0;
  int entries = 0;
  int localEntries = 0;
  int imports = 0;
  int exports = 0;
  ZOLTAN_ID_PTR importIds = nullptr;
  ZOLTAN_ID_PTR importPlaces = nullptr;
  int* importRanks = nullptr;
  int* importParts = nullptr;
  ZOLTAN_ID_PTR exportIds = nullptr;
  ZOLTAN_ID_PTR exportPlaces = nullptr;
  int* exportRanks = nullptr;
  int* exportParts = nullptr;
  const int status =
    zoltan.LB_Partition(changed, entries, localEntries, imports, importIds, importPlaces,
      importRanks, importParts, exports, exportIds, exportPlaces, exportRanks, exportParts);
  const bool done = status == ZOLTAN_OK || status == ZOLTAN_WARN;
  for (int i = 0; done && i < exports; ++i)
  {
    ranks[exportPlaces[i]] = exportRanks[i];
  }
  Zoltan::LB_Free_Part(&importIds, &importPlaces, &importRanks, &importParts);
  Zoltan::LB_Free_Part(&exportIds, &exportPlaces, &exportRanks, &exportParts);
  return done;
}

} // namespace

std::vector<int> partitionByWeight(RankExchange& exchange, const std::vector<Point3>& points,
  const std::vector<std::int64_t>& weights)
{
  std::vector<int> ranks(points.size(), exchange.rank());
  if (exchange.size() == 1 || !exchange.any(!points.empty()))
  {
    return ranks;
  }
  float version = 0;
  Zoltan_Initialize(0, nullptr, &version);
  WeightedPoints weighted{ points, weights, exchange.rank() };
  Zoltan zoltan(exchange.link()->ranks);
  setUp(zoltan, weighted);
  const bool done = runZoltan(zoltan, ranks);
  exchange.agree(done ? "" : "Zoltan failed to partition the mesh");
  return ranks;
}

} // namespace cadrefine
