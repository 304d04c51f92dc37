/**
 * @class vtkMeshAlgorithm
 * @brief common base of the filters that work on meshes
 *
 * Takes vtkUnstructuredGrid and vtkPolyData with linear cells of area (triangles, quadrilaterals)
 * or volume (tetrahedra, pyramids, wedges, hexahedra), in serial or one piece on each rank, and
 * gives the same type. Cells of lower dimension, which carry tags, are carried along; any other
 * cell is an error that names it. Ghost cells are left out. Global ids are used if every rank has
 * them, and made from coordinates if not: pieces then meet where coordinates are equal. Output
 * points are in double precision.
 *
 * Of a time series, the step that is asked for is worked on. Where only fields have changed since
 * the last run, the geometry is not worked on again: what was made of it is kept, and the fields
 * are taken along. Points, cells, ids, ghosts, the arrays of the classification, arrays that mark
 * cells, the CAD model and the properties are compared, by content; if any of them has changed on
 * any rank, all is done anew. The output then has the same points and cells as before, also by
 * GetMeshMTime. One mesh is kept, shared with the output while this is there; warnings are given
 * once for it.
 *
 * Long work tells its progress with a text (GetProgressText, vtkCommand::ProgressEvent), on each
 * rank, a few times a second.
 *
 * A failure on one rank is an error on all: rank 0 reports the reason, and the output stays empty.
 * So is a property that is out of its range, which the error names with the range.
 */
#ifndef vtkMeshAlgorithm_h
#define vtkMeshAlgorithm_h

#include "CADRefineFiltersModule.h"
#include "vtkPointSetAlgorithm.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cadrefine
{
class FieldMapping;
struct FieldNeeds;
class CADModel;
class GeometryCache;
class RankExchange;
class RunStatistics;
struct ArraySelection;
struct MeshState;
struct PipelineContext;
struct PipelineResult;
} // namespace cadrefine
class vtkMultiProcessController;
class vtkTable;

class CADREFINEFILTERS_EXPORT vtkMeshAlgorithm : public vtkPointSetAlgorithm
{
public:
  vtkTypeMacro(vtkMeshAlgorithm, vtkPointSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The CAD model: the output of a vtkCADReader. For the filters that need it. Not set: that of
  /// the nearest filter above in the pipeline that has one, onto which the mesh was projected.
  void SetCADConnection(vtkAlgorithmOutput* cad) { this->SetInputConnection(1, cad); }

  ///@{
  /**
   * Of the filters that have a CAD: the CAD faces (of a planar mesh, CAD edges) that they work on,
   * none: all. Each is a name in the CAD file, a pattern of names as in a shell, or a number; "!"
   * before it takes them away; "=" and a length after it is their chord tolerance (see
   * vtkRefinementAlgorithm). What a filter does elsewhere, it says itself.
   */
  void AddFace(const char* face);
  void ClearFaces();
  const std::vector<std::string>& GetFaces() const { return this->Faces; }
  ///@}

  ///@{
  /**
   * Of the filters that put out the mesh and have a CAD: whether its boundary goes with it as cells
   * of one dimension less, after those that it has. Cell arrays CADDimension, CADEntity, CADName
   * and CADColor then tell the CAD face (in the plane, the edge) of each; other cell arrays are 0
   * on cells that are added. See vtkCADBoundary for the boundary alone. Default off.
   */
  vtkSetMacro(BoundaryCells, bool);
  vtkGetMacro(BoundaryCells, bool);
  vtkBooleanMacro(BoundaryCells, bool);
  ///@}

  enum LocalOperations
  {
    ALL_OPERATIONS = 0,
    CUT_ONLY = 1 ///< Cells are cut and vertices moved, but no edge or face is swapped or collapsed.
  };

  ///@{
  /**
   * What filters that change cells do where vertices do not reach the CAD or cells are badly
   * shaped: ALL_OPERATIONS (default) swaps, collapses and splits edges there.
   */
  vtkSetMacro(Operations, int);
  vtkGetMacro(Operations, int);
  ///@}

  ///@{
  /**
   * Cells of a smaller mean ratio (1 is equilateral) are improved by these operations, also those
   * of the input; new cells below 0.3, too, by swaps and moves alone. 0: none for their shape.
   * Default 0.1.
   */
  vtkSetMacro(MinimumQuality, double);
  vtkGetMacro(MinimumQuality, double);
  ///@}

  ///@{
  /**
   * Of filters that change cells: cell arrays of floating point that are densities, per volume (of
   * triangles per area): whatever becomes of cells of the mesh's own dimension, the integral of
   * each over the mesh stays, to the precision of its values. Others are means by overlap where
   * cells are exchanged, and stay where vertices move. Default: none.
   */
  void AddConservedArray(const char* name);
  void ClearConservedArrays();
  const std::vector<std::string>& GetConservedArrays() const { return this->ConservedArrays; }
  ///@}

  ///@{
  /**
   * Ranks that hold the pieces of the mesh. Default: the global controller.
   */
  virtual void SetController(vtkMultiProcessController*);
  vtkMultiProcessController* GetController() { return this->Controller; }
  ///@}

  /**
   * What the last run cost, as a JSON object of numbers by name: seconds (of the slowest rank),
   * bytes sent, how evenly work lay on the ranks. The same on all ranks.
   */
  const char* GetRunStatistics() { return this->StatisticsText.c_str(); }

  /**
   * Of a filter that projects: how mesh and CAD fit together, as lines of text, the same on every
   * rank. The numbers are field arrays of the output. Empty before the first run, and of a run that
   * failed.
   */
  const char* GetFitReport() { return this->FitReport.c_str(); }

protected:
  /// `needsCAD`: the filter has a second input, the output of a vtkCADReader.
  explicit vtkMeshAlgorithm(bool needsCAD);
  ~vtkMeshAlgorithm() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) final;

  /**
   * The filter's work, a function of its arguments and of the properties (what changes GetMTime).
   * Of the arrays of the data set, `geometry` has those alone that the work depends on: ids,
   * ghosts, the classification and the cell arrays of GetCellArraysRead; no field data. Throws
   * cadrefine::Error on all ranks alike. `model` is null for filters without CAD.
   */
  virtual cadrefine::PipelineResult Execute(
    cadrefine::RankExchange& exchange, vtkPointSet* geometry, const cadrefine::CADModel* model) = 0;

  /// Names of the cell arrays that Execute reads. Default: none.
  virtual std::vector<std::string> GetCellArraysRead() const { return {}; }

  /// Whether points move or cells are cut, so that what was measured before does not hold any more
  /// and is not carried along. Default: yes.
  virtual bool ChangesMesh() const { return true; }

  /// Puts the mesh of a step on the way, made from the geometry by `mapping`, into the output while
  /// Execute is at work, with the fields and the table of the steps up to there; FitReport becomes
  /// that of the step. Each mapping goes on where the one before ended; `selection` leads from its
  /// end to the mesh. Collective.
  void ShowStep(cadrefine::RankExchange& exchange, vtkPointSet* mesh,
    const cadrefine::FieldMapping& mapping, const cadrefine::ArraySelection& selection,
    vtkTable* table, const std::string& fitReport);

  /// Whether the filter may exchange cells: whole numbers of cells are then tags, which keep them
  /// apart.
  virtual bool ChangesCells() const { return false; }

  /// MinimumQuality of a filter that may exchange cells; none with CUT_ONLY. Throws Error where
  /// these are out of range.
  std::optional<double> FindMinimumQuality() const;

  /// What the fields of this run need of their mapping, with ConservedArrays.
  cadrefine::FieldNeeds FindFieldNeeds() const;

  /// What the steps of cadrefine need: warnings become those of this filter.
  cadrefine::PipelineContext MakeContext(
    cadrefine::RankExchange& exchange, const cadrefine::CADModel& model);

  /// The output of a run that ends with this mesh: with its boundary's cells if they are wanted.
  /// Collective.
  cadrefine::PipelineResult MakeResult(
    const cadrefine::PipelineContext& context, cadrefine::MeshState state) const;

  std::unique_ptr<cadrefine::RunStatistics> Statistics; ///< Statistics of this run, by this rank.

private:
  vtkMeshAlgorithm(const vtkMeshAlgorithm&) = delete;
  void operator=(const vtkMeshAlgorithm&) = delete;

  std::shared_ptr<const cadrefine::CADModel> FindModel(cadrefine::RankExchange& exchange);

  /// Makes the output, with the kept result if it can.
  void Run(cadrefine::RankExchange& exchange, vtkInformationVector** inputs,
    vtkInformationVector* outputs);

  /// The outputs of a run, as they are filled.
  struct Outputs;
  void Fill(cadrefine::RankExchange& exchange, vtkPointSet* mesh,
    const cadrefine::FieldMapping& mapping, const cadrefine::ArraySelection& selection,
    vtkTable* table, const std::string& fitReport);

  std::unique_ptr<cadrefine::GeometryCache> Cache;
  Outputs* Filled = nullptr; ///< The outputs while a run is at work, else null.
  vtkMultiProcessController* Controller = nullptr;
  std::vector<std::string> Faces;
  std::vector<std::string> ConservedArrays;
  bool HasMeans = true; ///< See FieldNeeds.
  bool BoundaryCells = false;
  int Operations = ALL_OPERATIONS;
  double MinimumQuality = 0.1;
  std::string StatisticsText = "{}";
  std::string FitReport;
};

#endif
