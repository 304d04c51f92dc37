/**
 * @class vtkAdaptToCAD
 * @brief projects a mesh onto the CAD, and refines it until it follows the CAD
 *
 * Input port 0: a mesh (see vtkSimplexMeshAlgorithm). Port 1: the output of a vtkCADReader.
 *
 * Projects the mesh once (see vtkProjectOntoCAD), then repeats: measure the geometric error (see
 * vtkCADGeometricError), mark cells, refine them (see vtkRefineWithCAD), until MaximumSteps,
 * MaximumCells or TargetError is reached or no cell is marked. Cells are marked by their geometric
 * error, by a solver's indicator, by their chord error and by the angle between facets; any of them
 * is enough. An adaptation that is aborted (AbortExecute on any rank, looked at between steps)
 * keeps its last whole step, and is not repeated until the filter is modified. A run resets
 * AbortExecute when it starts.
 *
 * Output port 0: the mesh of the last step, with its error. Port 1: a table with a row for each
 * step, on rank 0: Step, MarkedCells, and the field data of the mesh by their names; its field
 * array StopReason says why it ended.
 *
 * Cost: that of the filters above, a step after the other; memory that of two steps.
 */
#ifndef vtkAdaptToCAD_h
#define vtkAdaptToCAD_h

#include "CADRefineFiltersModule.h"
#include "vtkRefinementAlgorithm.h"

class CADREFINEFILTERS_EXPORT vtkAdaptToCAD : public vtkRefinementAlgorithm
{
public:
  static vtkAdaptToCAD* New();
  vtkTypeMacro(vtkAdaptToCAD, vtkRefinementAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Geometric error in marking: as a MarkingStrategy, or not at all.
  enum
  {
    OFF = BULK + 1
  };

  ///@{
  /**
   * See vtkProjectOntoCAD.
   */
  vtkSetMacro(UseRegion, bool);
  vtkGetMacro(UseRegion, bool);
  vtkBooleanMacro(UseRegion, bool);
  vtkSetVector6Macro(Region, double);
  vtkGetVector6Macro(Region, double);
  vtkSetClampMacro(MaximumDistance, double, 0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumDistance, double);
  ///@}

  ///@{
  /**
   * See vtkCADGeometricError.
   */
  vtkSetClampMacro(RecursionDepth, int, 1, 8);
  vtkGetMacro(RecursionDepth, int);
  ///@}

  ///@{
  /**
   * How many times to refine at most. Default 5.
   */
  vtkSetClampMacro(MaximumSteps, int, 0, VTK_INT_MAX);
  vtkGetMacro(MaximumSteps, int);
  ///@}

  ///@{
  /**
   * A step that would make more cells of the mesh's own dimension, on all ranks together, is not
   * made. Default 10,000,000; 0: no limit.
   */
  vtkSetClampMacro(MaximumCells, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(MaximumCells, vtkIdType);
  ///@}

  ///@{
  /**
   * Global geometric error at which to stop. Default 0: not used.
   */
  vtkSetClampMacro(TargetError, double, 0, VTK_DOUBLE_MAX);
  vtkGetMacro(TargetError, double);
  ///@}

  ///@{
  /**
   * How cells are marked by their geometric error: a MarkingStrategy (default THRESHOLD) with
   * ErrorThreshold (default 0) or ErrorFraction (default 0.5, above 0 and at most 1); or OFF (all
   * cells are marked where there is no other criterion either).
   */
  vtkSetClampMacro(ErrorMarking, int, THRESHOLD, OFF);
  vtkGetMacro(ErrorMarking, int);
  vtkSetMacro(ErrorThreshold, double);
  vtkGetMacro(ErrorThreshold, double);
  vtkSetMacro(ErrorFraction, double);
  vtkGetMacro(ErrorFraction, double);
  ///@}

protected:
  vtkAdaptToCAD();
  ~vtkAdaptToCAD() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  cadrefine::MarkingCriterion GetOwnCriterion() const override;
  cadrefine::StepResult Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
    const cadrefine::CADModel* model) override;

private:
  vtkAdaptToCAD(const vtkAdaptToCAD&) = delete;
  void operator=(const vtkAdaptToCAD&) = delete;

  bool UseRegion = false;
  double Region[6] = { 0, 1, 0, 1, 0, 1 };
  double MaximumDistance = 0;
  int RecursionDepth = 1;
  int MaximumSteps = 5;
  vtkIdType MaximumCells = 10000000;
  double TargetError = 0;
  int ErrorMarking = THRESHOLD;
  double ErrorThreshold = 0;
  double ErrorFraction = 0.5;
};

#endif
