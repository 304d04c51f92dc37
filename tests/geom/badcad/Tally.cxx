#include "Tally.h"

#include <algorithm>
#include <cstdio>

namespace badcad
{

void Tally::add(const ReadOutcome& outcome)
{
  ++inputs;
  models += outcome.ending == Ending::Model ? 1 : 0;
  errors += outcome.ending == Ending::Error ? 1 : 0;
  childCrashes += outcome.hadCrash() ? 1 : 0;
  childTimeOuts += outcome.hadTimeOut() ? 1 : 0;
  childMemory += outcome.hadNoMemory() ? 1 : 0;
  bad += outcome.isGood() ? 0 : 1;
  megabytes = std::max(megabytes, outcome.megabytes);
  seconds = std::max(seconds, outcome.seconds);
}

void Tally::print(const std::string& name) const
{
  std::printf("| %s | %d | %d | %d | %d | %d | %d | %d | %.0f | %.1f |\n", name.c_str(), inputs,
    models, errors, childCrashes, childTimeOuts, childMemory, bad, megabytes, seconds);
}

void Tally::printHeading()
{
  std::printf("| Files | Inputs | Models | Errors | of them crashes in the child | time-outs in "
              "the child | out of memory in the child | Bad endings | Most memory (MiB) | Slowest "
              "(s of computing) |\n|---|---|---|---|---|---|---|---|---|---|\n");
}

} // namespace badcad
