#include "SamePieces.h"

#include "Partition.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointSet.h>

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace cadtest
{
namespace
{

std::map<std::string, double> fieldValues(vtkPointSet* mesh)
{
  std::map<std::string, double> values;
  vtkFieldData* fields = mesh->GetFieldData();
  for (int a = 0; a < fields->GetNumberOfArrays(); ++a)
  {
    values[fields->GetArrayName(a)] = fields->GetArray(a)->GetTuple1(0);
  }
  return values;
}

} // namespace

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
  EXPECT_EQ(fieldValues(piece), fieldValues(serial));
}

} // namespace cadtest
