#include "pqMenuReasons.h"

#include "vtkSMNamedArrayDomain.h"

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <pqActiveObjects.h>
#include <pqCoreUtilities.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqServer.h>
#include <vtkSMDomainIterator.h>
#include <vtkSMProperty.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>
#include <vtkSmartPointer.h>

namespace
{

QMenu* filtersMenu()
{
  QWidget* window = pqCoreUtilities::mainWidget();
  return window ? window->findChild<QMenu*>("menuFilters") : nullptr;
}

/// Why the data at the port are no input of the filter; empty if its named arrays do not matter.
QString reasonAgainst(vtkSMProxy* filter, const pqOutputPort& port)
{
  vtkSMProperty* input = filter->GetProperty("Input");
  if (!input)
  {
    return {};
  }
  const auto domains = vtkSmartPointer<vtkSMDomainIterator>::Take(input->NewDomainIterator());
  for (domains->Begin(); !domains->IsAtEnd(); domains->Next())
  {
    auto* domain = vtkSMNamedArrayDomain::SafeDownCast(domains->GetDomain());
    if (domain && !domain->IsInDomain(port.getSourceProxy(), port.getPortNumber()))
    {
      return domain->GetReason();
    }
  }
  return {};
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
    if (names.size() != 2 || action->isEnabled())
    {
      continue;
    }
    vtkSMProxy* filter =
      proxies->GetPrototypeProxy(qUtf8Printable(names[0]), qUtf8Printable(names[1]));
    const QString reason = filter ? reasonAgainst(filter, *port) : QString();
    if (!reason.isEmpty())
    {
      action->setStatusTip(reason);
    }
  }
}
