/**
 * @class vtkCADModelCache
 * @brief the CAD model that travels in a pipeline as field data
 *
 * vtkCADReader attaches the exact model, as bytes, to its output. Filters get it back with Get,
 * which rebuilds it once in a process for each content: the most recently used models are kept.
 */
#ifndef vtkCADModelCache_h
#define vtkCADModelCache_h

#include "CADRefineFiltersModule.h"
#include "vtkObject.h"

#include <memory>

namespace cadrefine
{
class CADModel;
}
class vtkDataObject;

class CADREFINEFILTERS_EXPORT vtkCADModelCache : public vtkObject
{
public:
  static vtkCADModelCache* New();
  vtkTypeMacro(vtkCADModelCache, vtkObject);

  /// Name of the unsigned char field array that holds the model.
  static const char* ModelArrayName() { return "CADModel"; }

  /**
   * The model in the field data of `cad`, or of any data set in it. Safe from several threads.
   * Cost: a comparison of the bytes if the model is known, else rebuilding it (about as long as
   * reading a BREP file of that size), on so many threads (see findThreads). Throws
   * cadrefine::Error where there is no model.
   */
  static std::shared_ptr<const cadrefine::CADModel> Get(vtkDataObject* cad, int threads = 1);

protected:
  vtkCADModelCache() = default;
  ~vtkCADModelCache() override = default;

private:
  vtkCADModelCache(const vtkCADModelCache&) = delete;
  void operator=(const vtkCADModelCache&) = delete;
};

#endif
