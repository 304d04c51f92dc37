#ifndef pqShowFacets_h
#define pqShowFacets_h

#include <QActionGroup>

class QAction;

/// The button Show CAD Facets of the toolbar: of the active mesh, if its error was measured, the
/// facets on those CAD faces that carry error, from the side that shows most of it. Which these are
/// is decided, and the view made, by the Python of the driver (plugin/cadrefine/ready_view.py), so
/// that its pictures and the window show the same.
class pqShowFacets : public QActionGroup
{
  Q_OBJECT

public:
  explicit pqShowFacets(QObject* parent = nullptr);

private:
  void enable();
  void show();

  QAction* action_;
};

#endif
