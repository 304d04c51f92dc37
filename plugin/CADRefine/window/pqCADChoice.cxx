#include "pqCADChoice.h"

#include <pqApplicationCore.h>
#include <pqOutputPort.h>
#include <pqPipelineFilter.h>
#include <pqServerManagerModel.h>
#include <vtkDataObject.h>
#include <vtkPVDataInformation.h>
#include <vtkSMInputProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <string>

namespace
{

struct Output
{
  vtkSMProxy* source = nullptr;
  unsigned int port = 0;
};

Output inputOf(vtkSMProxy* filter, const char* property)
{
  if (!vtkSMInputProperty::SafeDownCast(filter->GetProperty(property)))
  {
    return {};
  }
  const vtkSMPropertyHelper input(filter, property);
  return { input.GetAsProxy(), input.GetOutputPort() };
}

/// The CAD of the nearest filter above that has one.
Output findCADAbove(vtkSMProxy* filter)
{
  Output cad;
  for (vtkSMProxy* above = inputOf(filter, "Input").source; above && !cad.source;
       above = inputOf(above, "Input").source)
  {
    cad = inputOf(above, "CAD");
  }
  return cad;
}

/// Whether the source is a CAD Reader, which may not have read yet, or reads a saved CAD.
bool isCAD(pqPipelineSource* source)
{
  return !qobject_cast<pqPipelineFilter*>(source) &&
         (std::string(source->getProxy()->GetXMLName()) == "CADReader" ||
           source->getOutputPort(0)->getDataInformation()->GetArrayInformation(
             "CADModel", vtkDataObject::FIELD));
}

Output findOnlyCAD(pqServer* server)
{
  Output only;
  const auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>(server))
  {
    if (isCAD(source))
    {
      if (only.source)
      {
        return {};
      }
      only.source = source->getProxy();
    }
  }
  return only;
}

} // namespace

pqCADChoice::pqCADChoice(QObject* parent) : QObject(parent) {}

void pqCADChoice::startup()
{
  // Before it is selected: the Pipeline Browser loses the selection of what it moves.
  connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::sourceAdded, this, &pqCADChoice::onAdded);
}

void pqCADChoice::shutdown()
{
  disconnect(pqApplicationCore::instance()->getServerManagerModel(), nullptr, this, nullptr);
}

void pqCADChoice::onAdded(pqPipelineSource* filter)
{
  vtkSMProxy* proxy = filter->getProxy();
  auto* property = vtkSMInputProperty::SafeDownCast(proxy->GetProperty("CAD"));
  if (!property || property->GetNumberOfProxies() > 0 ||
      pqApplicationCore::instance()->isLoadingState())
  {
    return;
  }
  Output cad = findCADAbove(proxy);
  if (!cad.source)
  {
    cad = findOnlyCAD(filter->getServer());
  }
  if (cad.source)
  {
    property->SetInputConnection(0, cad.source, cad.port);
    proxy->UpdateVTKObjects();
  }
}
