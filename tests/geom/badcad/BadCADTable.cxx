// Reads many damaged files, and prints what became of them:
//   badcad_table corpus [TEXT]     the files made by programs (BadFiles.h); of these kinds whose
//                                  name holds TEXT
//   badcad_table COUNT SEED FILE... COUNT mutations of each file, the first with seed SEED
// A row of the table for each kind or file; before it a line for each outcome that is bad or dear.
// Exits with 1 where any outcome is bad.

#include "BadFiles.h"
#include "Mutation.h"
#include "ReadProbe.h"
#include "Tally.h"
#include "TestFiles.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>

namespace
{

using badcad::BadFile;
using badcad::Ending;
using badcad::Tally;

const char* nameOf(Ending ending)
{
  const char* const names[] = { "model", "error", "unclear error", "useless model",
    "crash of the reader", "time-out" };
  return names[static_cast<int>(ending)];
}

/// Reads files as `make` gives them, until that gives one without a name.
Tally readAll(const std::string& name, const std::function<BadFile(int)>& make)
{
  constexpr double wallSeconds = 3600; // the machine may be busy; computing is what counts
  constexpr double dearSeconds = 10;
  constexpr double dearMegabytes = 1024;
  const cadtest::TemporaryFolder folder;
  Tally tally;
  for (int i = 0;; ++i)
  {
    const BadFile file = make(i);
    if (file.name.empty())
    {
      break;
    }
    const badcad::ReadOutcome outcome =
      badcad::probe(folder.write("case" + file.extension, file.text), wallSeconds);
    tally.add(outcome);
    if (!outcome.isGood() || outcome.hadCrash() || outcome.seconds > dearSeconds ||
        outcome.megabytes > dearMegabytes)
    {
      std::fprintf(stderr, "%s (%s): %s, %.1f s, %.0f MiB: %s\n", file.name.c_str(), name.c_str(),
        nameOf(outcome.ending), outcome.seconds, outcome.megabytes, outcome.text.c_str());
    }
  }
  tally.print(name);
  std::fflush(stdout);
  return tally;
}

std::vector<BadFile> mutationsOf(const BadFile& sound, int count)
{
  std::vector<BadFile> files;
  for (int seed = 1; seed <= count; ++seed)
  {
    files.push_back({ "seed " + std::to_string(seed), sound.extension,
      badcad::mutate(sound.text, static_cast<std::uint64_t>(seed)) });
  }
  return files;
}

int readCorpus(const std::string& wanted)
{
  const std::vector<std::pair<const char*, std::vector<BadFile>>> all{ { "IGES, made by programs",
                                                                         badcad::badIgesFiles() },
    { "STEP, made by programs", badcad::badStepFiles() },
    { "BREP, made by programs", badcad::badBrepFiles() },
    { "splines in STEP and BREP", badcad::badSplineFiles() },
    { "bad shapes in each format", badcad::badShapes() },
    { "random bytes", badcad::garbageFiles() },
    { "STEP, cut off in each line", badcad::cutFiles(badcad::soundStep().text, ".step") },
    { "BREP in binary, cut off", badcad::cutAnywhere(badcad::soundBinaryBrep(), 200) },
    { "BREP in binary, mutations", mutationsOf(badcad::soundBinaryBrep(), 200) },
    { "files that take long", badcad::dearFiles() } };
  int bad = 0;
  for (const auto& [name, files] : all)
  {
    if (std::string(name).find(wanted) == std::string::npos)
    {
      continue;
    }
    const auto& list = files;
    bad += readAll(name,
      [&](int i) {
        return i < static_cast<int>(list.size()) ? list[static_cast<std::size_t>(i)] : BadFile();
      }).bad;
  }
  return bad;
}

int readMutations(const std::string& path, int inputs, int seed)
{
  std::ifstream file(path, std::ios::binary);
  const std::string text{ std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
  const std::filesystem::path name(path);
  return readAll(name.filename().string(),
    [&](int i)
    {
      return i >= inputs ? BadFile()
                         : BadFile{ "seed " + std::to_string(seed + i), name.extension().string(),
                             badcad::mutate(text, static_cast<std::uint64_t>(seed) + i) };
    })
    .bad;
}

} // namespace

int main(int argc, char** argv)
{
  const bool corpus = argc >= 2 && argc <= 3 && std::string(argv[1]) == "corpus";
  if (!corpus && argc < 4)
  {
    std::fprintf(stderr, "usage: badcad_table corpus [TEXT] | COUNT SEED FILE...\n");
    return 2;
  }
  badcad::Tally::printHeading();
  int bad = corpus ? readCorpus(argc == 3 ? argv[2] : "") : 0;
  for (int i = 3; i < argc; ++i)
  {
    bad += readMutations(argv[i], std::atoi(argv[1]), std::atoi(argv[2]));
  }
  return bad == 0 ? 0 : 1;
}
