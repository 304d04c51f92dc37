/**
 * @class vtkMeshReader
 * @brief reads meshes of other programs than ParaView, with their groups
 *
 * Output: the file's cells of all dimensions as one grid. Tags are cell arrays (gmsh:physical and
 * others); each name of a group is a field array of two integers, the tag and the dimension.
 *
 * The file is read by the Python package of the driver, which lies beside the library. The first
 * piece is the whole mesh, the others are empty: in parallel, the first filter that shares out
 * cells does so. A file that cannot be read is an error on all ranks, reported by rank 0, and the
 * output stays empty.
 *
 * Each time it executes it reads the file anew; call Modified (in ParaView: Reload Files) where
 * that has changed.
 */
#ifndef vtkMeshReader_h
#define vtkMeshReader_h

#include "CADRefineFiltersModule.h"
#include "vtkUnstructuredGridAlgorithm.h"

class vtkMultiProcessController;

class CADREFINEFILTERS_EXPORT vtkMeshReader : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkMeshReader* New();
  vtkTypeMacro(vtkMeshReader, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file; of an OpenFOAM case, its .foam file or its folder.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /**
   * Whether the file is of a format that is read here, by its ending and its beginning. Not
   * collective.
   */
  int CanReadFile(VTK_FILEPATH const char* file);

  ///@{
  /**
   * The ranks. Default: the global controller.
   */
  virtual void SetController(vtkMultiProcessController*);
  vtkMultiProcessController* GetController() { return this->Controller; }
  ///@}

protected:
  vtkMeshReader();
  ~vtkMeshReader() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkMeshReader(const vtkMeshReader&) = delete;
  void operator=(const vtkMeshReader&) = delete;

  char* FileName = nullptr;
  vtkMultiProcessController* Controller = nullptr;
};

#endif
