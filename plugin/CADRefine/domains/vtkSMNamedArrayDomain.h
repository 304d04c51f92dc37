/**
 * @class vtkSMNamedArrayDomain
 * @brief inputs that have an array of a given name, or that do not have it
 *
 * For example, the CAD input of a filter takes the output of a CAD Reader alone:
 *
 *     <NamedArrayDomain name="model" attribute_type="field" array="CADModel"
 *       reason="The CAD input must be the output of a CAD Reader"/>
 *
 * attribute_type is point, cell or field; present="0" asks for data without the array. The reason
 * is what the menu says where the input does not fit (pqMenuReasons). Data information is asked
 * for, which costs nothing once the input is up to date. Scripts are not held to domains.
 */
#ifndef vtkSMNamedArrayDomain_h
#define vtkSMNamedArrayDomain_h

#include "CADRefineDomainsModule.h"
#include "vtkSMDomain.h"

#include <string>

class vtkSMSourceProxy;

class CADREFINEDOMAINS_EXPORT vtkSMNamedArrayDomain : public vtkSMDomain
{
public:
  static vtkSMNamedArrayDomain* New();
  vtkTypeMacro(vtkSMNamedArrayDomain, vtkSMDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// In the domain if all inputs are.
  int IsInDomain(vtkSMProperty* property) override;
  bool IsInDomain(vtkSMSourceProxy* source, unsigned int port);

  /// Why an input does not fit, a sentence for the user.
  const char* GetReason() const { return this->Reason.c_str(); }

protected:
  vtkSMNamedArrayDomain();
  ~vtkSMNamedArrayDomain() override;

  int ReadXMLAttributes(vtkSMProperty* property, vtkPVXMLElement* element) override;

private:
  vtkSMNamedArrayDomain(const vtkSMNamedArrayDomain&) = delete;
  void operator=(const vtkSMNamedArrayDomain&) = delete;

  int Association = 0; ///< One of vtkDataObject::FieldAssociations.
  std::string ArrayName;
  bool Present = true;
  std::string Reason;
};

#endif
