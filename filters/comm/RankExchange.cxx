#include "comm/RankExchange.h"

#include "comm/FixedPointSum.h"
#include "comm/RankExchangeLink.h"

#include <cadrefine/base/Error.h>

#include <vtkDIYUtilities.h>
#include <vtkMultiProcessController.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace cadrefine
{

namespace
{

constexpr std::size_t headerSize = sizeof(std::int64_t);

MPI_Datatype typeOf(const std::vector<std::int64_t>&)
{
  return MPI_INT64_T;
}

MPI_Datatype typeOf(const std::vector<double>&)
{
  return MPI_DOUBLE;
}

std::int64_t announcedBytes(const std::vector<char>& message)
{
  std::int64_t bytes = 0;
  if (message.size() >= headerSize)
  {
    std::memcpy(&bytes, message.data(), headerSize);
  }
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
  {
    result.push_back(std::isnan(value) ? worst : value + 0.0);
  }
  for (const double value : values)
  {
    result.push_back(std::isnan(value) ? flag : 0.0);
  }
  return result;
}

std::vector<double> withNan(std::vector<double> reduced)
{
  const std::size_t count = reduced.size() / 2;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (reduced[count + i] != 0)
    {
      reduced[i] = std::numeric_limits<double>::quiet_NaN();
    }
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
  {
    throw Error("RankExchange: the message limit must be from 16 bytes to below 2^31.");
  }
  if (!controller || controller->GetNumberOfProcesses() <= 1)
  {
    return;
  }
  const auto parent = static_cast<MPI_Comm>(vtkDIYUtilities::GetCommunicator(controller));
  if (parent == MPI_COMM_NULL)
  {
    throw Error("The processes of this controller cannot talk to each other: it has no MPI.");
  }
  link_ = Link::make(parent);
  MPI_Comm_rank(link_->ranks, &rank_);
  MPI_Comm_size(link_->ranks, &size_);
}

// A link that has failed may have messages under way that nobody will take: it stays.
RankExchange::~RankExchange()
{
  if (link_ && link_->hasFailed())
  {
    static_cast<void>(link_.release());
  }
}

template<class T>
std::vector<T> RankExchange::reduce(const std::vector<T>& mine, Reduction reduction)
{
  if (!link_)
  {
    return mine;
  }
  const Clock clock(seconds_);
  const MPI_Op operation = reduction == Reduction::Sum       ? MPI_SUM
                           : reduction == Reduction::Minimum ? MPI_MIN
                                                             : MPI_MAX;
  PendingRequests pending;
  std::vector<T>& values = pending.keep(mine);
  MPI_Iallreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), typeOf(values),
    operation, link_->ranks, pending.addRequest());
  link_->finish(pending);
  return std::move(values);
}

template<class T>
std::vector<T> RankExchange::gatherAll(const std::vector<T>& mine)
{
  if (!link_)
  {
    return mine;
  }
  const Clock clock(seconds_);
  PendingRequests pending;
  const std::vector<T>& given = pending.keep(mine);
  std::vector<T>& all = pending.keep(std::vector<T>(mine.size() * static_cast<std::size_t>(size_)));
  const int count = static_cast<int>(mine.size());
  MPI_Iallgather(given.data(), count, typeOf(given), all.data(), count, typeOf(all), link_->ranks,
    pending.addRequest());
  link_->finish(pending);
  return std::move(all);
}

bool RankExchange::any(bool mine)
{
  return max(mine ? 1 : 0) != 0;
}

void RankExchange::agree(const std::string& error)
{
  const int speaker = static_cast<int>(min(error.empty() ? size_ : rank_));
  if (speaker == size_)
  {
    return;
  }
  const std::vector<char> text = broadcast({ error.begin(), error.end() }, speaker);
  throw AgreedError(std::string(text.begin(), text.end()));
}

std::vector<std::int64_t> RankExchange::sum(const std::vector<std::int64_t>& mine)
{
  return reduce(mine, Reduction::Sum);
}

std::vector<std::int64_t> RankExchange::min(const std::vector<std::int64_t>& mine)
{
  return reduce(mine, Reduction::Minimum);
}

std::vector<std::int64_t> RankExchange::max(const std::vector<std::int64_t>& mine)
{
  return reduce(mine, Reduction::Maximum);
}

std::vector<double> RankExchange::min(const std::vector<double>& mine)
{
  const double infinity = std::numeric_limits<double>::infinity();
  return withNan(reduce(withoutNan(mine, infinity, -1.0), Reduction::Minimum));
}

std::vector<double> RankExchange::max(const std::vector<double>& mine)
{
  const double infinity = std::numeric_limits<double>::infinity();
  return withNan(reduce(withoutNan(mine, -infinity, 1.0), Reduction::Maximum));
}

std::vector<std::int64_t> RankExchange::gather(std::int64_t mine)
{
  return gatherAll(std::vector<std::int64_t>{ mine });
}

std::vector<double> RankExchange::gather(const std::vector<double>& mine)
{
  return gatherAll(mine);
}

std::int64_t RankExchange::sumBefore(std::int64_t mine)
{
  if (!link_)
  {
    return 0;
  }
  const Clock clock(seconds_);
  PendingRequests pending;
  std::vector<std::int64_t>& sum = pending.keep(std::vector<std::int64_t>{ mine });
  MPI_Iscan(MPI_IN_PLACE, sum.data(), 1, MPI_INT64_T, MPI_SUM, link_->ranks, pending.addRequest());
  link_->finish(pending);
  return sum.front() - mine;
}

double RankExchange::sumReproducibly(const std::vector<double>& addends)
{
  const std::int64_t exponent = max(FixedPointSum::exponentOf(addends));
  if (exponent == FixedPointSum::allZero)
  {
    return 0;
  }
  if (exponent == FixedPointSum::notFinite)
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  FixedPointSum mine(exponent);
  for (const double addend : addends)
  {
    mine.add(addend);
  }
  const FixedPointSum::Limbs limbs = mine.limbs();
  const std::vector<std::int64_t> all = sum(std::vector<std::int64_t>(limbs.begin(), limbs.end()));
  return FixedPointSum(exponent, { all[0], all[1], all[2], all[3] }).value();
}

std::vector<char> RankExchange::broadcast(const std::vector<char>& bytes, int root)
{
  if (!link_)
  {
    return bytes;
  }
  const Clock clock(seconds_);
  PendingRequests pending;
  std::vector<std::int64_t>& total =
    pending.keep(std::vector<std::int64_t>{ static_cast<std::int64_t>(bytes.size()) });
  MPI_Ibcast(total.data(), 1, MPI_INT64_T, root, link_->ranks, pending.addRequest());
  link_->finish(pending);
  std::vector<char>& result = pending.keep(
    rank_ == root ? bytes : std::vector<char>(static_cast<std::size_t>(total.front())));
  for (std::size_t begin = 0; begin < result.size(); begin += messageLimit_)
  {
    const std::size_t count = std::min(result.size() - begin, messageLimit_);
    MPI_Ibcast(result.data() + begin, static_cast<int>(count), MPI_BYTE, root, link_->ranks,
      pending.addRequest());
    link_->finish(pending);
  }
  return std::move(result);
}

std::vector<std::int64_t> RankExchange::swapCounts(const std::vector<Message>& toRank)
{
  const Clock clock(seconds_);
  PendingRequests pending;
  std::vector<std::int64_t>& to = pending.keep(std::vector<std::int64_t>(toRank.size()));
  std::transform(toRank.begin(), toRank.end(), to.begin(), announcedBytes);
  std::vector<std::int64_t>& from = pending.keep(std::vector<std::int64_t>(toRank.size()));
  MPI_Ialltoall(
    to.data(), 1, MPI_INT64_T, from.data(), 1, MPI_INT64_T, link_->ranks, pending.addRequest());
  link_->finish(pending);
  return std::move(from);
}

// 1. Tell every rank how many bytes it will get. 2. Send to those that get some, and receive from
// those that announced some.
std::vector<RankExchange::Message> RankExchange::allToAllMessages(std::vector<Message> toRank)
{
  const std::size_t rankCount = static_cast<std::size_t>(size_);
  if (toRank.size() != rankCount)
  {
    throw Error("RankExchange::allToAll: needs one list for each rank.");
  }
  if (!link_)
  {
    return toRank;
  }

  const std::vector<std::int64_t> bytesFrom = swapCounts(toRank);
  std::vector<int> destinations;
  std::vector<int> sources;
  std::vector<Message> outgoing;
  for (std::size_t r = 0; r < rankCount; ++r)
  {
    if (bytesFrom[r] > 0)
    {
      sources.push_back(static_cast<int>(r));
    }
    if (announcedBytes(toRank[r]) > 0)
    {
      destinations.push_back(static_cast<int>(r));
      outgoing.push_back(std::move(toRank[r]));
    }
  }
  std::vector<Message> incoming = transfer(destinations, std::move(outgoing), sources);
  std::vector<Message> fromRank(rankCount);
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    fromRank[static_cast<std::size_t>(sources[i])] = std::move(incoming[i]);
  }
  return fromRank;
}

std::vector<RankExchange::Message> RankExchange::exchangeMessages(
  const std::vector<int>& neighbours, std::vector<Message> toNeighbour)
{
  if (toNeighbour.size() != neighbours.size())
  {
    throw Error("RankExchange::exchange: needs one list for each neighbour.");
  }
  for (const int neighbour : neighbours)
  {
    if (neighbour < 0 || neighbour >= size_)
    {
      throw Error("RankExchange::exchange: there is no rank " + std::to_string(neighbour) + ".");
    }
  }
  return transfer(neighbours, std::move(toNeighbour), neighbours);
}

void RankExchange::fail(const std::string& reason) noexcept
{
  if (link_)
  {
    link_->fail(reason.c_str());
  }
}

// Sends do not block, so that the receives can wait in any order. Messages from one rank to another
// arrive in the order in which they were sent: those of two calls cannot be mixed up.
std::vector<RankExchange::Message> RankExchange::transfer(const std::vector<int>& destinations,
  std::vector<Message> outgoing, const std::vector<int>& sources)
{
  const Clock clock(seconds_);
  PendingRequests sent;
  Message toMyself;
  for (std::size_t i = 0; i < outgoing.size(); ++i)
  {
    if (destinations[i] == rank_)
    {
      toMyself = std::move(outgoing[i]);
      continue;
    }
    bytesSent_ += static_cast<std::int64_t>(outgoing[i].size());
    for (Message& part : split(std::move(outgoing[i]), messageLimit_))
    {
      link_->send(destinations[i], sent.keep(std::move(part)), sent);
      ++messagesSent_;
    }
  }
  std::vector<Message> incoming(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    if (sources[i] == rank_)
    {
      incoming[i].swap(toMyself);
    }
    else
    {
      incoming[i] = receive(sources[i]);
    }
  }
  if (link_)
  {
    link_->finish(sent);
  }
  return incoming;
}

RankExchange::Message RankExchange::receive(int source)
{
  Message message = link_->receive(source);
  const std::size_t total = headerSize + static_cast<std::size_t>(announcedBytes(message));
  message.reserve(total);
  while (message.size() < total)
  {
    const Message part = link_->receive(source);
    message.insert(message.end(), part.begin(), part.end());
  }
  return message;
}

} // namespace cadrefine
