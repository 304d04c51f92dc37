// The steps of reading a file, of which some can be left out. Private to geom/cad.
#pragma once

#include <cadrefine/cad/import/IsolatedRun.h>
#include <cadrefine/cad/import/OccGuard.h>

#include <map>
#include <string>
#include <vector>

namespace cadrefine
{

/// Numbers for noteStep. Attributes to Gaps are optional.
enum class ReadStep
{
  Loading, ///< What Open CASCADE's plain reader does.
  Attributes,
  Sewing,
  Healing,
  Gaps,
  Conversion, ///< Conversion of one entity to NURBS; its items are those of keepConvertible.
  Drawing,    ///< Drawing of one entity; its items are those of drawnEntities.
  Other       ///< All steps without which there is no model.
};

/// What a file is to be read without, and why: what Open CASCADE crashed on before.
struct ReadOptions
{
  std::map<ReadStep, std::string> withoutSteps;
  std::map<int, std::string> withoutConversions;
  std::map<int, std::string> withoutDrawings;
  int threads = 1; ///< Number of threads for conversions and drawings.
  /// What failed on several threads, where one thread is tried next; else empty. Where that fails
  /// as well, it is for a reason that is told; where not, this must be.
  std::string failureOnThreads;

  /// A line of this failure, or none.
  std::vector<std::string> notes() const
  {
    return this->failureOnThreads.empty()
             ? std::vector<std::string>()
             : std::vector<std::string>{ "done on one thread, because it failed on several: " +
                                         this->failureOnThreads };
  }

  /// Notes that the item is begun. On several threads at once, no place is that of a crash.
  void noteItem(ReadStep step, int item) const
  {
    noteStep(static_cast<int>(step), this->threads > 1 ? -1 : item);
  }
};

/// Runs the optional steps of one reading, and notes which of them the model does without.
class OptionalSteps
{
public:
  explicit OptionalSteps(const ReadOptions& options) : options_(options), notes_(options.notes())
  {
    for (const auto& [step, reason] : options.withoutSteps)
    {
      note(step, reason);
    }
  }

  /// Runs `work`, unless the step is left out. `work` must have changed nothing where it throws.
  template<typename Work>
  void run(ReadStep step, const Work& work)
  {
    if (options_.withoutSteps.count(step) > 0)
    {
      return;
    }
    noteStep(static_cast<int>(step));
    try
    {
      work();
    }
    catch (const Standard_Failure& failure)
    {
      note(step, describe(failure));
    }
    noteStep(static_cast<int>(ReadStep::Other));
  }

  /// One line for each step that the model does without, after those of the options.
  const std::vector<std::string>& notes() const { return notes_; }

private:
  void note(ReadStep step, const std::string& reason)
  {
    const std::string what = step == ReadStep::Attributes ? "names and colours"
                             : step == ReadStep::Sewing   ? "sewing"
                             : step == ReadStep::Healing  ? "healing"
                                                          : "a search for gaps";
    notes_.push_back("read without " + what + ": " + reason);
  }

  const ReadOptions& options_;
  std::vector<std::string> notes_;
};

} // namespace cadrefine
