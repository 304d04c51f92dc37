/**
 * @class vtkMeshWriter
 * @brief writes meshes for other programs than ParaView, with their groups
 *
 * Input: vtkUnstructuredGrid or vtkPolyData, on each rank its piece. The pieces are gathered on
 * rank 0, which writes through the Python package of the driver: groups are those of the first
 * array of tags (gmsh:physical and others) with the names that field arrays of two integers give,
 * and, of cells with CADEntity that have no tag, those of their CAD faces.
 *
 * The file gets its place when it is complete. What fails is an error on all ranks, reported by
 * rank 0: what was there before stays, and nothing is beside it.
 */
#ifndef vtkMeshWriter_h
#define vtkMeshWriter_h

#include "CADRefineFiltersModule.h"
#include "vtkWriter.h"

class vtkMultiProcessController;

class CADREFINEFILTERS_EXPORT vtkMeshWriter : public vtkWriter
{
public:
  static vtkMeshWriter* New();
  vtkTypeMacro(vtkMeshWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file, whose ending tells the format.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Version of a .msh file: "2.2" (default), which all programs know that take .msh, or "4.1".
   */
  vtkSetStringMacro(MshVersion);
  vtkGetStringMacro(MshVersion);
  ///@}

  ///@{
  /**
   * Whether a .msh file is text and not binary. Default off.
   */
  vtkSetMacro(Ascii, bool);
  vtkGetMacro(Ascii, bool);
  vtkBooleanMacro(Ascii, bool);
  ///@}

  ///@{
  /**
   * The ranks. Default: the global controller.
   */
  virtual void SetController(vtkMultiProcessController*);
  vtkMultiProcessController* GetController() { return this->Controller; }
  ///@}

protected:
  vtkMeshWriter();
  ~vtkMeshWriter() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  /// Asks each rank for its piece.
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  void WriteData() override;

private:
  vtkMeshWriter(const vtkMeshWriter&) = delete;
  void operator=(const vtkMeshWriter&) = delete;

  char* FileName = nullptr;
  char* MshVersion = nullptr;
  bool Ascii = false;
  vtkMultiProcessController* Controller = nullptr;
};

#endif
