#include "pqPipelineCAD.h"

#include <pqApplicationCore.h>
#include <pqOutputPort.h>
#include <pqPipelineFilter.h>
#include <pqServerManagerModel.h>
#include <vtkDataObject.h>
#include <vtkPVDataInformation.h>
#include <vtkSMInputProperty.h>
#include <vtkSMProxy.h>

#include <string>

pqPipelineCAD pqPipelineCAD::inputOf(vtkSMProxy* filter, const char* property)
{
  auto* input = vtkSMInputProperty::SafeDownCast(filter->GetProperty(property));
  if (!input || input->GetNumberOfUncheckedProxies() == 0)
  {
    return {};
  }
  return { input->GetUncheckedProxy(0), input->GetUncheckedOutputPortForConnection(0) };
}

pqPipelineCAD pqPipelineCAD::findFor(vtkSMProxy* filter)
{
  pqPipelineCAD cad;
  for (vtkSMProxy* above = filter; above && !cad.source; above = inputOf(above, "Input").source)
  {
    cad = inputOf(above, "CAD");
  }
  return cad;
}

pqPipelineCAD pqPipelineCAD::findBehind(pqPipelineSource* source)
{
  const pqPipelineCAD cad = findFor(source->getProxy());
  if (cad.source)
  {
    return cad;
  }
  pqPipelineCAD first{ source->getProxy(), 0 };
  for (pqPipelineCAD above = first; above.source; above = inputOf(above.source, "Input"))
  {
    first = above;
  }
  auto* item = pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(
    first.source);
  return item && isCAD(item) ? first : pqPipelineCAD();
}

bool pqPipelineCAD::isCAD(pqPipelineSource* source)
{
  return !qobject_cast<pqPipelineFilter*>(source) &&
         (std::string(source->getProxy()->GetXMLName()) == "CADReader" ||
           source->getOutputPort(0)->getDataInformation()->GetArrayInformation(
             "CADModel", vtkDataObject::FIELD));
}
