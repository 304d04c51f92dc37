#ifndef pqErrorLines_h
#define pqErrorLines_h

#include <QObject>

/// Leaves out of the window's messages what VTK adds to each error of our filters, which say
/// themselves what is wrong: "Algorithm vtkAdaptToCAD (0x...) returned failure for request: ...".
class pqErrorLines : public QObject
{
  Q_OBJECT

public:
  explicit pqErrorLines(QObject* parent = nullptr);

  void startup();
  void shutdown() {}
};

#endif
