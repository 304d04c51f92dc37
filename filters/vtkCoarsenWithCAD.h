/**
 * @class vtkCoarsenWithCAD
 * @brief makes the cells of a mesh larger and keeps its boundary on the CAD
 *
 * Input port 0: a mesh (see vtkMeshAlgorithm) of tetrahedra or triangles that was projected,
 * the output of vtkProjectOntoCAD or vtkRefineWithCAD. Port 1: the output of a vtkCADReader.
 *
 * Output: the mesh with fewer vertices. In a level about every second vertex along each line goes,
 * by edge collapses: a vertex on a CAD edge goes along it, one on a CAD face along the surface,
 * those on CAD vertices stay. No cell inverts, no cell gets below MinimumQuality that was not
 * before, and the boundary keeps to TargetError and MaximumDistance; with neither, it gets no
 * farther from the CAD. Boundary off the CAD keeps its shape. What belongs to vertices that go is
 * left out; ids of those that stay remain. The mesh is the same on any number of ranks.
 *
 * Cost of a level: linear in the number of cells, and projections for vertices on the CAD; the
 * cells of each block where vertices go are sent to one rank, in a few rounds.
 */
#ifndef vtkCoarsenWithCAD_h
#define vtkCoarsenWithCAD_h

#include "CADRefineFiltersModule.h"
#include "vtkMeshAlgorithm.h"

#include <string>

class CADREFINEFILTERS_EXPORT vtkCoarsenWithCAD : public vtkMeshAlgorithm
{
public:
  static vtkCoarsenWithCAD* New();
  vtkTypeMacro(vtkCoarsenWithCAD, vtkMeshAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Cell array with one component that says where cells may become larger: where its value is
   * smaller than Threshold (default 0). A vertex goes only where all of its cells may. Empty
   * (default): everywhere.
   */
  vtkSetMacro(MarkingArray, std::string);
  vtkGetMacro(MarkingArray, std::string);
  vtkSetMacro(Threshold, double);
  vtkGetMacro(Threshold, double);
  ///@}

  ///@{
  /**
   * Global geometric error (area or volume between mesh and CAD, see vtkCADGeometricError) that
   * must not be exceeded; where the mesh has more already, it gets no more. Default 0: not used.
   */
  vtkSetMacro(TargetError, double);
  vtkGetMacro(TargetError, double);
  ///@}

  ///@{
  /**
   * Largest distance of new facets from the CAD, a length, at the middles of their edges and at
   * their centroids. Default 0: not used; without TargetError they get no farther than those
   * before.
   */
  vtkSetMacro(MaximumDistance, double);
  vtkGetMacro(MaximumDistance, double);
  ///@}

  ///@{
  /**
   * How often to coarsen; cells inherit the values of MarkingArray. Each level makes edges about
   * twice as long. Default 1.
   */
  vtkSetMacro(Levels, int);
  vtkGetMacro(Levels, int);
  ///@}

protected:
  vtkCoarsenWithCAD();
  ~vtkCoarsenWithCAD() override;

  bool ChangesCells() const override { return true; }
  std::vector<std::string> GetCellArraysRead() const override;
  cadrefine::PipelineResult Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
    const cadrefine::CADModel* model) override;

private:
  vtkCoarsenWithCAD(const vtkCoarsenWithCAD&) = delete;
  void operator=(const vtkCoarsenWithCAD&) = delete;

  std::string MarkingArray;
  double Threshold = 0;
  double TargetError = 0;
  double MaximumDistance = 0;
  int Levels = 1;
};

#endif
