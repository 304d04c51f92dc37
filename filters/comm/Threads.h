// Threads for the loops of a filter.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/base/ParallelFor.h>

namespace cadrefine
{

/// The threads that this rank may use: as many as the cores that the calling thread is bound to,
/// shared with the other ranks that are bound to exactly the same ones (not with those that have
/// some of them), at least one; VTK_SMP_MAX_THREADS is an upper limit. 0 stands for "as vtkSMPTools
/// is set up", where someone chose a backend by VTK_SMP_BACKEND_IN_USE or vtkSMPTools::SetBackend.
/// ParaView's default backend is Sequential, which would leave all cores but one idle. Collective;
/// one number is gathered from every rank.
int findThreads(RankExchange& exchange);

/// Loops on so many threads (see findThreads). All calls are made; where some throw, the exception
/// of the lowest range is thrown when all have ended.
ParallelFor forOnThreads(int threads);

/// Loops on this rank's threads. Collective like findThreads.
ParallelFor forOnThreads(RankExchange& exchange);

} // namespace cadrefine
