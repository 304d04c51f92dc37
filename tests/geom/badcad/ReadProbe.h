// Reads a file as a user would, in a process of its own, and tells how that ended.
#pragma once

#include <string>

namespace badcad
{

enum class Ending
{
  Model,   ///< Read, and usable.
  Error,   ///< One clear line that names the file.
  Unclear, ///< An error without the file's name, or of several lines.
  Useless, ///< A model was read, but cannot be used; `text` tells why.
  Crash,   ///< The reading process itself died, not only its child.
  TimeOut
};

struct ReadOutcome
{
  Ending ending = Ending::Crash;
  std::string text; ///< The error, or what is wrong with the model.
  /// Seconds of computing, and MiB of memory at most, of the process that reads and of its child.
  double seconds = 0;
  double megabytes = 0;
  double wallSeconds = 0;

  bool isGood() const { return ending == Ending::Model || ending == Ending::Error; }
  /// Whether Open CASCADE crashed, ran out of time or ran out of memory in the child.
  bool hadCrash() const { return text.find("crashes on it") != std::string::npos; }
  bool hadTimeOut() const { return text.find("did not finish within") != std::string::npos; }
  bool hadNoMemory() const { return text.find("memory") != std::string::npos; }
};

/// Reads `path` with readCADFile; where that gives a model, builds it again from its bytes, asks
/// for nearest points, which must be finite and the same from both, and tessellates each entity.
/// All of that is killed after `wallSeconds`.
ReadOutcome probe(const std::string& path, double wallSeconds);

} // namespace badcad
