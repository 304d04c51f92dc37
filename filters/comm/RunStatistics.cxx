#include "comm/RunStatistics.h"

#include <iomanip>
#include <limits>
#include <sstream>

namespace cadrefine
{

RunStatistics::Stopwatch::Stopwatch(RunStatistics& statistics, const std::string& name)
  : seconds_(statistics.figures_[name]), start_(std::chrono::steady_clock::now())
{
}

RunStatistics::Stopwatch::~Stopwatch()
{
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start_;
  seconds_ += seconds.count();
}

void RunStatistics::take(const RunStatistics& part)
{
  for (const auto& [name, value] : part.figures_)
  {
    name.rfind("seconds", 0) == 0 ? add(name, value) : set(name, value);
  }
}

RunStatistics::Sent RunStatistics::sentBy(const RankExchange& exchange)
{
  return { exchange.seconds(), exchange.bytesSent(), exchange.messagesSent() };
}

void RunStatistics::gather(RankExchange& exchange, const Sent& before)
{
  const Sent now = sentBy(exchange);
  const auto bytes = now.bytes - before.bytes;
  const std::vector<std::int64_t> sent = exchange.sum({ bytes, now.messages - before.messages });
  set("seconds exchange", exchange.seconds() - before.seconds);
  std::vector<double> values{ static_cast<double>(bytes) };
  for (const auto& figure : figures_)
  {
    values.push_back(figure.second);
  }
  values = exchange.max(values);
  std::size_t next = 1;
  for (auto& figure : figures_)
  {
    figure.second = values[next++];
  }
  set("bytes sent", static_cast<double>(sent[0]));
  set("messages sent", static_cast<double>(sent[1]));
  set("largest bytes sent", values[0]);
}

std::string RunStatistics::json() const
{
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::digits10) << "{";
  const char* separator = "";
  for (const auto& [name, value] : figures_)
  {
    text << separator << std::quoted(name) << ": " << value;
    separator = ", ";
  }
  text << "}";
  return text.str();
}

} // namespace cadrefine
