#include "comm/RankExchangeLink.h"

#include "comm/CollectiveErrors.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace cadrefine
{
namespace
{

constexpr int messageTag = 0x0CAD;
constexpr int failureTag = 0x0BAD;

using Reason = std::array<char, 1024>;

} // namespace

bool PendingRequests::isUnderWay() const
{
  return state_ && std::any_of(state_->requests.begin(), state_->requests.end(),
                     [](MPI_Request request) { return request != MPI_REQUEST_NULL; });
}

PendingRequests::~PendingRequests()
{
  if (isUnderWay())
  {
    static_cast<void>(state_.release());
  }
}

// All ranks duplicate the communicator before one can fail.
std::unique_ptr<RankExchange::Link> RankExchange::Link::make(MPI_Comm parent)
{
  MPI_Comm own = MPI_COMM_NULL;
  MPI_Comm_dup(parent, &own);
  try
  {
    return std::make_unique<Link>(own);
  }
  catch (...)
  {
    tellOthers(own, caughtReason().c_str());
    throw;
  }
}

template<class Condition>
void RankExchange::Link::waitFor(const Condition& condition)
{
  constexpr unsigned turnsBetweenLooks = 64; // messages are far more often than failures
  for (unsigned turn = 1; !condition(); ++turn)
  {
    if (turn % turnsBetweenLooks == 0)
    {
      lookForFailure();
    }
  }
}

void RankExchange::Link::finish(PendingRequests& pending)
{
  auto& requests = pending.state_->requests;
  waitFor(
    [&]
    {
      int done = 0;
      MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
      return done != 0;
    });
}

std::size_t RankExchange::Link::awaitMessage(int source)
{
  MPI_Status status;
  waitFor(
    [&]
    {
      int arrived = 0;
      MPI_Iprobe(source, messageTag, ranks, &arrived, &status);
      return arrived != 0;
    });
  int bytes = 0;
  MPI_Get_count(&status, MPI_BYTE, &bytes);
  return static_cast<std::size_t>(bytes);
}

void RankExchange::Link::send(
  int destination, const std::vector<char>& bytes, PendingRequests& pending)
{
  MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, destination, messageTag, ranks,
    pending.addRequest());
}

std::vector<char> RankExchange::Link::receive(int source)
{
  PendingRequests pending;
  std::vector<char>& bytes = pending.keep(std::vector<char>(awaitMessage(source)));
  MPI_Irecv(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, source, messageTag, ranks,
    pending.addRequest());
  finish(pending);
  return std::move(bytes);
}

void RankExchange::Link::lookForFailure()
{
  int arrived = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, failureTag, ranks, &arrived, &status);
  if (!arrived)
  {
    return;
  }
  failed_ = true;
  Reason reason;
  MPI_Recv(reason.data(), static_cast<int>(reason.size()), MPI_BYTE, status.MPI_SOURCE, failureTag,
    ranks, MPI_STATUS_IGNORE);
  throw RankFailure(reason.data());
}

void RankExchange::Link::fail(const char* reason) noexcept
{
  if (!failed_)
  {
    tellOthers(ranks, reason);
  }
  failed_ = true;
}

// There may be no memory. The text that is sent stays until the next failure.
void RankExchange::Link::tellOthers(MPI_Comm ranks, const char* reason) noexcept
{
  static Reason sent;
  sent.fill('\0');
  std::strncpy(sent.data(), reason, sent.size() - 1);
  int rank = 0;
  int size = 0;
  MPI_Comm_rank(ranks, &rank);
  MPI_Comm_size(ranks, &size);
  for (int other = 0; other < size; ++other)
  {
    if (other == rank)
    {
      continue;
    }
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Isend(
      sent.data(), static_cast<int>(sent.size()), MPI_BYTE, other, failureTag, ranks, &request);
    MPI_Request_free(&request);
  }
}

} // namespace cadrefine
