#include "vtkSMNamedArrayDomain.h"

#include <vtkDataObject.h>
#include <vtkObjectFactory.h>
#include <vtkPVDataInformation.h>
#include <vtkPVXMLElement.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>

#include <map>

vtkStandardNewMacro(vtkSMNamedArrayDomain);

vtkSMNamedArrayDomain::vtkSMNamedArrayDomain() = default;

vtkSMNamedArrayDomain::~vtkSMNamedArrayDomain() = default;

int vtkSMNamedArrayDomain::IsInDomain(vtkSMProperty* property)
{
  const vtkSMUncheckedPropertyHelper helper(property);
  for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
  {
    auto* source = vtkSMSourceProxy::SafeDownCast(helper.GetAsProxy(i));
    if (!this->IsInDomain(source, helper.GetOutputPort(i)))
    {
      return NOT_IN_DOMAIN;
    }
  }
  return helper.GetNumberOfElements() > 0 ? IN_DOMAIN : NOT_IN_DOMAIN;
}

bool vtkSMNamedArrayDomain::IsInDomain(vtkSMSourceProxy* source, unsigned int port)
{
  if (!source)
  {
    return false;
  }
  source->CreateOutputPorts();
  vtkPVDataInformation* data = source->GetDataInformation(port);
  const bool found =
    data && data->GetArrayInformation(this->ArrayName.c_str(), this->Association) != nullptr;
  return found == this->Present;
}

int vtkSMNamedArrayDomain::ReadXMLAttributes(vtkSMProperty* property, vtkPVXMLElement* element)
{
  if (!this->Superclass::ReadXMLAttributes(property, element))
  {
    return 0;
  }
  const std::map<std::string, int> associations{ { "point", vtkDataObject::POINT },
    { "cell", vtkDataObject::CELL }, { "field", vtkDataObject::FIELD } };
  const auto found = associations.find(element->GetAttributeOrEmpty("attribute_type"));
  this->ArrayName = element->GetAttributeOrEmpty("array");
  if (found == associations.end() || this->ArrayName.empty())
  {
    vtkErrorMacro("a NamedArrayDomain needs array, and attribute_type point, cell or field");
    return 0;
  }
  this->Association = found->second;
  int present = 1;
  element->GetScalarAttribute("present", &present);
  this->Present = present != 0;
  this->Reason = element->GetAttributeOrEmpty("reason");
  return 1;
}

void vtkSMNamedArrayDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ArrayName: " << this->ArrayName << "\n";
  os << indent << "Present: " << this->Present << "\n";
  os << indent << "Reason: " << this->Reason << "\n";
}
