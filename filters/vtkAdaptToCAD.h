/**
 * @class vtkAdaptToCAD
 * @brief projects a mesh onto the CAD, and refines it until it follows the CAD
 *
 * Input port 0: a mesh (see vtkMeshAlgorithm). Port 1: the output of a vtkCADReader.
 *
 * Projects the mesh once (see vtkProjectOntoCAD), unless StartProjected is on; then repeats:
 * measure the geometric error (see vtkCADGeometricError), mark cells, refine them (see
 * vtkRefineWithCAD), until MaximumSteps, MaximumCells or TargetError is reached or no cell is
 * marked. Cells are marked by their geometric error, by a solver's indicator, by their chord error
 * and by the angle between facets; any of them is enough. The cells that a step would make are
 * counted before any is cut. With observers of StepEvent on any rank, the event is invoked after
 * each step, on all ranks alike (while they are in it, they may communicate): the outputs then hold
 * the mesh and the table up to this step, which are made for that; GetStepStatistics and
 * GetFitReport tell of it. An observer wants memory for a mesh more. Where the mesh of the last run
 * is kept (see vtkMeshAlgorithm), no step is made, and there is no event. An adaptation that
 * is aborted (AbortExecute on any rank, looked at between steps) keeps its last whole step, and is
 * not repeated until the filter is modified. A run resets AbortExecute when it starts.
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

#include <vtkCommand.h>

#include <string>

class CADREFINEFILTERS_EXPORT vtkAdaptToCAD : public vtkRefinementAlgorithm
{
public:
  static vtkAdaptToCAD* New();
  vtkTypeMacro(vtkAdaptToCAD, vtkRefinementAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Geometric error in marking: as a MarkingStrategy, not at all, or AUTOMATIC.
  enum
  {
    OFF = BULK + 1,
    AUTOMATIC
  };

  /// The event that is invoked after each step; see above.
  enum
  {
    StepEvent = vtkCommand::UserEvent + 1
  };

  /**
   * Of the step that was made last and that observers were told of, a JSON object: "step", its
   * number from 0; "kind": "projection", "input" (of a mesh that was projected already), "uniform",
   * "longest-edge" or "quadratic"; "seconds" of this rank and "costs" (as GetRunStatistics, of all
   * ranks) of its phases "project", "refine" and "error". "{}" without observers.
   */
  const char* GetStepStatistics() { return this->StepStatistics.c_str(); }

  ///@{
  /**
   * Whether the input has its places on the CAD (the point arrays that vtkProjectOntoCAD gives it),
   * and keeps them: it is not projected. Default off.
   */
  vtkSetMacro(StartProjected, bool);
  vtkGetMacro(StartProjected, bool);
  vtkBooleanMacro(StartProjected, bool);
  ///@}

  ///@{
  /**
   * See vtkProjectOntoCAD; without effect where StartProjected is on.
   */
  vtkSetMacro(UseRegion, bool);
  vtkGetMacro(UseRegion, bool);
  vtkBooleanMacro(UseRegion, bool);
  vtkSetVector6Macro(Region, double);
  vtkGetVector6Macro(Region, double);
  vtkSetMacro(MaximumDistance, double);
  vtkGetMacro(MaximumDistance, double);
  ///@}

  ///@{
  /**
   * See vtkCADGeometricError. Default 0: automatic.
   */
  vtkSetMacro(RecursionDepth, int);
  vtkGetMacro(RecursionDepth, int);
  ///@}

  ///@{
  /**
   * How many times to refine uniformly first, whatever the Method. Default 0.
   */
  vtkSetMacro(UniformSteps, int);
  vtkGetMacro(UniformSteps, int);
  ///@}

  ///@{
  /**
   * How many times to refine at most after that, by the Method. Default 5.
   */
  vtkSetMacro(MaximumSteps, int);
  vtkGetMacro(MaximumSteps, int);
  ///@}

  ///@{
  /**
   * A step that would make more cells of the mesh's own dimension, on all ranks together, is not
   * made. Default 10,000,000; 0: no limit.
   */
  vtkSetMacro(MaximumCells, vtkIdType);
  vtkGetMacro(MaximumCells, vtkIdType);
  ///@}

  ///@{
  /**
   * Global geometric error at which to stop. Default 0: not used.
   */
  vtkSetMacro(TargetError, double);
  vtkGetMacro(TargetError, double);
  ///@}

  ///@{
  /**
   * Above 0: after each step by LONGEST_EDGE_BISECTION vertices are taken out (see
   * vtkCoarsenWithCAD) all of whose cells have values below this part of the smallest that each
   * criterion marks. The boundary keeps to TargetError, or, where that is 0, gets no farther from
   * the CAD; and TargetError does not end the adaptation before its first step. In [0, 1]; not with
   * CUT_ONLY. Default 0: no coarsening.
   */
  vtkSetMacro(CoarseningFraction, double);
  vtkGetMacro(CoarseningFraction, double);
  ///@}

  ///@{
  /**
   * Whether in the end the cells become quadratic, in a step of its own; see vtkRefineWithCAD.
   * Default off.
   */
  vtkSetMacro(QuadraticCells, bool);
  vtkGetMacro(QuadraticCells, bool);
  vtkBooleanMacro(QuadraticCells, bool);
  ///@}

  ///@{
  /**
   * How cells are marked by their geometric error: a MarkingStrategy with ErrorThreshold (default
   * 0) or ErrorFraction (default 0.5, above 0 and at most 1); OFF (all cells are marked where there
   * is no other criterion either); or AUTOMATIC (default): THRESHOLD where ErrorThreshold is above
   * 0, otherwise BULK.
   */
  vtkSetMacro(ErrorMarking, int);
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
  /// Only the array of the indicator: the others are measured here.
  std::vector<std::string> GetCellArraysRead() const override;
  cadrefine::PipelineResult Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
    const cadrefine::CADModel* model) override;

private:
  vtkAdaptToCAD(const vtkAdaptToCAD&) = delete;
  void operator=(const vtkAdaptToCAD&) = delete;

  double FindCoarseningFraction() const;

  std::string StepStatistics = "{}";
  bool StartProjected = false;
  bool UseRegion = false;
  double Region[6] = { 0, 1, 0, 1, 0, 1 };
  double MaximumDistance = 0;
  int RecursionDepth = 0;
  int UniformSteps = 0;
  int MaximumSteps = 5;
  vtkIdType MaximumCells = 10000000;
  double TargetError = 0;
  double CoarseningFraction = 0;
  bool QuadraticCells = false;
  int ErrorMarking = AUTOMATIC;
  double ErrorThreshold = 0;
  double ErrorFraction = 0.5;
};

#endif
