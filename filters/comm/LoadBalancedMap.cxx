#include "comm/LoadBalancedMap.h"

#include <algorithm>
#include <numeric>

namespace cadrefine
{
namespace
{

/// How many of `total` queries rank r of `ranks` answers: the first ranks take what is left over.
std::int64_t quotaOf(std::int64_t total, int ranks, int r)
{
  return total / ranks + (r < total % ranks ? 1 : 0);
}

double largestOverMean(const std::vector<std::int64_t>& counts, std::int64_t total)
{
  const auto largest = static_cast<double>(*std::max_element(counts.begin(), counts.end()));
  return total > 0 ? largest * static_cast<double>(counts.size()) / static_cast<double>(total)
                   : 1.0;
}

/// A run of queries that goes from a rank that has too many to one that has too few.
struct Transfer
{
  int from = 0;
  int to = 0;
  std::size_t count = 0;
};

/// All transfers: surplus and need are matched in the order of the ranks.
std::vector<Transfer> matchTransfers(
  const std::vector<std::int64_t>& counts, const std::vector<std::int64_t>& quotas)
{
  std::vector<Transfer> transfers;
  const int ranks = static_cast<int>(counts.size());
  std::vector<std::int64_t> needs(counts.size());
  std::transform(counts.begin(), counts.end(), quotas.begin(), needs.begin(),
    [](std::int64_t count, std::int64_t quota)
    { return std::max<std::int64_t>(0, quota - count); });
  int to = 0;
  for (int from = 0; from < ranks; ++from)
  {
    std::int64_t surplus = counts[from] - quotas[from];
    while (surplus > 0)
    {
      while (needs[to] == 0)
      {
        ++to;
      }
      const std::int64_t count = std::min(surplus, needs[to]);
      transfers.push_back({ from, to, static_cast<std::size_t>(count) });
      surplus -= count;
      needs[to] -= count;
    }
  }
  return transfers;
}

} // namespace

void recordBalance(RunStatistics& statistics, const std::string& work, const WorkBalance& balance)
{
  statistics.set(work + " imbalance before", balance.before);
  statistics.set(work + " imbalance after", balance.after);
}

double findImbalance(RankExchange& exchange, std::int64_t share)
{
  const std::vector<std::int64_t> shares = exchange.gather(share);
  return largestOverMean(shares, std::accumulate(shares.begin(), shares.end(), std::int64_t{ 0 }));
}

WorkPlan planLoadBalance(RankExchange& exchange, std::size_t queries)
{
  const std::vector<std::int64_t> counts = exchange.gather(static_cast<std::int64_t>(queries));
  const std::int64_t total = std::accumulate(counts.begin(), counts.end(), std::int64_t{ 0 });
  std::vector<std::int64_t> quotas(counts.size());
  for (int r = 0; r < exchange.size(); ++r)
  {
    quotas[r] = quotaOf(total, exchange.size(), r);
  }

  WorkPlan plan;
  plan.balance = { total, largestOverMean(counts, total), largestOverMean(quotas, total) };
  plan.kept = static_cast<std::size_t>(std::min(counts[exchange.rank()], quotas[exchange.rank()]));
  for (const auto& [from, to, count] : matchTransfers(counts, quotas))
  {
    const bool isMine = from == exchange.rank();
    if (isMine || to == exchange.rank())
    {
      plan.ranks.push_back(isMine ? to : from);
      plan.sent.push_back(isMine ? count : 0);
      plan.received.push_back(isMine ? 0 : count);
    }
  }
  return plan;
}

} // namespace cadrefine
