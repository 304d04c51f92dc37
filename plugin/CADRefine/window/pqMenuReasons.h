#ifndef pqMenuReasons_h
#define pqMenuReasons_h

#include <QObject>

/// Says in the status bar why a filter of the menu CAD Refinement is greyed out, where ParaView
/// itself knows no more than "Requirements not met".
class pqMenuReasons : public QObject
{
  Q_OBJECT

public:
  explicit pqMenuReasons(QObject* parent = nullptr);

  void startup();
  void shutdown();

private:
  void explain();
};

#endif
