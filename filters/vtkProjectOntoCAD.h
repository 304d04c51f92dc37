/**
 * @class vtkProjectOntoCAD
 * @brief moves the boundary vertices of a mesh onto the CAD
 *
 * Input port 0: a mesh (see vtkMeshAlgorithm), or a data set with vertices or points only,
 * of which every point is projected. Port 1: the output of a vtkCADReader.
 *
 * Output: the mesh with its boundary vertices in the region on the nearest point of the trimmed CAD
 * model, and the point arrays CADDimension, CADEntity, CADParameters and CADDistance. Facets whose
 * normal does not fit the CAD (walls that meet it) stay. Vertices go to CAD edges that mesh edges
 * run along, and CAD vertices to one vertex each (see projectBoundary). A vertex that would invert
 * a cell stops on the way; CADDistance tells how far it still is, and field data
 * UnprojectedVertices how many there are. The point array CADConflict is 1 where the entity could
 * not be decided; ClassificationConflicts counts these.
 *
 * A mesh of triangles is compared with CAD edges if it lies in a coordinate plane, or in one plane
 * with the whole model, or the model has no faces; otherwise with CAD faces.
 *
 * Cost: one query of the whole model (some microseconds) for each boundary vertex, and about as
 * many for facets; messages in proportion to the interface between pieces.
 */
#ifndef vtkProjectOntoCAD_h
#define vtkProjectOntoCAD_h

#include "CADRefineFiltersModule.h"
#include "vtkMeshAlgorithm.h"

class CADREFINEFILTERS_EXPORT vtkProjectOntoCAD : public vtkMeshAlgorithm
{
public:
  static vtkProjectOntoCAD* New();
  vtkTypeMacro(vtkProjectOntoCAD, vtkMeshAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether only vertices inside Region are projected. Default off.
   */
  vtkSetMacro(UseRegion, bool);
  vtkGetMacro(UseRegion, bool);
  vtkBooleanMacro(UseRegion, bool);
  ///@}

  ///@{
  /**
   * Box xmin, xmax, ymin, ymax, zmin, zmax in the unit of the mesh; used if UseRegion is on.
   * Default: the unit cube.
   */
  vtkSetVector6Macro(Region, double);
  vtkGetVector6Macro(Region, double);
  ///@}

  ///@{
  /**
   * Vertices farther from the CAD stay, a length. Default 0: for each vertex its longest boundary
   * edge (points alone: no limit).
   */
  vtkSetMacro(MaximumDistance, double);
  vtkGetMacro(MaximumDistance, double);
  ///@}

protected:
  vtkProjectOntoCAD();
  ~vtkProjectOntoCAD() override;

  cadrefine::PipelineResult Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
    const cadrefine::CADModel* model) override;
  bool ChangesCells() const override { return true; }

private:
  vtkProjectOntoCAD(const vtkProjectOntoCAD&) = delete;
  void operator=(const vtkProjectOntoCAD&) = delete;

  bool UseRegion = false;
  double Region[6] = { 0, 1, 0, 1, 0, 1 };
  double MaximumDistance = 0;
};

#endif
