// What RankExchange talks through, for the sources of this folder that need MPI itself.
#pragma once

#include "RankExchange.h"

#include <vtkDIYUtilities.h>

namespace cadrefine
{

struct RankExchange::Link
{
  diy::mpi::communicator ranks;
};

} // namespace cadrefine
