/**
 * @class vtkRefineWithCAD
 * @brief refines a mesh and puts every new boundary vertex onto the CAD
 *
 * Input port 0: a mesh (see vtkMeshAlgorithm); with ProjectNewVertices on, the output of
 * vtkProjectOntoCAD or of this filter. Port 1: the output of a vtkCADReader.
 *
 * Output: the refined mesh. Point arrays are interpolated, cell arrays inherited, global ids of new
 * vertices and cells made by rules that do not depend on the partition: the mesh is the same on any
 * number of ranks. No vertex hangs, also across ranks. A new vertex on a classified boundary edge
 * is projected onto that edge's own CAD entity, as far as no cell inverts.
 *
 * Cost of a level: linear in the number of cells; one parallel sort of the new vertices and one of
 * the cells; for longest edge bisection one exchange of marks for every time that they cross
 * between ranks; one projection for each new vertex on the CAD.
 */
#ifndef vtkRefineWithCAD_h
#define vtkRefineWithCAD_h

#include "CADRefineFiltersModule.h"
#include "vtkRefinementAlgorithm.h"

#include <string>

class CADREFINEFILTERS_EXPORT vtkRefineWithCAD : public vtkRefinementAlgorithm
{
public:
  static vtkRefineWithCAD* New();
  vtkTypeMacro(vtkRefineWithCAD, vtkRefinementAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * How often to refine. Children inherit the values of the arrays that mark cells. 0: not at all,
   * so that QuadraticCells alone has its effect. Default 1.
   */
  vtkSetMacro(Levels, int);
  vtkGetMacro(Levels, int);
  ///@}

  ///@{
  /**
   * Cell array with one component that marks cells, for LONGEST_EDGE_BISECTION: by Marking (default
   * THRESHOLD) and Threshold (default 0) or Fraction (default 0.5, above 0 and at most 1; of values
   * that are not negative). Empty (default): all cells, unless another criterion is set.
   */
  vtkSetMacro(MarkingArray, std::string);
  vtkGetMacro(MarkingArray, std::string);
  vtkSetMacro(Marking, int);
  vtkGetMacro(Marking, int);
  vtkSetMacro(Threshold, double);
  vtkGetMacro(Threshold, double);
  vtkSetMacro(Fraction, double);
  vtkGetMacro(Fraction, double);
  ///@}

  ///@{
  /**
   * Whether the cells of the output are of second order: VTK_QUADRATIC_TETRA, ..., whose mid nodes
   * are put onto the CAD like new vertices, as far as all cells stay valid by Bezier bounds of
   * their Jacobian; those of pyramids stay in the middle. Only for vtkUnstructuredGrid; no filter
   * here refines such a mesh further. Default off.
   */
  vtkSetMacro(QuadraticCells, bool);
  vtkGetMacro(QuadraticCells, bool);
  vtkBooleanMacro(QuadraticCells, bool);
  ///@}

protected:
  vtkRefineWithCAD();
  ~vtkRefineWithCAD() override;

  cadrefine::MarkingCriterion GetOwnCriterion() const override;
  cadrefine::PipelineResult Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
    const cadrefine::CADModel* model) override;

private:
  vtkRefineWithCAD(const vtkRefineWithCAD&) = delete;
  void operator=(const vtkRefineWithCAD&) = delete;

  int Levels = 1;
  std::string MarkingArray;
  int Marking = THRESHOLD;
  double Threshold = 0;
  double Fraction = 0.5;
  bool QuadraticCells = false;
};

#endif
