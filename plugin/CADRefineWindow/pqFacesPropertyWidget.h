#ifndef pqFacesPropertyWidget_h
#define pqFacesPropertyWidget_h

#include <pqStringVectorPropertyWidget.h>

#include <QStringList>

class QLabel;

/// The list of the property Faces, with buttons that put the CAD faces selected in a view into it,
/// or take them away from those that are chosen. For a filter with the inputs Input, a mesh, and
/// CAD. What is selected are cells of that CAD as its reader draws it, or of a mesh that knows its
/// CAD faces; of a planar mesh CAD edges. The entries are found where the data are (see
/// vtkCADSelectedFaces), so that of a server nothing else comes to the client.
class pqFacesPropertyWidget : public pqStringVectorPropertyWidget
{
  Q_OBJECT

public:
  pqFacesPropertyWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqFacesPropertyWidget() override;

private:
  void take(bool excludes);
  QStringList selectedEntries(QString& reason) const;
  void putIntoList(const QStringList& entries, bool excludes);

  QLabel* message_ = nullptr;
};

#endif
