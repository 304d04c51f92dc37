// The one place where ranks talk.
#pragma once

#include "comm/Progress.h"

#include <cadrefine/base/Error.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

class vtkMultiProcessController;

namespace cadrefine
{

/// A failure that all ranks know of: they all throw it at the same place.
class AgreedError : public Error
{
public:
  using Error::Error;
};

/// Messages between the ranks of a controller.
///
/// Every member function that takes part in communication is collective: all ranks call the same
/// ones in the same order (`exchange` too). With no controller, a vtkDummyController or one
/// process everything stays local, and MPI is not touched.
///
/// Costs, with P ranks: a reduction or broadcast is one MPI collective, O(log P) messages deep;
/// `allToAll` exchanges one 8-byte count with every rank (O(P) bytes and memory), then sends one
/// message to each rank that gets data; `exchange` sends one message to each neighbour and nothing
/// else. A message carries 8 bytes more than its data; while it travels, the data is held once
/// more on both sides. Data for oneself is copied and not counted.
///
/// Fails: a controller of several processes without MPI makes the constructor throw Error. Data of
/// more than the message limit goes out in several messages, so there is no limit of 2 GiB. A rank
/// that leaves by an exception of its own between two collective calls must tell the others
/// (`fail`; see runCollectively in CollectiveErrors.h): where they wait for it, they throw
/// RankFailure, which is an Error, with its reason. Nothing can be sent afterwards; a new object
/// can.
class RankExchange
{
public:
  static constexpr std::size_t defaultMessageLimit = std::size_t{ 1 } << 30;

  /// @param controller nullptr stands for one rank; it must outlive this object.
  /// @param messageLimit bytes of the longest single message, at least 16 and below 2^31; the same
  ///   on all ranks.
  explicit RankExchange(
    vtkMultiProcessController* controller, std::size_t messageLimit = defaultMessageLimit);
  ~RankExchange();
  RankExchange(const RankExchange&) = delete;
  RankExchange& operator=(const RankExchange&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

  /// What this rank tells of the run. Not communicated.
  Progress& progress() { return progress_; }

  /// Whether `mine` holds on any rank.
  bool any(bool mine);

  /// Returns if `error` is empty on all ranks; otherwise throws, on all ranks, an AgreedError with
  /// the text of the lowest rank that has one. One reduction, and a broadcast where there is an
  /// error.
  void agree(const std::string& error);

  /// Tells all other ranks that this one has failed and will not call again. Not collective; one
  /// short message to each.
  void fail(const std::string& reason) noexcept;

  /// Reductions of one number over the ranks; integers of any type.
  template<class I>
  std::enable_if_t<std::is_integral_v<I>, std::int64_t> sum(I mine)
  {
    return sum(std::vector<std::int64_t>{ static_cast<std::int64_t>(mine) }).front();
  }
  template<class I>
  std::enable_if_t<std::is_integral_v<I>, std::int64_t> min(I mine)
  {
    return min(std::vector<std::int64_t>{ static_cast<std::int64_t>(mine) }).front();
  }
  template<class I>
  std::enable_if_t<std::is_integral_v<I>, std::int64_t> max(I mine)
  {
    return max(std::vector<std::int64_t>{ static_cast<std::int64_t>(mine) }).front();
  }
  double min(double mine) { return min(std::vector<double>{ mine }).front(); }
  double max(double mine) { return max(std::vector<double>{ mine }).front(); }

  /// Reductions element by element: a few numbers (all ranks give the same count of them) in one
  /// collective. For doubles, the result is NaN where one rank has NaN, and -0.0 counts as 0.0.
  std::vector<std::int64_t> sum(const std::vector<std::int64_t>& mine);
  std::vector<std::int64_t> min(const std::vector<std::int64_t>& mine);
  std::vector<std::int64_t> max(const std::vector<std::int64_t>& mine);
  std::vector<double> min(const std::vector<double>& mine);
  std::vector<double> max(const std::vector<double>& mine);

  /// What each rank gives, in the order of the ranks: 8 bytes x P.
  std::vector<std::int64_t> gather(std::int64_t mine);

  /// The few numbers that each rank gives (all ranks give the same count of them), in a row, in the
  /// order of the ranks.
  std::vector<double> gather(const std::vector<double>& mine);

  /// The sum of `mine` over the ranks below this one.
  std::int64_t sumBefore(std::int64_t mine);

  /// The sum of all ranks' addends, bit for bit the same for every order of the addends and every
  /// way of sharing them out. It differs from the exact sum by less than (number of addends) x
  /// 2^-111 x (largest magnitude), and then by rounding (see FixedPointSum). No addends: 0; a NaN
  /// or an infinity: NaN. Two reductions, of one and of four numbers.
  double sumReproducibly(const std::vector<double>& addends);

  /// Sends toRank[r] to rank r (one list for each rank); result[r] is what rank r sent here.
  template<class T>
  std::vector<std::vector<T>> allToAll(const std::vector<std::vector<T>>& toRank)
  {
    return unpacked<T>(allToAllMessages(packed(toRank)));
  }

  /// allToAll with a few ranks only: toNeighbour[k] goes to neighbours[k], and result[k] comes from
  /// there. Ranks must name each other (if a is among b's neighbours, then b among a's) and none
  /// twice, or they wait for ever.
  template<class T>
  std::vector<std::vector<T>> exchange(
    const std::vector<int>& neighbours, const std::vector<std::vector<T>>& toNeighbour)
  {
    return unpacked<T>(exchangeMessages(neighbours, packed(toNeighbour)));
  }

  /// The bytes that rank `root` gives; what the others give is ignored.
  std::vector<char> broadcast(const std::vector<char>& bytes, int root);

  /// Bytes and number of messages that this rank has sent to single other ranks since construction.
  /// MPI collectives are not counted.
  std::int64_t bytesSent() const { return bytesSent_; }
  std::int64_t messagesSent() const { return messagesSent_; }

  /// The seconds that this rank has spent sending, receiving and waiting for others since
  /// construction.
  double seconds() const { return seconds_; }

  struct Link;
  /// The communicator (see RankExchangeLink.h); null with one rank.
  const Link* link() const { return link_.get(); }

private:
  // A message is the length of its data in bytes (8 bytes), and the data.
  using Message = std::vector<char>;

  template<class T>
  static std::vector<Message> packed(const std::vector<std::vector<T>>& lists);
  template<class T>
  static std::vector<std::vector<T>> unpacked(std::vector<Message> messages);

  std::vector<Message> allToAllMessages(std::vector<Message> toRank);
  std::vector<Message> exchangeMessages(
    const std::vector<int>& neighbours, std::vector<Message> toNeighbour);
  std::vector<Message> transfer(const std::vector<int>& destinations, std::vector<Message> outgoing,
    const std::vector<int>& sources);
  Message receive(int source);
  std::vector<std::int64_t> swapCounts(const std::vector<Message>& toRank);
  class Clock;
  enum class Reduction
  {
    Sum,
    Minimum,
    Maximum
  };
  template<class T>
  std::vector<T> reduce(const std::vector<T>& mine, Reduction reduction);
  template<class T>
  std::vector<T> gatherAll(const std::vector<T>& mine);

  Progress progress_;
  std::unique_ptr<Link> link_; // null where there is one rank
  int rank_ = 0;
  int size_ = 1;
  std::size_t messageLimit_;
  std::int64_t bytesSent_ = 0;
  std::int64_t messagesSent_ = 0;
  double seconds_ = 0;
};

template<class T>
std::vector<RankExchange::Message> RankExchange::packed(const std::vector<std::vector<T>>& lists)
{
  static_assert(std::is_trivially_copyable_v<T>, "only plain values can be sent");
  static_assert(!std::is_same_v<T, bool>, "send char instead of bool");
  std::vector<Message> messages;
  messages.reserve(lists.size());
  for (const std::vector<T>& list : lists)
  {
    const std::int64_t bytes = static_cast<std::int64_t>(list.size() * sizeof(T));
    Message message(sizeof(bytes) + static_cast<std::size_t>(bytes));
    std::memcpy(message.data(), &bytes, sizeof(bytes));
    if (bytes > 0)
    {
      std::memcpy(message.data() + sizeof(bytes), list.data(), static_cast<std::size_t>(bytes));
    }
    messages.push_back(std::move(message));
  }
  return messages;
}

template<class T>
std::vector<std::vector<T>> RankExchange::unpacked(std::vector<Message> messages)
{
  std::vector<std::vector<T>> lists(messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i)
  {
    Message message = std::move(messages[i]); // freed at the end of this turn
    if (message.size() <= sizeof(std::int64_t))
    {
      continue;
    }
    const std::size_t bytes = message.size() - sizeof(std::int64_t);
    lists[i].resize(bytes / sizeof(T));
    std::memcpy(lists[i].data(), message.data() + sizeof(std::int64_t), bytes);
  }
  return lists;
}

} // namespace cadrefine
