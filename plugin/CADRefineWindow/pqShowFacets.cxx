#include "pqShowFacets.h"

#include <cadrefine/base/CodeFolder.h>

#include <QAction>
#include <QCoreApplication>
#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqOutputPort.h>
#include <pqPVApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqPythonManager.h>
#include <pqServerManagerModel.h>
#include <vtkDataObject.h>
#include <vtkPVDataInformation.h>

#include <filesystem>
#include <string>

namespace
{

/// The folder of the driver, from that of the plugin. VTK's wrapping of the filters is a package of
/// the same name, which then gets the driver's modules beside its own.
constexpr const char* script = R"(
import sys
sys.path.append({folder})
import cadrefine
if {folder} + "/cadrefine" not in cadrefine.__path__:
    cadrefine.__path__.append({folder} + "/cadrefine")
from cadrefine import ready_view
ready_view.show()
)";

/// As a literal of Python: the folder `python` beside that of the plugin CADRefine, in which this
/// one is.
QString driverFolder()
{
  const auto own = cadrefine::folderOfCode(reinterpret_cast<const void*>(&driverFolder));
  std::error_code error;
  const auto folder = std::filesystem::canonical(own / "../../python", error);
  QString text = QString::fromStdString(folder.string());
  return '"' + text.replace('\\', "\\\\").replace('"', "\\\"") + '"';
}

bool isMeasured(pqPipelineSource* source)
{
  vtkPVDataInformation* data = source ? source->getOutputPort(0)->getDataInformation() : nullptr;
  return data && data->GetArrayInformation("CADDimension", vtkDataObject::POINT) &&
         data->GetArrayInformation("GeometricDistance", vtkDataObject::CELL);
}

} // namespace

pqShowFacets::pqShowFacets(QObject* parent)
  : QActionGroup(parent), action_(addAction("Show CAD Facets"))
{
  action_->setObjectName("ShowCADFacets");
  connect(action_, &QAction::triggered, this, &pqShowFacets::show);
  connect(
    &pqActiveObjects::instance(), &pqActiveObjects::sourceChanged, this, &pqShowFacets::enable);
  connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::dataUpdated, this, &pqShowFacets::enable);
  enable();
}

void pqShowFacets::enable()
{
  const bool measured = isMeasured(pqActiveObjects::instance().activeSource());
  action_->setEnabled(measured);
  action_->setToolTip(
    measured
      ? "Show the facets on those CAD faces that carry error, coloured by their distance from the "
        "CAD, and nothing else."
      : "Choose a mesh whose error was measured: the output of Adapt To CAD or CAD Geometric "
        "Error.");
}

void pqShowFacets::show()
{
  const QString code = QString(script).replace("{folder}", driverFolder());
  pqPVApplicationCore::instance()->pythonManager()->executeCode(code.toUtf8());
}
