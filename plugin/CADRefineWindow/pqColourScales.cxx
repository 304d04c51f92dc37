#include "pqColourScales.h"

#include <QPointer>
#include <QTimer>
#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <pqView.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSettings.h>
#include <vtkSMTrace.h>
#include <vtkSMTransferFunctionManager.h>
#include <vtkSMTransferFunctionProxy.h>

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

vtkSMProxy* tableOf(pqRepresentation* representation)
{
  return vtkSMPropertyHelper(representation->getProxy(), "LookupTable", /*quiet*/ true)
    .GetAsProxy();
}

QString colourArray(vtkSMProxy* display)
{
  auto* coloured = vtkSMPVRepresentationProxy::SafeDownCast(display);
  return coloured && coloured->GetUsingScalarColoring()
           ? vtkSMPropertyHelper(display, "ColorArrayName").GetInputArrayNameToProcess()
           : "";
}

/// The largest value of the array that these data are coloured by; 0 without any.
double largestValue(pqDataRepresentation* representation)
{
  const vtkSMPropertyHelper colour(representation->getProxy(), "ColorArrayName");
  const pqOutputPort* port = representation->getOutputPortFromInput();
  vtkPVArrayInformation* array =
    port ? port->getDataInformation()->GetArrayInformation(
             colour.GetInputArrayNameToProcess(), colour.GetInputArrayAssociation())
         : nullptr;
  return array ? array->GetComponentRange(0)[1] : 0;
}

/// Whether the scale ends at the largest value of these data, if they have any. Of these alone:
/// beside a coarse mesh that is shown still, a fine one would have one colour.
bool fitToData(vtkSMProxy* table, pqDataRepresentation* representation)
{
  const double largest = largestValue(representation);
  if (!(largest > 0) || !std::isfinite(largest))
  {
    return false;
  }
  vtkSMTransferFunctionProxy::RescaleTransferFunction(
    table, lowestPart * largest, largest, /*extend*/ false);
  return true;
}

void makeLogarithmic(vtkSMProxy* table, pqDataRepresentation* representation)
{
  if (fitToData(table, representation))
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
  const QPointer<pqDataRepresentation> pointer(representation);
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

void pqColourScales::colour(pqDataRepresentation* representation)
{
  vtkSMProxy* display = representation->getProxy();
  const QString array = colourArray(display);
  vtkSMProxy* table = tableOf(representation);
  if (table && isMeasure(array))
  {
    if (!seen_.contains(table->GetGlobalID()))
    {
      seen_.insert(table->GetGlobalID());
      if (!isSavedByUser(array))
      {
        makeLogarithmic(table, representation);
      }
    }
    else if (isOurs(table))
    {
      fitToData(table, representation);
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

void pqColourScales::onDataUpdated(pqPipelineSource* source)
{
  for (pqDataRepresentation* representation : source->getRepresentations(nullptr))
  {
    vtkSMProxy* table = tableOf(representation);
    if (table && representation->isVisible() &&
        isMeasure(colourArray(representation->getProxy())) && isOurs(table))
    {
      fitToData(table, representation);
    }
  }
}
