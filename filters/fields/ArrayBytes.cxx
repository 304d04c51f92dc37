#include "fields/ArrayBytes.h"

#include "fields/ArrayTransfer.h"

#include <cadrefine/base/Error.h>

#include <vtkCharArray.h>
#include <vtkCommunicator.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkNew.h>
#include <vtkTable.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

namespace cadrefine
{
namespace
{

class Writer
{
public:
  void number(std::int64_t value) { raw(&value, sizeof(value)); }
  /// Appends a text; null is kept apart from an empty one.
  void text(const char* value)
  {
    number(value ? static_cast<std::int64_t>(std::strlen(value)) : -1);
    raw(value, value ? std::strlen(value) : 0);
  }
  void raw(const void* data, std::size_t size)
  {
    const char* first = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  /// Makes room for so many bytes more, to be written to.
  char* room(std::size_t size)
  {
    bytes_.resize(bytes_.size() + size);
    return bytes_.data() + bytes_.size() - size;
  }
  std::vector<char> result() { return std::move(bytes_); }

private:
  std::vector<char> bytes_;
};

class Reader
{
public:
  explicit Reader(const std::vector<char>& bytes) : bytes_(bytes) {}

  std::int64_t number()
  {
    std::int64_t value;
    std::memcpy(&value, take(sizeof(value)), sizeof(value));
    return value;
  }
  /// Calls use with the text; not at all where it is null.
  template<class Use>
  void text(const Use& use)
  {
    const std::int64_t size = number();
    if (size >= 0)
    {
      const char* first = take(static_cast<std::size_t>(size));
      use(std::string(first, first + size).c_str());
    }
  }
  const char* take(std::size_t size)
  {
    if (size > bytes_.size() - place_)
    {
      throw Error("arrays from another rank cannot be read");
    }
    place_ += size;
    return bytes_.data() + place_ - size;
  }
  std::vector<char> rest() const
  {
    return { bytes_.begin() + static_cast<std::ptrdiff_t>(place_), bytes_.end() };
  }

private:
  const std::vector<char>& bytes_;
  std::size_t place_ = 0;
};

std::size_t sizeOfValues(vtkDataArray* array)
{
  const auto count = static_cast<std::size_t>(array->GetNumberOfValues());
  return array->GetDataType() == VTK_BIT ? (count + 7) / 8 : count * array->GetDataTypeSize();
}

void write(vtkDataArray* array, int attribute, Writer& writer)
{
  writer.number(array->GetDataType());
  writer.number(array->GetNumberOfComponents());
  writer.number(array->GetNumberOfTuples());
  writer.number(attribute);
  writer.text(array->GetName());
  for (int k = 0; k < array->GetNumberOfComponents(); ++k)
  {
    writer.text(array->GetComponentName(k));
  }
  const std::size_t size = sizeOfValues(array);
  if (array->HasStandardMemoryLayout() || array->GetDataType() == VTK_BIT)
  {
    writer.raw(array->GetVoidPointer(0), size);
  }
  else
  {
    array->ExportToVoidPointer(writer.room(size));
  }
}

void read(Reader& reader, vtkDataSetAttributes* attributes)
{
  const auto type = static_cast<int>(reader.number());
  const auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  array->SetNumberOfComponents(static_cast<int>(reader.number()));
  array->SetNumberOfTuples(reader.number());
  const auto attribute = static_cast<int>(reader.number());
  reader.text([&](const char* name) { array->SetName(name); });
  for (int k = 0; k < array->GetNumberOfComponents(); ++k)
  {
    reader.text([&](const char* name) { array->SetComponentName(k, name); });
  }
  const std::size_t size = sizeOfValues(array);
  const char* values = reader.take(size);
  if (size > 0)
  {
    std::memcpy(array->GetVoidPointer(0), values, size);
  }
  addAs(attribute, array, attributes);
}

/// The data object as bytes. Throws Error where it cannot be sent.
std::vector<char> marshal(vtkDataObject* data)
{
  vtkNew<vtkCharArray> bytes;
  if (!vtkCommunicator::MarshalDataObject(data, bytes))
  {
    throw Error("arrays cannot be sent to another rank");
  }
  return { bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues() };
}

/// The table of these bytes. Throws Error where they are no table.
vtkSmartPointer<vtkTable> unmarshal(const std::vector<char>& bytes)
{
  vtkNew<vtkCharArray> array;
  array->SetNumberOfValues(static_cast<vtkIdType>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), array->GetPointer(0));
  const auto data = vtkCommunicator::UnMarshalDataObject(array);
  vtkSmartPointer<vtkTable> table = vtkTable::SafeDownCast(data);
  if (!table)
  {
    throw Error("arrays from another rank cannot be read");
  }
  return table;
}

} // namespace

std::vector<char> bytesOf(vtkDataSetAttributes* attributes)
{
  std::vector<int> ofNumbers;
  vtkNew<vtkTable> others;
  for (int a = 0; a < attributes->GetNumberOfArrays(); ++a)
  {
    if (attributes->GetArray(a))
    {
      ofNumbers.push_back(a);
    }
    else
    {
      others->AddColumn(attributes->GetAbstractArray(a));
    }
  }
  Writer writer;
  writer.number(static_cast<std::int64_t>(ofNumbers.size()));
  for (const int a : ofNumbers)
  {
    write(attributes->GetArray(a), attributes->IsArrayAnAttribute(a), writer);
  }
  if (others->GetNumberOfColumns() > 0)
  {
    const std::vector<char> rest = marshal(others);
    writer.raw(rest.data(), rest.size());
  }
  return writer.result();
}

vtkSmartPointer<vtkTable> arraysOf(const std::vector<char>& bytes)
{
  Reader reader(bytes);
  auto table = vtkSmartPointer<vtkTable>::New();
  for (std::int64_t left = reader.number(); left > 0; --left)
  {
    read(reader, table->GetRowData());
  }
  const std::vector<char> rest = reader.rest();
  if (!rest.empty())
  {
    const auto others = unmarshal(rest);
    for (vtkIdType c = 0; c < others->GetNumberOfColumns(); ++c)
    {
      addAs(-1, others->GetColumn(c), table->GetRowData());
    }
  }
  return table;
}

} // namespace cadrefine
