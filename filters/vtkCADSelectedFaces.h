/**
 * @class vtkCADSelectedFaces
 * @brief the entries of the property Faces for what is selected in a view
 *
 * Input port 0, repeatable: what was extracted by selections, of a CAD drawn by a vtkCADReader or
 * of a mesh that knows its CAD: data sets, or composites of them. Port 1: the output of that
 * vtkCADReader. Port 2: the mesh that a filter is to work on.
 *
 * The faces are those of the selected cells (cell arrays CADDimension and CADEntity); where these
 * are none of any face, those that the selected points lie inside (point arrays of the same names).
 * For a planar mesh, edges take the place of faces. Output: a table with the column Faces, on rank
 * 0 a row each in the order of their numbers: the name, or the number where the name would not do
 * (see vtkMeshAlgorithm::AddFace).
 *
 * Cost: a look at each selected cell, and at the points if need be; the numbers go to rank 0.
 */
#ifndef vtkCADSelectedFaces_h
#define vtkCADSelectedFaces_h

#include "CADRefineFiltersModule.h"
#include "vtkTableAlgorithm.h"

#include <string>
#include <vector>

namespace cadrefine
{
class RankExchange;
}
class vtkMultiProcessController;

class CADREFINEFILTERS_EXPORT vtkCADSelectedFaces : public vtkTableAlgorithm
{
public:
  static vtkCADSelectedFaces* New();
  vtkTypeMacro(vtkCADSelectedFaces, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The column Faces as lines of text, on rank 0.
   */
  const char* GetFaces() { return this->Faces.c_str(); }

  /**
   * Of what is looked for: 2, faces, or 1, edges.
   */
  vtkGetMacro(Dimension, int);

  ///@{
  /**
   * The ranks. Default: the global controller.
   */
  virtual void SetController(vtkMultiProcessController*);
  vtkMultiProcessController* GetController() { return this->Controller; }
  ///@}

protected:
  vtkCADSelectedFaces();
  ~vtkCADSelectedFaces() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkCADSelectedFaces(const vtkCADSelectedFaces&) = delete;
  void operator=(const vtkCADSelectedFaces&) = delete;

  std::vector<std::string> Find(cadrefine::RankExchange& exchange, vtkInformationVector** inputs);

  std::string Faces;
  int Dimension = 2;
  vtkMultiProcessController* Controller = nullptr;
};

#endif
