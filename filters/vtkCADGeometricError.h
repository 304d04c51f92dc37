/**
 * @class vtkCADGeometricError
 * @brief area or volume between the boundary of a mesh and the CAD
 *
 * Input port 0: the output of vtkProjectOntoCAD, vtkRefineWithCAD, vtkCoarsenWithCAD or
 * vtkAdaptToCAD. Port 1: that of a vtkCADReader.
 *
 * Output: the mesh with cell arrays of what its facets on the CAD miss, 0 for cells without any:
 * GeometricError (area in 2D, volume in 3D, in powers of the mesh's unit of length),
 * GeometricDistance (length: largest distance found from the facets to the CAD; vertices that have
 * not reached the CAD count with their CADDistance), ChordError (length: largest distance from the
 * middle of a facet's edge, or of a quadrilateral, to the CAD) and NormalAngle (degrees: largest
 * angle between neighbouring facets, across no crease). Field data over all ranks, the same for
 * any partition: GlobalGeometricError (the sum, no facet twice), GeometricErrorDimension (2: an
 * area, 3: a volume), MaximumGeometricDistance, MaximumChordError and MaximumNormalAngle.
 *
 * Cost: for each facet on the CAD 3 (1 + 4 + ... + 4^(depth - 1)) projections in 3D, and
 * 1 + 2 + ... + 2^(depth - 1) in 2D.
 */
#ifndef vtkCADGeometricError_h
#define vtkCADGeometricError_h

#include "CADRefineFiltersModule.h"
#include "vtkMeshAlgorithm.h"

class CADREFINEFILTERS_EXPORT vtkCADGeometricError : public vtkMeshAlgorithm
{
public:
  static vtkCADGeometricError* New();
  vtkTypeMacro(vtkCADGeometricError, vtkMeshAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * How often facets are split to follow the CAD, 1 to 8. Default 1, the published estimate, which
   * is 3/4 of the exact measure on smooth CAD. 0: automatic, a depth of 2, extrapolated to the
   * limit of all depths (a third of what the last level added is added once more).
   */
  vtkSetMacro(RecursionDepth, int);
  vtkGetMacro(RecursionDepth, int);
  ///@}

protected:
  vtkCADGeometricError();
  ~vtkCADGeometricError() override;

  bool ChangesMesh() const override { return false; }
  cadrefine::PipelineResult Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
    const cadrefine::CADModel* model) override;

private:
  vtkCADGeometricError(const vtkCADGeometricError&) = delete;
  void operator=(const vtkCADGeometricError&) = delete;

  int RecursionDepth = 1;
};

#endif
