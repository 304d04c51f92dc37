#include "RankExchange.h"

#include "Error.h"
#include "FixedPointSum.h"
#include "RankExchangeLink.h"

#include <vtkMultiProcessController.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace cadrefine
{

namespace
{

constexpr int messageTag = 0x0CAD;
constexpr std::size_t headerSize = sizeof(std::int64_t);

std::int64_t announcedBytes(const std::vector<char>& message)
{
  std::int64_t bytes = 0;
  if (message.size() >= headerSize)
    std::memcpy(&bytes, message.data(), headerSize);
  return bytes;
}

// Pieces of at most `limit` bytes; the first holds the header.
std::vector<std::vector<char>> split(std::vector<char> message, std::size_t limit)
{
  std::vector<std::vector<char>> parts;
  if (message.size() <= limit)
  {
    parts.push_back(std::move(message));
    return parts;
  }
  for (std::size_t begin = 0; begin < message.size(); begin += limit)
  {
    const std::size_t end = std::min(begin + limit, message.size());
    parts.emplace_back(message.data() + begin, message.data() + end);
  }
  return parts;
}

// Ready for a minimum (worst: +infinity) or a maximum (worst: -infinity): first the values, with
// NaN and the sign of zero taken out, then for each whether it was NaN (as `flag`).
std::vector<double> withoutNan(const std::vector<double>& values, double worst, double flag)
{
  std::vector<double> result;
  result.reserve(2 * values.size());
  for (const double value : values)
    result.push_back(std::isnan(value) ? worst : value + 0.0);
  for (const double value : values)
    result.push_back(std::isnan(value) ? flag : 0.0);
  return result;
}

std::vector<double> withNan(std::vector<double> reduced)
{
  const std::size_t count = reduced.size() / 2;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (reduced[count + i] != 0)
      reduced[i] = std::numeric_limits<double>::quiet_NaN();
  }
  reduced.resize(count);
  return reduced;
}

} // namespace

/// Adds the time from its construction to its end.
class RankExchange::Clock
{
public:
  explicit Clock(double& seconds) : seconds_(seconds), start_(std::chrono::steady_clock::now()) {}
  ~Clock()
  {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;

private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_;
};

RankExchange::RankExchange(vtkMultiProcessController* controller, std::size_t messageLimit)
  : messageLimit_(messageLimit)
{
  if (messageLimit < 2 * headerSize || messageLimit > std::numeric_limits<std::int32_t>::max())
    throw Error("RankExchange: the message limit must be from 16 bytes to below 2^31.");
  if (!controller || controller->GetNumberOfProcesses() <= 1)
    return;
  link_ = std::make_unique<Link>(Link{ vtkDIYUtilities::GetCommunicator(controller) });
  if (static_cast<MPI_Comm>(link_->ranks) == MPI_COMM_NULL)
    throw Error("The processes of this controller cannot talk to each other: it has no MPI.");
  rank_ = link_->ranks.rank();
  size_ = link_->ranks.size();
}

RankExchange::~RankExchange() = default;

template<class T, class Operation>
std::vector<T> RankExchange::reduce(const std::vector<T>& mine, const Operation& operation)
{
  if (!link_)
    return mine;
  const Clock clock(seconds_);
  std::vector<T> result;
  diy::mpi::all_reduce(link_->ranks, mine, result, operation);
  return result;
}

bool RankExchange::any(bool mine)
{
  return max(mine ? 1 : 0) != 0;
}

void RankExchange::agree(const std::string& error)
{
  const int speaker = static_cast<int>(min(error.empty() ? size_ : rank_));
  if (speaker == size_)
    return;
  const std::vector<char> text = broadcast({ error.begin(), error.end() }, speaker);
  throw Error(std::string(text.begin(), text.end()));
}

std::vector<std::int64_t> RankExchange::sum(const std::vector<std::int64_t>& mine)
{
  return reduce(mine, std::plus<std::int64_t>());
}

std::vector<std::int64_t> RankExchange::min(const std::vector<std::int64_t>& mine)
{
  return reduce(mine, diy::mpi::minimum<std::int64_t>());
}

std::vector<std::int64_t> RankExchange::max(const std::vector<std::int64_t>& mine)
{
  return reduce(mine, diy::mpi::maximum<std::int64_t>());
}

std::vector<double> RankExchange::min(const std::vector<double>& mine)
{
  const double infinity = std::numeric_limits<double>::infinity();
  return withNan(reduce(withoutNan(mine, infinity, -1.0), diy::mpi::minimum<double>()));
}

std::vector<double> RankExchange::max(const std::vector<double>& mine)
{
  const double infinity = std::numeric_limits<double>::infinity();
  return withNan(reduce(withoutNan(mine, -infinity, 1.0), diy::mpi::maximum<double>()));
}

std::vector<std::int64_t> RankExchange::gather(std::int64_t mine)
{
  if (!link_)
    return { mine };
  const Clock clock(seconds_);
  std::vector<std::int64_t> all;
  diy::mpi::all_gather(link_->ranks, mine, all);
  return all;
}

std::vector<double> RankExchange::gather(const std::vector<double>& mine)
{
  if (!link_)
    return mine;
  const Clock clock(seconds_);
  std::vector<std::vector<double>> all;
  diy::mpi::all_gather(link_->ranks, mine, all);
  std::vector<double> row;
  for (const std::vector<double>& numbers : all)
    row.insert(row.end(), numbers.begin(), numbers.end());
  return row;
}

std::int64_t RankExchange::sumBefore(std::int64_t mine)
{
  if (!link_)
    return 0;
  const Clock clock(seconds_);
  std::int64_t withMine = 0;
  diy::mpi::scan(link_->ranks, mine, withMine, std::plus<std::int64_t>());
  return withMine - mine;
}

double RankExchange::sumReproducibly(const std::vector<double>& addends)
{
  const std::int64_t exponent = max(FixedPointSum::exponentOf(addends));
  if (exponent == FixedPointSum::allZero)
    return 0;
  if (exponent == FixedPointSum::notFinite)
    return std::numeric_limits<double>::quiet_NaN();
  FixedPointSum mine(exponent);
  for (const double addend : addends)
    mine.add(addend);
  const FixedPointSum::Limbs limbs = mine.limbs();
  const std::vector<std::int64_t> all = sum(std::vector<std::int64_t>(limbs.begin(), limbs.end()));
  return FixedPointSum(exponent, { all[0], all[1], all[2], all[3] }).value();
}

std::vector<char> RankExchange::broadcast(const std::vector<char>& bytes, int root)
{
  if (!link_)
    return bytes;
  const Clock clock(seconds_);
  std::int64_t total = static_cast<std::int64_t>(bytes.size());
  diy::mpi::broadcast(link_->ranks, total, root);
  std::vector<char> result;
  result.reserve(static_cast<std::size_t>(total));
  while (result.size() < static_cast<std::size_t>(total))
  {
    const std::size_t count =
      std::min(static_cast<std::size_t>(total) - result.size(), messageLimit_);
    std::vector<char> part;
    if (rank_ == root)
    {
      const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(result.size());
      part.assign(first, first + static_cast<std::ptrdiff_t>(count));
    }
    diy::mpi::broadcast(link_->ranks, part, root);
    result.insert(result.end(), part.begin(), part.end());
  }
  return result;
}

// 1. Tell every rank how many bytes it will get. 2. Send to those that get some, and receive from
// those that announced some.
std::vector<RankExchange::Message> RankExchange::allToAllMessages(std::vector<Message> toRank)
{
  const std::size_t rankCount = static_cast<std::size_t>(size_);
  if (toRank.size() != rankCount)
    throw Error("RankExchange::allToAll: needs one list for each rank.");
  if (!link_)
    return toRank;

  std::vector<std::int64_t> bytesTo(rankCount);
  std::transform(toRank.begin(), toRank.end(), bytesTo.begin(), announcedBytes);
  std::vector<std::int64_t> bytesFrom(rankCount);
  {
    const Clock clock(seconds_);
    diy::mpi::all_to_all(link_->ranks, bytesTo, bytesFrom);
  }

  std::vector<int> destinations;
  std::vector<int> sources;
  std::vector<Message> outgoing;
  for (std::size_t r = 0; r < rankCount; ++r)
  {
    if (bytesFrom[r] > 0)
      sources.push_back(static_cast<int>(r));
    if (bytesTo[r] > 0)
    {
      destinations.push_back(static_cast<int>(r));
      outgoing.push_back(std::move(toRank[r]));
    }
  }
  std::vector<Message> incoming = transfer(destinations, std::move(outgoing), sources);
  std::vector<Message> fromRank(rankCount);
  for (std::size_t i = 0; i < sources.size(); ++i)
    fromRank[static_cast<std::size_t>(sources[i])] = std::move(incoming[i]);
  return fromRank;
}

std::vector<RankExchange::Message> RankExchange::exchangeMessages(
  const std::vector<int>& neighbours, std::vector<Message> toNeighbour)
{
  if (toNeighbour.size() != neighbours.size())
    throw Error("RankExchange::exchange: needs one list for each neighbour.");
  for (const int neighbour : neighbours)
  {
    if (neighbour < 0 || neighbour >= size_)
      throw Error("RankExchange::exchange: there is no rank " + std::to_string(neighbour) + ".");
  }
  return transfer(neighbours, std::move(toNeighbour), neighbours);
}

// Sends do not block, so that the receives can wait in any order. Messages from one rank to another
// arrive in the order in which they were sent: those of two calls cannot be mixed up.
std::vector<RankExchange::Message> RankExchange::transfer(const std::vector<int>& destinations,
  std::vector<Message> outgoing, const std::vector<int>& sources)
{
  const Clock clock(seconds_);
  std::vector<diy::mpi::request> requests;
  std::vector<std::vector<Message>> parts(outgoing.size());
  Message toMyself;
  for (std::size_t i = 0; i < outgoing.size(); ++i)
  {
    if (destinations[i] == rank_)
    {
      toMyself = std::move(outgoing[i]);
      continue;
    }
    bytesSent_ += static_cast<std::int64_t>(outgoing[i].size());
    parts[i] = split(std::move(outgoing[i]), messageLimit_);
    for (const Message& part : parts[i])
      requests.push_back(link_->ranks.isend(destinations[i], messageTag, part));
    messagesSent_ += static_cast<std::int64_t>(parts[i].size());
  }
  std::vector<Message> incoming(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    if (sources[i] == rank_)
      incoming[i].swap(toMyself);
    else
      incoming[i] = receive(sources[i]);
  }
  for (diy::mpi::request& request : requests)
    request.wait();
  return incoming;
}

RankExchange::Message RankExchange::receive(int source)
{
  Message message;
  link_->ranks.recv(source, messageTag, message);
  const std::size_t total = headerSize + static_cast<std::size_t>(announcedBytes(message));
  message.reserve(total);
  while (message.size() < total)
  {
    Message part;
    link_->ranks.recv(source, messageTag, part);
    message.insert(message.end(), part.begin(), part.end());
  }
  return message;
}

} // namespace cadrefine
