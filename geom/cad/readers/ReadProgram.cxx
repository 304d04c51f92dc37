// The program cadrefine-read-cad: Open CASCADE crashes on some files, or never ends, and ParaView
// must not.

#include <cadrefine/cad/import/ReadJobs.h>

int main(int argc, char** argv)
{
  return cadrefine::serveRun(argc, argv, cadrefine::readJobs());
}
