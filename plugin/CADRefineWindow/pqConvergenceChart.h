#ifndef pqConvergenceChart_h
#define pqConvergenceChart_h

#include <QObject>

class pqRepresentation;
class pqView;

/// Draws the steps of Adapt To CAD, when they are shown for the first time, as such are read: the
/// global error over the number of cells, on logarithmic axes with titles. What a state file says
/// is kept.
class pqConvergenceChart : public QObject
{
  Q_OBJECT

public:
  explicit pqConvergenceChart(QObject* parent = nullptr);

  void startup();
  void shutdown();

private:
  void onAdded(pqView* view, pqRepresentation* added);
};

#endif
