#include "pqMenuReasons.h"

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <pqActiveObjects.h>
#include <pqCoreUtilities.h>
#include <pqOutputPort.h>
#include <pqServer.h>
#include <vtkDataObject.h>
#include <vtkPVDataInformation.h>
#include <vtkPVXMLElement.h>
#include <vtkSMProperty.h>
#include <vtkSMProxy.h>
#include <vtkSMSessionProxyManager.h>

#include <map>
#include <string>

namespace
{

QMenu* filtersMenu()
{
  QWidget* window = pqCoreUtilities::mainWidget();
  return window ? window->findChild<QMenu*>("menuFilters") : nullptr;
}

/// Whether the data meet a condition.
bool isMet(vtkPVXMLElement* condition, vtkPVDataInformation* data)
{
  const std::map<std::string, int> associations{ { "point", vtkDataObject::POINT },
    { "cell", vtkDataObject::CELL }, { "field", vtkDataObject::FIELD } };
  const auto association = associations.find(condition->GetAttributeOrEmpty("attribute_type"));
  int present = 1;
  condition->GetScalarAttribute("present", &present);
  return association == associations.end() ||
         (present != 0) == (data->GetArrayInformation(condition->GetAttributeOrEmpty("array"),
                              association->second) != nullptr);
}

/// The condition of the filter that the data do not meet; null if they meet all.
vtkPVXMLElement* unmetCondition(vtkSMProxy* filter, vtkPVDataInformation* data)
{
  vtkSMProperty* input = filter->GetProperty("Input");
  vtkPVXMLElement* hints = input ? input->GetHints() : nullptr;
  for (unsigned int i = 0; hints && i < hints->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* hint = hints->GetNestedElement(i);
    if (std::string(hint->GetName()) == "MenuCondition" && !isMet(hint, data))
    {
      return hint;
    }
  }
  return nullptr;
}

/// Of the menus that have the action; by default menus show none.
void showToolTips(QAction* action)
{
  for (QWidget* widget : action->associatedWidgets())
  {
    if (auto* menu = qobject_cast<QMenu*>(widget))
    {
      menu->setToolTipsVisible(true);
    }
  }
}

} // namespace

pqMenuReasons::pqMenuReasons(QObject* parent) : QObject(parent) {}

void pqMenuReasons::startup()
{
  if (QMenu* menu = filtersMenu())
  {
    connect(menu, &QMenu::aboutToShow, this, &pqMenuReasons::explain);
  }
}

void pqMenuReasons::shutdown()
{
  if (QMenu* menu = filtersMenu())
  {
    disconnect(menu, nullptr, this, nullptr);
  }
}

void pqMenuReasons::explain()
{
  const pqOutputPort* port = pqActiveObjects::instance().activePort();
  if (!port)
  {
    return;
  }
  vtkSMSessionProxyManager* proxies = port->getServer()->proxyManager();
  for (QAction* action : filtersMenu()->findChildren<QAction*>())
  {
    const QStringList names = action->data().toStringList(); // group and name of the filter
    if (names.size() != 2)
    {
      continue;
    }
    vtkSMProxy* filter =
      proxies->GetPrototypeProxy(qUtf8Printable(names[0]), qUtf8Printable(names[1]));
    vtkPVXMLElement* unmet = filter ? unmetCondition(filter, port->getDataInformation()) : nullptr;
    action->setToolTip(unmet ? unmet->GetAttributeOrEmpty("details") : "");
    if (unmet)
    {
      action->setEnabled(false);
      action->setStatusTip(unmet->GetAttributeOrEmpty("reason"));
      showToolTips(action);
    }
  }
}
