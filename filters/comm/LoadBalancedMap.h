// Work that any rank can do, shared out evenly.
#pragma once

#include "comm/CollectiveErrors.h"
#include "comm/RankExchange.h"
#include "comm/RunStatistics.h"
#include "comm/Threads.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace cadrefine
{

/// How evenly queries lie on the ranks.
struct WorkBalance
{
  std::int64_t total = 0;
  double before = 1; ///< Largest over mean of the numbers of queries that ranks have.
  double after = 1;  ///< Largest over mean of the numbers of queries that ranks answer.
};

/// Adds the figures "<work> imbalance before" and "<work> imbalance after".
void recordBalance(RunStatistics& statistics, const std::string& work, const WorkBalance& balance);

/// Largest over mean of the ranks' shares of some work; 1 where there is none. Collective; one
/// number is gathered from every rank.
double findImbalance(RankExchange& exchange, std::int64_t share);

/// Which queries of this rank go where: the first ones stay, runs of the others go to ranks that
/// have too few.
struct WorkPlan
{
  WorkBalance balance;
  std::size_t kept = 0;
  std::vector<int> ranks;            ///< Ranks that queries go to, or come from.
  std::vector<std::size_t> sent;     ///< Number of queries for each of them.
  std::vector<std::size_t> received; ///< Number of queries from each of them.
};

/// Plans which queries each rank answers: total / ranks queries, up to one more. Ranks with too
/// many send their last ones; fewer than 2 x ranks transfers in all. Collective; one number is
/// gathered from every rank.
WorkPlan planLoadBalance(RankExchange& exchange, std::size_t queries);

/// Sends the items after the first `kept`, in runs of these lengths, to these ranks, and puts what
/// they send in place of them. Collective.
template<class Item>
void exchangeTail(RankExchange& exchange, const std::vector<int>& ranks,
  const std::vector<std::size_t>& lengths, std::size_t kept, std::vector<Item>& items)
{
  std::vector<std::vector<Item>> outgoing;
  auto next = items.begin() + static_cast<std::ptrdiff_t>(kept);
  for (const std::size_t length : lengths)
  {
    const auto end = next + static_cast<std::ptrdiff_t>(length);
    outgoing.emplace_back(next, end);
    next = end;
  }
  items.resize(kept);
  for (const auto& run : exchange.exchange(ranks, outgoing))
  {
    items.insert(items.end(), run.begin(), run.end());
  }
}

template<class Answer>
struct Answers
{
  std::vector<Answer> values; ///< In the order of the queries.
  WorkBalance balance;
};

/// Computes function(query) for every query of every rank, wherever there is time for it: the
/// answers do not depend on where. Queries and answers are plain values; `function` is called from
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
  exchangeTail(exchange, plan.ranks, plan.sent, plan.kept, queries);
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
  exchangeTail(exchange, plan.ranks, plan.received, plan.kept, result.values);
  return result;
}

/// Queries, each with a number by which the caller knows what it is about.
template<class Query>
struct NumberedQueries
{
  std::vector<std::size_t> numbers;
  std::vector<Query> queries;

  void add(std::size_t number, const Query& query)
  {
    numbers.push_back(number);
    queries.push_back(query);
  }
};

/// Answers the queries by mapBalanced, then calls use(number, answer) for each of them in order.
template<class Answer, class Query, class Function, class Use>
WorkBalance answerBalanced(RankExchange& exchange, NumberedQueries<Query> asked,
  const Function& function, const Use& use, const CountedWork& work = {})
{
  const auto answers = mapBalanced<Answer>(exchange, std::move(asked.queries), function, work);
  for (std::size_t i = 0; i < asked.numbers.size(); ++i)
  {
    use(asked.numbers[i], answers.values[i]);
  }
  return answers.balance;
}

} // namespace cadrefine
