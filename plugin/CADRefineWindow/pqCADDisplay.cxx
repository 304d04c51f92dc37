#include "pqCADDisplay.h"

#include <pqApplicationCore.h>
#include <pqRepresentation.h>
#include <pqServerManagerModel.h>
#include <vtkPVDataInformation.h>
#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>

#include <string>
#include <vector>

namespace
{

/// Colour of a block of the collection, which then stands for its scalars.
void setBlockColours(vtkSMProxy* display, const std::vector<std::string>& blocks)
{
  std::vector<std::string> values;
  for (const std::string& block : blocks)
  {
    values.insert(values.end(), { "/Root/" + block, "0.15", "0.15", "0.2" });
  }
  vtkSMPropertyHelper helper(display, "BlockColors", /*quiet*/ true);
  for (unsigned int i = 0; i < values.size(); ++i)
  {
    helper.Set(i, values[i].c_str());
  }
}

} // namespace

pqCADDisplay::pqCADDisplay(QObject* parent) : QObject(parent) {}

void pqCADDisplay::startup()
{
  connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::representationAdded, this, &pqCADDisplay::onAdded);
}

void pqCADDisplay::shutdown()
{
  disconnect(pqApplicationCore::instance()->getServerManagerModel(), nullptr, this, nullptr);
}

void pqCADDisplay::onAdded(pqRepresentation* added)
{
  vtkSMProxy* display = added->getProxy();
  const vtkSMPropertyHelper input(display, "Input", /*quiet*/ true);
  auto* source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  if (!source || std::string(source->GetXMLName()) != "CADReader" ||
      pqApplicationCore::instance()->isLoadingState())
  {
    return;
  }
  vtkPVDataInformation* data = source->GetDataInformation(input.GetOutputPort());
  if (data->GetArrayInformation("Normals", vtkDataObject::POINT)) // of models with faces
  {
    setBlockColours(display, { "Edges", "Vertices" });
  }
  auto* coloured = vtkSMPVRepresentationProxy::SafeDownCast(display);
  if (coloured && data->GetArrayInformation("Color", vtkDataObject::CELL))
  {
    coloured->SetScalarColoring("Color", vtkDataObject::CELL);
    vtkSMPropertyHelper(display, "MapScalars", /*quiet*/ true).Set(0);
  }
  display->UpdateVTKObjects();
}
