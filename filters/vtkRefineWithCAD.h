/**
 * @class vtkRefineWithCAD
 * @brief refines a mesh and puts every new boundary vertex onto the CAD
 *
 * Input port 0: a mesh (see vtkSimplexMeshAlgorithm); with ProjectNewVertices on, the output of
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
#include "vtkSimplexMeshAlgorithm.h"

#include <string>

class CADREFINEFILTERS_EXPORT vtkRefineWithCAD : public vtkSimplexMeshAlgorithm
{
public:
  static vtkRefineWithCAD* New();
  vtkTypeMacro(vtkRefineWithCAD, vtkSimplexMeshAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum RefinementMethod
  {
    LONGEST_EDGE_BISECTION = 0,
    UNIFORM_BISECTION = 1
  };

  ///@{
  /**
   * LONGEST_EDGE_BISECTION (default) of the marked cells, or UNIFORM_BISECTION: 4 triangles, 8
   * tetrahedra for each marked or unmarked cell.
   */
  vtkSetClampMacro(Method, int, LONGEST_EDGE_BISECTION, UNIFORM_BISECTION);
  vtkGetMacro(Method, int);
  ///@}

  ///@{
  /**
   * How often to refine, at least 1. Children inherit the value of the marking array. Default 1.
   */
  vtkSetClampMacro(Levels, int, 1, 20);
  vtkGetMacro(Levels, int);
  ///@}

  ///@{
  /**
   * Cell array with one component that marks cells whose value is larger than Threshold (default
   * 0). Empty (default): all cells. Only for LONGEST_EDGE_BISECTION.
   */
  vtkSetMacro(MarkingArray, std::string);
  vtkGetMacro(MarkingArray, std::string);
  vtkSetMacro(Threshold, double);
  vtkGetMacro(Threshold, double);
  ///@}

  ///@{
  /**
   * Whether new boundary vertices are put onto the CAD; off: they stay in the middle of their edge
   * (classified, with their CADDistance, if the mesh was projected). Default on.
   */
  vtkSetMacro(ProjectNewVertices, bool);
  vtkGetMacro(ProjectNewVertices, bool);
  vtkBooleanMacro(ProjectNewVertices, bool);
  ///@}

  ///@{
  /**
   * Whether the cells are first redistributed over the ranks, by the number of cells that the first
   * level will make of them. Default on.
   */
  vtkSetMacro(Balance, bool);
  vtkGetMacro(Balance, bool);
  vtkBooleanMacro(Balance, bool);
  ///@}

protected:
  vtkRefineWithCAD();
  ~vtkRefineWithCAD() override;

  void Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
    const cadrefine::CADModel* model, vtkPointSet* output) override;

private:
  vtkRefineWithCAD(const vtkRefineWithCAD&) = delete;
  void operator=(const vtkRefineWithCAD&) = delete;

  int Method = LONGEST_EDGE_BISECTION;
  int Levels = 1;
  std::string MarkingArray;
  double Threshold = 0;
  bool ProjectNewVertices = true;
  bool Balance = true;
};

#endif
