#include "pqConvergenceChart.h"

#include <pqApplicationCore.h>
#include <pqRepresentation.h>
#include <pqServerManagerModel.h>
#include <pqView.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>

#include <string>

namespace
{

bool showsSteps(vtkSMProxy* display)
{
  const vtkSMPropertyHelper input(display, "Input", /*quiet*/ true);
  auto* source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  return source && std::string(source->GetXMLName()) == "AdaptToCAD" &&
         input.GetOutputPort() == 1 && display->GetProperty("SeriesVisibility");
}

void showErrorOverCells(vtkSMProxy* display)
{
  vtkSMPropertyHelper(display, "UseIndexForXAxis", /*quiet*/ true).Set(0);
  vtkSMPropertyHelper(display, "XArrayName", /*quiet*/ true).Set("GlobalCells");
  vtkSMPropertyHelper series(display, "SeriesVisibility");
  for (unsigned int i = 0; i + 1 < series.GetNumberOfElements(); i += 2)
  {
    series.Set(i + 1, std::string(series.GetAsString(i)) == "GlobalGeometricError" ? "1" : "0");
  }
  display->UpdateVTKObjects();
}

} // namespace

pqConvergenceChart::pqConvergenceChart(QObject* parent) : QObject(parent) {}

void pqConvergenceChart::startup()
{
  const auto watch = [this](pqView* view)
  {
    connect(view, &pqView::representationAdded, this,
      [this, view](pqRepresentation* added) { this->onAdded(view, added); });
  };
  connect(pqApplicationCore::instance()->getServerManagerModel(), &pqServerManagerModel::viewAdded,
    this, watch);
}

void pqConvergenceChart::shutdown()
{
  disconnect(pqApplicationCore::instance()->getServerManagerModel(), nullptr, this, nullptr);
}

void pqConvergenceChart::onAdded(pqView* view, pqRepresentation* added)
{
  if (pqApplicationCore::instance()->isLoadingState() || !showsSteps(added->getProxy()))
  {
    return;
  }
  showErrorOverCells(added->getProxy());
  for (const char* axis : { "LeftAxisLogScale", "BottomAxisLogScale" })
  {
    vtkSMPropertyHelper(view->getProxy(), axis, /*quiet*/ true).Set(1);
  }
  vtkSMPropertyHelper(view->getProxy(), "LeftAxisTitle", /*quiet*/ true)
    .Set("Global geometric error (area or volume)");
  vtkSMPropertyHelper(view->getProxy(), "BottomAxisTitle", /*quiet*/ true).Set("Cells");
  view->getProxy()->UpdateVTKObjects();
}
