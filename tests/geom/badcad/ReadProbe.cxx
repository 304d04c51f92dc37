#include "ReadProbe.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/cad/model/ModelDrawing.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace badcad
{
namespace
{

using cadrefine::CADModel;
using cadrefine::isFinite;
using cadrefine::Point3;

/// Points of the model (each entity's middle) and others around it, at most some `most`.
std::vector<Point3> queryPoints(const CADModel& model, int most)
{
  std::vector<Point3> points{ { 0, 0, 0 } };
  for (int i = 0; i < model.count(0) && i < most / 2; ++i)
  {
    points.push_back(model.nurbs().vertices[i].point);
  }
  for (int i = 0; i < model.count(2) && static_cast<int>(points.size()) < most; ++i)
  {
    const auto& patch = model.nurbs().faces[i].patches.front();
    points.push_back(
      model.evaluate({ 2, i }, { 0.5 * (patch.u0 + patch.u1), 0.5 * (patch.v0 + patch.v1) }));
  }
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    const double off = 0.1 * model.size() * static_cast<double>(i % 5);
    const Point3& p = points[i];
    points.push_back({ p[0] + off, p[1] - 0.7 * off, p[2] + 0.3 * off });
  }
  return points;
}

/// What is wrong with the answers to nearest-point queries; "" for nothing.
std::string checkQueries(const CADModel& model, const CADModel& again)
{
  constexpr int most = 40;
  for (const Point3& point : queryPoints(model, most))
  {
    const auto answer = model.nearest(point);
    const auto second = again.nearest(point);
    if (!answer.entity || !isFinite(answer.point) || !std::isfinite(answer.distance))
    {
      return "a nearest point is not finite";
    }
    if (!(answer.entity == second.entity) || answer.point != second.point)
    {
      return "the model built from its bytes answers otherwise";
    }
  }
  return {};
}

std::string checkDrawing(const CADModel& model)
{
  const auto drawing = cadrefine::drawModel(model, 1e-3 * model.size());
  for (const auto& drawings : { drawing.edges, drawing.faces })
  {
    for (const cadrefine::Tessellation& one : drawings)
    {
      if (!std::all_of(one.points.begin(), one.points.end(), isFinite))
      {
        return "a drawn point is not finite";
      }
    }
  }
  return {};
}

struct Answer
{
  Ending ending = Ending::Crash;
  std::string text;
};

Answer readAndUse(const std::string& path)
{
  std::shared_ptr<const CADModel> model;
  try
  {
    model = cadrefine::readCADFile(path);
  }
  catch (const cadrefine::Error& error)
  {
    const std::string text = error.what();
    const bool clear = text.find(path + ": ") == 0 && text.find('\n') == std::string::npos;
    return { clear ? Ending::Error : Ending::Unclear, text };
  }
  try
  {
    if (!(model->size() > 0) || !std::isfinite(model->size()))
    {
      return { Ending::Useless, "its size is " + std::to_string(model->size()) };
    }
    std::string wrong = checkQueries(*model, *CADModel::fromBytes(model->toBytes()));
    wrong = wrong.empty() ? checkDrawing(*model) : wrong;
    return { wrong.empty() ? Ending::Model : Ending::Useless, wrong };
  }
  catch (const std::exception& error)
  {
    return { Ending::Useless, error.what() };
  }
}

double secondsOf(const rusage& usage)
{
  const auto seconds = [](const timeval& t)
  { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void writeAll(int descriptor, const std::string& text)
{
  for (std::size_t at = 0; at < text.size();)
  {
    const ssize_t count = write(descriptor, text.data() + at, text.size() - at);
    if (count < 0)
    {
      _exit(1);
    }
    at += static_cast<std::size_t>(count);
  }
}

/// One letter for the ending, then the text.
[[noreturn]] void runProbe(int descriptor, const std::string& path)
{
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const Answer answer = readAndUse(path);
  writeAll(descriptor, static_cast<char>('a' + static_cast<int>(answer.ending)) + answer.text);
  _exit(0);
}

/// All that comes out of `descriptor` until it is closed or the time is over; `late` tells.
std::string readUntil(int descriptor, double wallSeconds, bool& late)
{
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(wallSeconds);
  std::string text;
  for (;;)
  {
    const double left = std::chrono::duration<double>(end - Clock::now()).count();
    pollfd waiting{ descriptor, POLLIN, 0 };
    late = left <= 0 || poll(&waiting, 1, static_cast<int>(1000 * left) + 1) == 0;
    char buffer[4096];
    const ssize_t count = late ? 0 : read(descriptor, buffer, sizeof(buffer));
    if (count <= 0)
    {
      return text;
    }
    text.append(buffer, static_cast<std::size_t>(count));
  }
}

} // namespace

ReadOutcome probe(const std::string& path, double wallSeconds)
{
  const auto start = std::chrono::steady_clock::now();
  int ends[2];
  if (pipe(ends) != 0)
  {
    throw std::runtime_error("no pipe");
  }
  const pid_t child = fork();
  if (child == 0)
  {
    close(ends[0]);
    runProbe(ends[1], path);
  }
  close(ends[1]);
  bool late = false;
  const std::string answer = readUntil(ends[0], wallSeconds, late);
  close(ends[0]);
  if (late)
  {
    kill(-child, SIGKILL);
  }
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR)
  {
  }
  ReadOutcome outcome;
  outcome.wallSeconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.seconds = secondsOf(usage);
  outcome.megabytes = static_cast<double>(usage.ru_maxrss) / 1024;
  outcome.ending = late             ? Ending::TimeOut
                   : answer.empty() ? Ending::Crash
                                    : static_cast<Ending>(answer.front() - 'a');
  outcome.text = late             ? "still reading after " + std::to_string(wallSeconds) + " s"
                 : answer.empty() ? "died with status " + std::to_string(status)
                                  : answer.substr(1);
  return outcome;
}

} // namespace badcad
