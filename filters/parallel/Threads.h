// Threads for the loops of a filter.
#pragma once

#include "RankExchange.h"

#include <cstddef>
#include <functional>

namespace cadrefine
{

/// The threads that this rank may use: the cores that it is bound to, shared with the other ranks
/// that are bound to the same ones, at least one; VTK_SMP_MAX_THREADS is an upper limit. 0 stands
/// for "as vtkSMPTools is set up", where someone chose a backend by VTK_SMP_BACKEND_IN_USE or
/// vtkSMPTools::SetBackend. ParaView's default backend is Sequential, which would leave all cores
/// but one idle. Collective; one number is gathered from every rank.
int findThreads(RankExchange& exchange);

/// Calls body(begin, end) for ranges that together are [0, count), on `threads` threads (see
/// findThreads). What the calls do must not depend on each other. An exception of one call is
/// thrown when all have ended.
void forRanges(int threads, std::size_t count,
  const std::function<void(std::size_t begin, std::size_t end)>& body);

} // namespace cadrefine
