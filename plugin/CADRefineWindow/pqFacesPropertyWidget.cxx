#include "pqFacesPropertyWidget.h"

#include "pqPipelineCAD.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSet>
#include <QVBoxLayout>
#include <pqApplicationCore.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqScalarValueListPropertyWidget.h>
#include <pqSelectionManager.h>
#include <vtkSMInputProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>
#include <vtkSmartPointer.h>

namespace
{

QSet<pqOutputPort*> selectedPorts()
{
  const auto* selection =
    qobject_cast<pqSelectionManager*>(pqApplicationCore::instance()->manager("SelectionManager"));
  return selection ? selection->getSelectedPorts() : QSet<pqOutputPort*>();
}

void connectInput(vtkSMProxy* filter, const char* property, vtkSMProxy* source, unsigned int port)
{
  vtkSMInputProperty::SafeDownCast(filter->GetProperty(property))->AddInputConnection(source, port);
}

/// Names of selected sources that belong to another CAD, and would give numbers of its faces.
QStringList strangersTo(vtkSMProxy* cad, const QSet<pqOutputPort*>& ports)
{
  QStringList names;
  for (const pqOutputPort* port : ports)
  {
    vtkSMProxy* its = pqPipelineCAD::findBehind(port->getSource()).source;
    if (its && its != cad)
    {
      names << port->getSource()->getSMName();
    }
  }
  return names;
}

} // namespace

pqFacesPropertyWidget::pqFacesPropertyWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : pqStringVectorPropertyWidget(property, proxy, parent)
{
  auto* buttons = new QHBoxLayout;
  layout()->addItem(buttons);
  message_ = new QLabel(this);
  message_->setObjectName("Message");
  message_->setWordWrap(true);
  message_->hide();
  layout()->addWidget(message_);
  const auto addButton = [&](const char* name, const char* label, const char* help, bool excludes)
  {
    auto* button = new QPushButton(label, this);
    button->setObjectName(name);
    button->setToolTip(help);
    connect(button, &QPushButton::clicked, this, [this, excludes] { this->take(excludes); });
    buttons->addWidget(button);
  };
  addButton("AddSelected", "Add Selected",
    "Add the CAD faces that are selected in the view to the list (for a planar mesh, CAD edges). "
    "Select cells of the CAD, of CAD Boundary or of a projected mesh with the tools of the view.",
    false);
  addButton("ExcludeSelected", "Exclude Selected",
    "Add the CAD faces that are selected in the view to the list with ! before them, which "
    "excludes them. If the list has no other entries, all other faces are used.",
    true);
}

pqFacesPropertyWidget::~pqFacesPropertyWidget() = default;

void pqFacesPropertyWidget::take(bool excludes)
{
  QString reason;
  const QStringList entries = selectedEntries(reason);
  putIntoList(entries, excludes);
  message_->setText(reason);
  message_->setVisible(!reason.isEmpty());
}

/// What is selected, as entries; none: the reason tells why.
QStringList pqFacesPropertyWidget::selectedEntries(QString& reason) const
{
  const QSet<pqOutputPort*> ports = selectedPorts();
  if (ports.isEmpty())
  {
    reason = "Nothing is selected: select cells of the CAD in the view (key S), choose this filter "
             "again in the Pipeline Browser, then press the button.";
    return {};
  }
  const pqPipelineCAD cad = pqPipelineCAD::findFor(proxy());
  const pqPipelineCAD mesh = pqPipelineCAD::inputOf(proxy(), "Input");
  if (!cad.source || !mesh.source)
  {
    reason = "The filter has no CAD: choose one under CAD, then press the button.";
    return {};
  }
  const QStringList strangers = strangersTo(cad.source, ports);
  if (!strangers.isEmpty())
  {
    reason = "The selection in " + strangers.join(", ") +
             " belongs to another CAD than this filter's: select faces of its own CAD.";
    return {};
  }
  vtkSMSessionProxyManager* proxies = proxy()->GetSessionProxyManager();
  const auto finder = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(proxies->NewProxy("internal_filters", "CADSelectedFaces")));
  for (pqOutputPort* port : ports)
  {
    auto* source = vtkSMSourceProxy::SafeDownCast(port->getSource()->getProxy());
    connectInput(finder, "Selection", source->GetSelectionOutput(port->getPortNumber()), 0);
  }
  connectInput(finder, "CAD", cad.source, cad.port);
  connectInput(finder, "Mesh", mesh.source, mesh.port);
  finder->UpdateVTKObjects();
  finder->UpdatePipeline();
  finder->UpdatePropertyInformation();
  const QString lines = vtkSMPropertyHelper(finder, "Faces").GetAsString();
  const QStringList entries = lines.split('\n', Qt::SkipEmptyParts);
  if (entries.isEmpty())
  {
    const QString noun = vtkSMPropertyHelper(finder, "Dimension").GetAsInt() == 1 ? "edge" : "face";
    reason = "The selected cells lie on no CAD " + noun + ": select cells of the " + noun +
             "s that the CAD Reader draws, or of CAD Boundary.";
  }
  return entries;
}

/// An entry is in the list once, and not together with its opposite: the last press counts.
void pqFacesPropertyWidget::putIntoList(const QStringList& entries, bool excludes)
{
  auto* list = findChild<pqScalarValueListPropertyWidget*>();
  if (entries.isEmpty() || !list)
  {
    return;
  }
  QVariantList values = list->scalars();
  for (const QString& entry : entries)
  {
    const QString wanted = excludes ? "!" + entry : entry;
    values.removeAll(excludes ? entry : "!" + entry);
    if (!values.contains(wanted))
    {
      values << wanted;
    }
  }
  list->setScalars(values);
  Q_EMIT list->scalarsChanged();
}
