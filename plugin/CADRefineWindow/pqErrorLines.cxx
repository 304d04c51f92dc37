#include "pqErrorLines.h"

#include <QStringList>
#include <QWidget>
#include <pqCoreUtilities.h>
#include <pqOutputWidget.h>

pqErrorLines::pqErrorLines(QObject* parent) : QObject(parent) {}

void pqErrorLines::startup()
{
  QWidget* window = pqCoreUtilities::mainWidget();
  if (!window)
  {
    return;
  }
  QStringList beginnings;
  for (const char* filter :
    { "AdaptToCAD", "CADBoundary", "CADGeometricError", "CADReader", "CADSelectedFaces",
      "CoarsenWithCAD", "MeshReader", "MeshValidity", "ProjectOntoCAD", "RefineWithCAD" })
  {
    beginnings << QString("Algorithm vtk%1 (").arg(filter);
  }
  for (pqOutputWidget* messages : window->findChildren<pqOutputWidget*>())
  {
    messages->suppress(beginnings);
  }
}
