// Data objects as bytes, to be sent to another rank.
#pragma once

#include <cadrefine/base/Error.h>

#include <vtkCharArray.h>
#include <vtkCommunicator.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <vector>

namespace cadrefine
{

/// Throws Error where it cannot be done.
inline std::vector<char> marshal(vtkDataObject* data)
{
  vtkNew<vtkCharArray> bytes;
  if (!vtkCommunicator::MarshalDataObject(data, bytes))
  {
    throw Error("a part of the mesh cannot be sent to another rank");
  }
  return { bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues() };
}

/// Throws Error where the bytes are none of such an object.
template<class Object>
vtkSmartPointer<Object> unmarshal(const std::vector<char>& bytes)
{
  vtkNew<vtkCharArray> array;
  array->SetNumberOfValues(static_cast<vtkIdType>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), array->GetPointer(0));
  const auto data = vtkCommunicator::UnMarshalDataObject(array);
  vtkSmartPointer<Object> object = Object::SafeDownCast(data);
  if (!object)
  {
    throw Error("a part of the mesh from another rank cannot be read");
  }
  return object;
}

} // namespace cadrefine
