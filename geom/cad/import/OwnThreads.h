// Threads that belong to no pool. Private to geom/cad.
#pragma once

#include <cadrefine/base/ParallelFor.h>

namespace cadrefine
{

/// Loops on so many threads, which are started for each loop. All calls are made; where some throw,
/// the exception of the lowest range is thrown when all have ended.
ParallelFor forOnOwnThreads(int threads);

} // namespace cadrefine
