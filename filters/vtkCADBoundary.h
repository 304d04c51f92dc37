/**
 * @class vtkCADBoundary
 * @brief the boundary of a mesh as cells that know their CAD face
 *
 * Input port 0: the output of vtkProjectOntoCAD or of a filter after it. Port 1: that of a
 * vtkCADReader.
 *
 * Output: of a mesh of volume the triangles and quadrilaterals of its boundary, interior ones
 * between two materials among them if they are listed in the mesh; of a mesh of area in space all
 * of its cells; of a planar one the segments of its boundary. Cell arrays CADDimension (2, of
 * segments 1; -1 away from the CAD), CADEntity (index of the CAD face or edge; -1), CADName (of the
 * face or edge in the CAD file; empty if it has none) and CADColor (red, green, blue; white if it
 * has none). The cell arrays of the mesh are those of the cell that the facet is a side of; point
 * arrays and ids stay. Of a mesh of second order the facets have their corners alone. With Faces
 * there are the facets on these faces alone; none is an error.
 *
 * Cost: that of classifying the boundary; in the plane a projection a segment.
 */
#ifndef vtkCADBoundary_h
#define vtkCADBoundary_h

#include "CADRefineFiltersModule.h"
#include "vtkMeshAlgorithm.h"

class CADREFINEFILTERS_EXPORT vtkCADBoundary : public vtkMeshAlgorithm
{
public:
  static vtkCADBoundary* New();
  vtkTypeMacro(vtkCADBoundary, vtkMeshAlgorithm);

protected:
  vtkCADBoundary();
  ~vtkCADBoundary() override;

  bool ChangesMesh() const override { return false; }
  cadrefine::PipelineResult Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
    const cadrefine::CADModel* model) override;

private:
  vtkCADBoundary(const vtkCADBoundary&) = delete;
  void operator=(const vtkCADBoundary&) = delete;
};

#endif
