/**
 * @class vtkCADReader
 * @brief reads IGES, STEP and BREP files
 *
 * Output: a vtkPartitionedDataSetCollection of the partitioned data sets Faces, Edges and Vertices
 * (poly data to look at, with the cell arrays CADDimension and CADEntity, each rank its share;
 * empty without Drawing), with the exact model as field data (see vtkCADModelCache), which every
 * rank holds. Where the file has them, names and colours of faces and edges are the cell arrays
 * Name and Color.
 *
 * Field arrays tell of the file: CADCounts, the numbers of vertices, edges and faces; CADUnit, the
 * unit of length; CADUnread, what could not be read; CADLeftOut, what by the rules of the format is
 * no part of the model; CADRepairs, what was wrong with it and could be repaired, or left out for
 * that, a line each; CADSewingTolerance; CADGaps, the gaps that are wider: width, place, and the
 * two edges beside it; CADTrimDeviation, how far trim curves lie off their edges; CADInexact, a
 * line where that is above 1e-4 of the model's size, or where surfaces that had to be fitted are
 * off by more than 1e-7 of it.
 *
 * Each time it executes it reads the file anew. In a single process it also executes where the file
 * has changed on the disk since it was read last (its time, its size, or another file of that
 * name), as an update finds out. On several ranks an update cannot find out, since all ranks or
 * none must execute, and updates are theirs: call Modified on all of them, which in ParaView is
 * Reload Files.
 *
 * Rank 0 alone reads the file and broadcasts the model. A file that cannot be read is an error on
 * all ranks, reported by rank 0; what could not be read, repairs and gaps give a warning.
 */
#ifndef vtkCADReader_h
#define vtkCADReader_h

#include "CADRefineFiltersModule.h"
#include "vtkPartitionedDataSetCollectionAlgorithm.h"

#include <memory>
#include <string>
#include <vector>

namespace cadrefine
{
class CADModel;
class RankExchange;
struct ModelDrawing;
} // namespace cadrefine
class vtkMultiProcessController;

class CADREFINEFILTERS_EXPORT vtkCADReader : public vtkPartitionedDataSetCollectionAlgorithm
{
public:
  static vtkCADReader* New();
  vtkTypeMacro(vtkCADReader, vtkPartitionedDataSetCollectionAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file: .igs, .iges, .stp, .step or .brep.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * The unit of length that coordinates are to have: "m", "cm", "mm", "in" or "ft". The model is
   * converted from the file's unit to this one, and CADUnit names it. Empty, or "File's own"
   * (default): coordinates are the file's own numbers.
   */
  vtkSetStringMacro(Unit);
  vtkGetStringMacro(Unit);
  ///@}

  ///@{
  /**
   * Whether there are faces, edges and vertices to look at. Filters need none of them: without, the
   * file is read in half the time. Default on.
   */
  vtkSetMacro(Drawing, bool);
  vtkGetMacro(Drawing, bool);
  vtkBooleanMacro(Drawing, bool);
  ///@}

  ///@{
  /**
   * How far the drawing may lie off the model, as a part of the model's size. Default 0.001.
   */
  vtkSetClampMacro(TessellationTolerance, double, 1e-6, 0.1);
  vtkGetMacro(TessellationTolerance, double);
  ///@}

  ///@{
  /**
   * The ranks. Default: the global controller.
   */
  virtual void SetController(vtkMultiProcessController*);
  vtkMultiProcessController* GetController() { return this->Controller; }
  ///@}

protected:
  vtkCADReader();
  ~vtkCADReader() override;

  /// Looks whether the file has changed.
  int ComputePipelineMTime(vtkInformation* request, vtkInformationVector** inputs,
    vtkInformationVector* outputs, int port, vtkMTimeType* time) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkCADReader(const vtkCADReader&) = delete;
  void operator=(const vtkCADReader&) = delete;

  void Read(cadrefine::RankExchange& exchange, vtkPartitionedDataSetCollection* output);
  std::shared_ptr<const cadrefine::CADModel> ReadModel(
    cadrefine::RankExchange& exchange, int threads, vtkPartitionedDataSetCollection* output);
  cadrefine::ModelDrawing Draw(
    cadrefine::RankExchange& exchange, int threads, const cadrefine::CADModel& model);
  void Say(double progress, const std::string& text);
  void Warn(const cadrefine::CADModel& model, const std::vector<std::string>& repairs);

  char* FileName = nullptr;
  char* Unit = nullptr;
  bool Drawing = true;
  double TessellationTolerance = 0.001;
  /// Stamp of the file when it was read last, in a single process; empty: never.
  std::string StampRead;
  vtkMultiProcessController* Controller = nullptr;
};

#endif
