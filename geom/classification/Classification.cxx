#include <cadrefine/classification/Classification.h>

#include <limits>

namespace cadrefine
{
namespace
{

constexpr double noParameter = std::numeric_limits<double>::quiet_NaN();

} // namespace

void Classification::resize(std::size_t count)
{
  entities.resize(count);
  parameters.resize(count, { noParameter, noParameter });
  distances.resize(count, 0.0);
}

void Classification::set(Index vertex, const ClosestPoint& where)
{
  entities[vertex] = where.entity;
  parameters[vertex] = where.parameters;
}

} // namespace cadrefine
