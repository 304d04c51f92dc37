// The program that reads CAD files, with the faults of the program that starts it.

#include "InjectedFault.h"

#include <cadrefine/cad/import/ReadJobs.h>

int main(int argc, char** argv)
{
  const cadrefine::RunJobs jobs = cadrefine::readJobs();
  cadtest::InjectedFault::join(reinterpret_cast<const void*>(&cadrefine::serveRun));
  return cadrefine::serveRun(argc, argv, jobs);
}
