#include "pqColourScales.h"

#include <QPointer>
#include <QTimer>
#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <pqView.h>
#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxyIterator.h>
#include <vtkSMProxyManager.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSettings.h>
#include <vtkSMTrace.h>
#include <vtkSMTransferFunctionManager.h>
#include <vtkSMTransferFunctionProxy.h>
#include <vtkSmartPointer.h>

#include <cmath>
#include <limits>

namespace
{

constexpr double lowestPart = 1e-4; ///< Of the largest value: four decades.

bool isMeasure(const QString& array)
{
  return array == "GeometricError" || array == "GeometricDistance" || array == "ChordError" ||
         array == "CADDistance";
}

bool isSavedByUser(const QString& array)
{
  const QString key = ".array_lookup_tables." + array;
  return vtkSMSettings::GetInstance()->HasSetting(qUtf8Printable(key));
}

QString colourArray(vtkSMProxy* display)
{
  auto* coloured = vtkSMPVRepresentationProxy::SafeDownCast(display);
  return coloured && coloured->GetUsingScalarColoring()
           ? vtkSMPropertyHelper(display, "ColorArrayName").GetInputArrayNameToProcess()
           : "";
}

/// Whether the scale ends at the largest value of the data that are shown, if it has any.
bool fitToData(vtkSMProxy* table)
{
  double range[2] = { 0, 0 };
  if (!vtkSMTransferFunctionProxy::ComputeDataRange(table, range) || !(range[1] > 0))
  {
    return false;
  }
  vtkSMTransferFunctionProxy::RescaleTransferFunction(
    table, lowestPart * range[1], range[1], /*extend*/ false);
  return true;
}

void makeLogarithmic(vtkSMProxy* table)
{
  if (fitToData(table))
  {
    vtkSMTransferFunctionProxy::MapControlPointsToLogSpace(table);
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", table);
    vtkSMPropertyHelper(table, "UseLogScale").Set(1);
    vtkSMPropertyHelper(table, "AutomaticRescaleRangeMode")
      .Set(vtkSMTransferFunctionManager::NEVER);
    table->UpdateVTKObjects();
  }
}

/// Whether the scale is as makeLogarithmic leaves it: the user has changed neither kind nor range.
bool isOurs(vtkSMProxy* table)
{
  double range[2] = { 0, 0 };
  return vtkSMPropertyHelper(table, "UseLogScale").GetAsInt() == 1 &&
         vtkSMPropertyHelper(table, "AutomaticRescaleRangeMode").GetAsInt() ==
           vtkSMTransferFunctionManager::NEVER &&
         vtkSMTransferFunctionProxy::GetRange(table, range) && range[1] > 0 &&
         std::abs(range[0] / range[1] / lowestPart - 1) <
           8 * std::numeric_limits<double>::epsilon();
}

} // namespace

pqColourScales::pqColourScales(QObject* parent) : QObject(parent) {}

void pqColourScales::startup()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  connect(model, &pqServerManagerModel::representationAdded, this, &pqColourScales::onAdded);
  connect(model, &pqServerManagerModel::dataUpdated, this, &pqColourScales::onDataUpdated);
}

void pqColourScales::shutdown()
{
  disconnect(pqApplicationCore::instance()->getServerManagerModel(), nullptr, this, nullptr);
}

void pqColourScales::onAdded(pqRepresentation* added)
{
  auto* representation = qobject_cast<pqDataRepresentation*>(added);
  if (!representation)
  {
    return;
  }
  const bool fromState = pqApplicationCore::instance()->isLoadingState();
  const QPointer<pqRepresentation> pointer(added);
  const auto colourLater = [this, pointer]
  {
    // ParaView chooses the colours after its signals.
    QTimer::singleShot(0, this,
      [this, pointer]
      {
        if (pointer)
        {
          colour(pointer);
        }
      });
  };
  connect(representation, &pqDataRepresentation::colorArrayNameModified, this, colourLater);
  if (!fromState)
  {
    colourLater();
  }
}

void pqColourScales::colour(pqRepresentation* representation)
{
  vtkSMProxy* display = representation->getProxy();
  const QString array = colourArray(display);
  vtkSMProxy* table = vtkSMPropertyHelper(display, "LookupTable", /*quiet*/ true).GetAsProxy();
  if (table && isMeasure(array) && !seen_.contains(table->GetGlobalID()))
  {
    seen_.insert(table->GetGlobalID());
    if (!isSavedByUser(array))
    {
      makeLogarithmic(table);
    }
  }
  const bool isDirect = vtkSMPropertyHelper(display, "MapScalars", /*quiet*/ true).GetAsInt() == 0;
  if ((array == "CADEntity" || (array == "Color" && isDirect)) && representation->getView())
  {
    vtkSMPVRepresentationProxy::SafeDownCast(display)->SetScalarBarVisibility(
      representation->getView()->getProxy(), false);
  }
  representation->renderViewEventually();
}

void pqColourScales::onDataUpdated()
{
  const auto tables = vtkSmartPointer<vtkSMProxyIterator>::New();
  tables->SetSessionProxyManager(
    vtkSMProxyManager::GetProxyManager()->GetActiveSessionProxyManager());
  tables->SetModeToOneGroup();
  for (tables->Begin("lookup_tables"); !tables->IsAtEnd(); tables->Next())
  {
    if (isMeasure(QString(tables->GetKey()).section('.', 0, 0)) && isOurs(tables->GetProxy()))
    {
      fitToData(tables->GetProxy());
    }
  }
}
