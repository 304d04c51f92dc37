/**
 * @class vtkSimplexMeshAlgorithm
 * @brief common base of the filters that work on triangles and tetrahedra
 *
 * Takes vtkUnstructuredGrid and vtkPolyData with triangles or tetrahedra, in serial or one piece on
 * each rank, and gives the same type. Cells of lower dimension (vertices, lines, triangles that
 * carry tags) are carried along; any other cell is an error that names it. Ghost cells are left
 * out. Global ids are used if every rank has them, and made from coordinates if not: pieces then
 * meet where coordinates are equal. Output points are in double precision.
 *
 * A failure on one rank is an error on all: rank 0 reports the reason, and the output stays empty.
 */
#ifndef vtkSimplexMeshAlgorithm_h
#define vtkSimplexMeshAlgorithm_h

#include "CADRefineFiltersModule.h"
#include "vtkPointSetAlgorithm.h"

#include <memory>
#include <string>

namespace cadrefine
{
class CADModel;
class RankExchange;
class RunStatistics;
struct StepContext;
} // namespace cadrefine
class vtkMultiProcessController;

class CADREFINEFILTERS_EXPORT vtkSimplexMeshAlgorithm : public vtkPointSetAlgorithm
{
public:
  vtkTypeMacro(vtkSimplexMeshAlgorithm, vtkPointSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The CAD model: the output of a vtkCADReader. For the filters that need it.
  void SetCADConnection(vtkAlgorithmOutput* cad) { this->SetInputConnection(1, cad); }

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

protected:
  /// `needsCAD`: the filter has a second input, the output of a vtkCADReader.
  explicit vtkSimplexMeshAlgorithm(bool needsCAD);
  ~vtkSimplexMeshAlgorithm() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) final;

  /**
   * The filter's work: fills `output`. Throws cadrefine::Error on all ranks alike. `model` is null
   * for filters without CAD.
   */
  virtual void Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
    const cadrefine::CADModel* model, vtkPointSet* output) = 0;

  /// What the steps of cadrefine need: warnings become those of this filter.
  cadrefine::StepContext MakeContext(
    cadrefine::RankExchange& exchange, const cadrefine::CADModel& model);

  std::unique_ptr<cadrefine::RunStatistics> Statistics; ///< Of this run, by this rank.

private:
  vtkSimplexMeshAlgorithm(const vtkSimplexMeshAlgorithm&) = delete;
  void operator=(const vtkSimplexMeshAlgorithm&) = delete;

  std::shared_ptr<const cadrefine::CADModel> FindModel(
    cadrefine::RankExchange& exchange, vtkInformationVector* input) const;

  vtkMultiProcessController* Controller = nullptr;
  std::string StatisticsText = "{}";
};

#endif
