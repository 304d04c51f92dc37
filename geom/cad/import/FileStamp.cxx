#include <cadrefine/cad/import/FileStamp.h>

#include <sstream>
#include <sys/stat.h>

namespace cadrefine
{

std::string fileStamp(const std::string& path)
{
  struct stat facts = {};
  if (stat(path.c_str(), &facts) != 0)
  {
    return "none";
  }
  std::ostringstream stamp;
  stamp << facts.st_dev << ' ' << facts.st_ino << ' ' << facts.st_size << ' '
        << facts.st_mtim.tv_sec << ' ' << facts.st_mtim.tv_nsec << ' ' << facts.st_ctim.tv_sec
        << ' ' << facts.st_ctim.tv_nsec;
  return stamp.str();
}

} // namespace cadrefine
