#include "SamePieces.h"

#include "DataSets.h"
#include "Partition.h"

#include <vtkPointSet.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace cadtest
{

void expectSame(cadrefine::RankExchange& exchange, vtkPointSet* piece, vtkPointSet* serial)
{
  const CanonicalMesh mesh = gather(exchange, piece);
  if (exchange.rank() > 0)
  {
    return;
  }
  cadrefine::RankExchange alone(nullptr);
  const CanonicalMesh expected = gather(alone, serial);
  EXPECT_EQ(mesh.contradictions, 0);
  EXPECT_TRUE(mesh.points == expected.points);
  EXPECT_TRUE(mesh.cells == expected.cells);
  EXPECT_EQ(mesh.points.size(), static_cast<std::size_t>(serial->GetNumberOfPoints()));
  EXPECT_EQ(differentFields(piece, serial), std::vector<std::string>());
}

} // namespace cadtest
