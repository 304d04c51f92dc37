// What RankExchange talks through, for the sources of this folder that need MPI itself.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/base/Error.h>

#include <mpi.h>

#include <memory>
#include <utility>
#include <vector>

namespace cadrefine
{

/// Another rank has failed, where this one waited for it: no further message will come.
class RankFailure : public Error
{
public:
  using Error::Error;
};

/// Messages under way, and the memory that they are sent from and arrive in. What is still under
/// way at the end of this object keeps that memory for ever, since MPI may yet use it.
class PendingRequests
{
public:
  PendingRequests() : state_(std::make_unique<State>()) {}
  ~PendingRequests();
  PendingRequests(const PendingRequests&) = delete;
  PendingRequests& operator=(const PendingRequests&) = delete;

  /// Memory that lives as long as the messages.
  template<class T>
  std::vector<T>& keep(std::vector<T> values)
  {
    auto kept = std::make_shared<std::vector<T>>(std::move(values));
    state_->memory.push_back(kept);
    return *kept;
  }

  /// The request of a message that is to be started: give it to MPI at once.
  MPI_Request* addRequest()
  {
    state_->requests.push_back(MPI_REQUEST_NULL);
    return &state_->requests.back();
  }

private:
  friend struct RankExchange::Link;

  struct State
  {
    std::vector<MPI_Request> requests;
    std::vector<std::shared_ptr<void>> memory;
  };
  bool isUnderWay() const;

  std::unique_ptr<State> state_;
};

/// A communicator of its own, so that no message can meet another's.
///
/// A rank that fails between two calls cannot take part in what the others wait for, and MPI's
/// blocking calls cannot be left. So all waiting is here: for messages and collectives that do not
/// block, and for the one message that a rank which fails sends to all others.
struct RankExchange::Link
{
  /// Makes a link with a communicator of its own, like `parent`. Collective.
  static std::unique_ptr<Link> make(MPI_Comm parent);

  explicit Link(MPI_Comm own) : ranks(own) {}
  ~Link() { MPI_Comm_free(&ranks); }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Waits until all of `pending` has arrived. Throws RankFailure with the reason of a rank that
  /// has failed.
  void finish(PendingRequests& pending);

  /// Starts a message; `bytes` must live as long as `pending`.
  void send(int destination, const std::vector<char>& bytes, PendingRequests& pending);

  /// The next message from `source`. Throws as `finish` does.
  std::vector<char> receive(int source);

  /// Tells all other ranks that this one has failed. Nothing can be sent through this link
  /// afterwards.
  void fail(const char* reason) noexcept;

  bool hasFailed() const { return failed_; }

  MPI_Comm ranks;

private:
  template<class Condition>
  void waitFor(const Condition& condition);
  static void tellOthers(MPI_Comm ranks, const char* reason) noexcept;
  void lookForFailure();
  std::size_t awaitMessage(int source);

  bool failed_ = false;
};

} // namespace cadrefine
