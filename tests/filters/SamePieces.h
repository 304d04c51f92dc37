// Whether a mesh in pieces is that of one rank.
#pragma once

#include "comm/RankExchange.h"

class vtkPointSet;

namespace cadtest
{

/// On rank 0: put together, the pieces are the mesh of one rank, bit for bit, with the same field
/// data. (On other ranks `serial` is not looked at.) Collective.
void expectSame(cadrefine::RankExchange& exchange, vtkPointSet* piece, vtkPointSet* serial);

} // namespace cadtest
