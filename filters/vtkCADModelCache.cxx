#include "vtkCADModelCache.h"

#include "comm/Threads.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/model/CADModel.h>

#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkFieldData.h>
#include <vtkObjectFactory.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <list>
#include <mutex>
#include <vector>

namespace
{

using ModelPointer = std::shared_ptr<const cadrefine::CADModel>;

/// The models used last, the most recent first.
class RecentModels
{
public:
  ModelPointer Find(const unsigned char* bytes, std::size_t size, int threads)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    const auto found = std::find_if(this->Entries.begin(), this->Entries.end(),
      [&](const Entry& entry)
      {
        return entry.Bytes.size() == size && std::equal(entry.Bytes.begin(), entry.Bytes.end(),
                                               reinterpret_cast<const char*>(bytes));
      });
    if (found != this->Entries.end())
    {
      this->Entries.splice(this->Entries.begin(), this->Entries, found);
      return found->Model;
    }
    std::vector<char> copy(bytes, bytes + size);
    ModelPointer model = cadrefine::CADModel::fromBytes(copy, cadrefine::forOnThreads(threads));
    this->Entries.push_front({ std::move(copy), model });
    if (this->Entries.size() > MaximumCount)
    {
      this->Entries.pop_back();
    }
    return model;
  }

private:
  static constexpr std::size_t MaximumCount = 4;
  struct Entry
  {
    std::vector<char> Bytes;
    ModelPointer Model;
  };
  std::mutex Mutex;
  std::list<Entry> Entries;
};

vtkUnsignedCharArray* FindBytes(vtkDataObject* data)
{
  return data ? vtkUnsignedCharArray::SafeDownCast(
                  data->GetFieldData()->GetArray(vtkCADModelCache::ModelArrayName()))
              : nullptr;
}

vtkUnsignedCharArray* FindBytesInLeaves(vtkCompositeDataSet* data)
{
  vtkSmartPointer<vtkCompositeDataIterator> leaf;
  leaf.TakeReference(data->NewIterator());
  for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
  {
    if (vtkUnsignedCharArray* bytes = FindBytes(leaf->GetCurrentDataObject()))
    {
      return bytes;
    }
  }
  return nullptr;
}

} // namespace

vtkStandardNewMacro(vtkCADModelCache);

std::shared_ptr<const cadrefine::CADModel> vtkCADModelCache::Get(vtkDataObject* cad, int threads)
{
  static RecentModels recent;
  vtkUnsignedCharArray* bytes = FindBytes(cad);
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(cad); composite && !bytes)
  {
    bytes = FindBytesInLeaves(composite);
  }
  if (!bytes)
  {
    throw cadrefine::Error(
      "the CAD input holds no CAD model (field array CADModel); it must be the "
      "output of a CAD Reader");
  }
  return recent.Find(
    bytes->GetPointer(0), static_cast<std::size_t>(bytes->GetNumberOfValues()), threads);
}
