#include "pqCADChoice.h"

#include "pqPipelineCAD.h"

#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <vtkSMInputProperty.h>
#include <vtkSMProxy.h>

namespace
{

pqPipelineCAD findOnlyCAD(pqServer* server)
{
  pqPipelineCAD only;
  const auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>(server))
  {
    if (pqPipelineCAD::isCAD(source))
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
  pqPipelineCAD cad = pqPipelineCAD::findFor(proxy);
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
