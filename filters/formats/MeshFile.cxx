#ifdef CADREFINE_WITH_PYTHON
#include <vtkPython.h> // before all others, as Python wants it
#endif

#include "formats/MeshFile.h"

#include <cadrefine/base/CodeFolder.h>
#include <cadrefine/base/Error.h>

#include <vtkUnstructuredGrid.h>

#ifdef CADREFINE_WITH_PYTHON
#include <vtkPythonInterpreter.h>
#include <vtkPythonUtil.h>
#include <vtkSmartPyObject.h>

#include <filesystem>
#endif

namespace cadrefine
{

#ifdef CADREFINE_WITH_PYTHON

namespace
{

/// The folder with the package: build and installation both have it beside the library.
std::filesystem::path packageFolder()
{
  const auto own = folderOfCode(reinterpret_cast<const void*>(&packageFolder));
  std::error_code error;
  return std::filesystem::canonical(own / "cadrefine" / "python", error);
}

std::string textOf(PyObject* object)
{
  vtkSmartPyObject text;
  text.TakeReference(object ? PyObject_Str(object) : nullptr);
  vtkSmartPyObject bytes;
  bytes.TakeReference(text ? PyUnicode_EncodeFSDefault(text) : nullptr);
  PyErr_Clear();
  return bytes ? PyBytes_AsString(bytes) : "";
}

/// The reason of what Python raised last, which is then forgotten.
std::string raisedReason()
{
  PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  PyErr_NormalizeException(&type, &value, &trace);
  const std::string reason = textOf(value);
  Py_XDECREF(type);
  Py_XDECREF(value);
  Py_XDECREF(trace);
  return reason.empty() ? "Python gives no reason" : reason;
}

/// A new reference that Python gave. Throws Error where it raised instead.
vtkSmartPyObject given(PyObject* object)
{
  if (!object)
  {
    throw Error(raisedReason());
  }
  vtkSmartPyObject result;
  result.TakeReference(object);
  return result;
}

vtkSmartPyObject pathObject(const std::filesystem::path& path)
{
  return given(PyUnicode_DecodeFSDefault(path.c_str()));
}

void appendOnce(PyObject* list, const std::filesystem::path& path)
{
  const vtkSmartPyObject item = pathObject(path);
  if (PySequence_Contains(list, item) == 0)
  {
    PyList_Append(list, item);
  }
}

/// The package's module that reads and writes. The package becomes a part of the one of VTK's
/// classes, which has the same name, so that a program can use both.
vtkSmartPyObject filesModule()
{
  const std::filesystem::path folder = packageFolder();
  appendOnce(PySys_GetObject("path"), folder);
  const vtkSmartPyObject package = given(PyImport_ImportModule("cadrefine"));
  const vtkSmartPyObject places = given(PyObject_GetAttrString(package, "__path__"));
  appendOnce(places, folder / "cadrefine");
  return given(PyImport_ImportModule("cadrefine.files"));
}

/// The module of filesModule(), for the file `path`, which an Error names.
vtkSmartPyObject filesModule(const std::string& path)
{
  try
  {
    return filesModule();
  }
  catch (const Error& error)
  {
    throw Error(path + ": the Python package that reads and writes the format cannot be loaded: " +
                error.what());
  }
}

/// Starts Python where it does not run yet, without its answers to signals, and holds its lock.
class RunningPython
{
public:
  RunningPython() : started_(vtkPythonInterpreter::Initialize(0)) {}

private:
  bool started_; // before the lock
  vtkPythonScopeGilEnsurer lock_;
};

void throwReason(PyObject* result)
{
  const std::string reason = textOf(result);
  if (!reason.empty())
  {
    throw Error(reason);
  }
}

} // namespace

bool canReadMeshFile(const std::string& path)
{
  const RunningPython python;
  const vtkSmartPyObject module = filesModule(path);
  const vtkSmartPyObject file = pathObject(path);
  const vtkSmartPyObject result =
    given(PyObject_CallMethod(module, "can_read", "O", file.GetPointer()));
  return PyObject_IsTrue(result) == 1;
}

void readMeshFile(const std::string& path, vtkUnstructuredGrid* grid)
{
  const RunningPython python;
  const vtkSmartPyObject module = filesModule(path);
  const vtkSmartPyObject file = pathObject(path);
  const vtkSmartPyObject output = given(vtkPythonUtil::GetObjectFromPointer(grid));
  throwReason(
    given(PyObject_CallMethod(module, "read", "OO", file.GetPointer(), output.GetPointer())));
}

void writeMeshFile(
  vtkUnstructuredGrid* grid, const std::string& path, const std::string& version, bool ascii)
{
  const RunningPython python;
  const vtkSmartPyObject module = filesModule(path);
  const vtkSmartPyObject file = pathObject(path);
  const vtkSmartPyObject input = given(vtkPythonUtil::GetObjectFromPointer(grid));
  throwReason(given(PyObject_CallMethod(module, "write", "OOsi", input.GetPointer(),
    file.GetPointer(), version.c_str(), static_cast<int>(ascii))));
}

#else

namespace
{

[[noreturn]] void throwWithoutPython(const std::string& path)
{
  throw Error(path + ": this ParaView was built without Python, which is needed for this format");
}

} // namespace

bool canReadMeshFile(const std::string&)
{
  return true;
}

void readMeshFile(const std::string& path, vtkUnstructuredGrid*)
{
  throwWithoutPython(path);
}

void writeMeshFile(vtkUnstructuredGrid*, const std::string& path, const std::string&, bool)
{
  throwWithoutPython(path);
}

#endif

} // namespace cadrefine
