/**
 * @class vtkMeshValidity
 * @brief finds inverted and degenerate cells, and gives the quality of each
 *
 * Takes a mesh (see vtkMeshAlgorithm). Output: the mesh with the cell arrays CellValidity
 * (signed char: 1 valid, 0 inverted or degenerate) and CellQuality (of triangles and tetrahedra the
 * mean ratio: 1 is equilateral, 0 flat, negative inverted; of other cells the least scaled
 * Jacobian), and field data InvalidCells and MinimumQuality over all ranks. Tetrahedra are valid if
 * their volume is positive in VTK's order of vertices; triangles if their area is positive and, in
 * a planar mesh, they turn the way most do; both are decided exactly, whatever the rounding of
 * the mean ratio. Other cells are valid if their Jacobian is positive everywhere, by bounds. Cells
 * of lower dimension are valid with quality 1. Cost: linear in the number of cells, two reductions.
 */
#ifndef vtkMeshValidity_h
#define vtkMeshValidity_h

#include "CADRefineFiltersModule.h"
#include "vtkMeshAlgorithm.h"

class CADREFINEFILTERS_EXPORT vtkMeshValidity : public vtkMeshAlgorithm
{
public:
  static vtkMeshValidity* New();
  vtkTypeMacro(vtkMeshValidity, vtkMeshAlgorithm);

protected:
  vtkMeshValidity();
  ~vtkMeshValidity() override;

  bool ChangesMesh() const override { return false; }
  cadrefine::PipelineResult Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
    const cadrefine::CADModel* model) override;

private:
  vtkMeshValidity(const vtkMeshValidity&) = delete;
  void operator=(const vtkMeshValidity&) = delete;
};

#endif
