// Work that any rank can do, shared out evenly.
#pragma once

#include "comm/CollectiveErrors.h"
#include "comm/RankExchange.h"
#include "comm/RunStatistics.h"
#include "comm/Threads.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace cadrefine
{

/// How evenly queries lie on the ranks.
struct WorkBalance
{
  std::int64_t total = 0;
  double before = 1; ///< Largest over mean of the queries that ranks have.
  double after = 1;  ///< The same of those that they answer.
};

/// Adds the figures "<work> imbalance before" and "<work> imbalance after".
void recordBalance(RunStatistics& statistics, const std::string& work, const WorkBalance& balance);

/// Largest over mean of the ranks' shares of some work; 1 where there is none. Collective; one
/// number is gathered from every rank.
double findImbalance(RankExchange& exchange, std::int64_t share);

/// A run of queries that goes from a rank that has too many to one that has too few.
struct Transfer
{
  int from = 0;
  int to = 0;
  std::size_t count = 0;
};

struct WorkPlan
{
  WorkBalance balance;
  std::size_t kept = 0; ///< This rank answers its first ones itself.
  std::vector<Transfer>
    transfers; ///< Those from and to this rank, in the order of `from` and `to`.
};

/// What each rank answers: total / ranks queries, up to one more. Ranks with too many send their
/// last ones; fewer than 2 x ranks transfers in all. Collective; one number is gathered from every
/// rank.
WorkPlan planLoadBalance(RankExchange& exchange, std::size_t queries);

template<class Answer>
struct Answers
{
  std::vector<Answer> values; ///< In the order of the queries.
  WorkBalance balance;
};

/// function(query) for every query of every rank, wherever there is time for it: the answers
/// do not depend on where. Queries and answers are plain values; `function` is called from
/// several threads and must not communicate; the progress of the run counts them as `work`. Where
/// it throws, all ranks throw an Error with the reason of the lowest rank. Collective. Messages:
/// one number gathered from every rank, and what a rank has above the mean goes to one of those
/// below it, and the answers back: at most 2 x ranks messages in all.
template<class Answer, class Query, class Function>
Answers<Answer> mapBalanced(RankExchange& exchange, std::vector<Query> queries,
  const Function& function, const CountedWork& work = {})
{
  const ParallelFor parallelFor = forOnThreads(exchange);
  const WorkPlan plan = planLoadBalance(exchange, queries.size());
  std::vector<int> others;
  std::vector<std::vector<Query>> outgoing;
  auto next = queries.begin() + static_cast<std::ptrdiff_t>(plan.kept);
  for (const Transfer& transfer : plan.transfers)
  {
    const bool mine = transfer.from == exchange.rank();
    others.push_back(mine ? transfer.to : transfer.from);
    const auto end = next + static_cast<std::ptrdiff_t>(mine ? transfer.count : 0);
    outgoing.emplace_back(next, end);
    next = end;
  }
  queries.resize(plan.kept);
  const auto incoming = exchange.exchange(others, outgoing);
  for (const auto& transfer : incoming)
  {
    queries.insert(queries.end(), transfer.begin(), transfer.end());
  }

  Answers<Answer> result;
  result.balance = plan.balance;
  agreeOnFailure(exchange,
    [&]
    {
      result.values.resize(queries.size());
      forCounted(parallelFor, exchange.progress(), work, plan.balance.total, queries.size(),
        [&](std::size_t begin, std::size_t end)
        {
          const Query* first = queries.data();
          std::transform(first + begin, first + end, result.values.data() + begin, function);
        });
    });
  std::vector<std::vector<Answer>> returned;
  auto answer = result.values.begin() + static_cast<std::ptrdiff_t>(plan.kept);
  for (const auto& transfer : incoming)
  {
    const auto end = answer + static_cast<std::ptrdiff_t>(transfer.size());
    returned.emplace_back(answer, end);
    answer = end;
  }
  result.values.resize(plan.kept);
  for (const auto& transfer : exchange.exchange(others, returned))
  {
    result.values.insert(result.values.end(), transfer.begin(), transfer.end());
  }
  return result;
}

} // namespace cadrefine
