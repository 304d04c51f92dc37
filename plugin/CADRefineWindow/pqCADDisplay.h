#ifndef pqCADDisplay_h
#define pqCADDisplay_h

#include <QObject>

class pqRepresentation;

/// Draws the output of a CAD Reader as CAD programs do, when it is shown for the first time: edges
/// and vertices of solids dark, and faces in the file's own colours where it has any. What a state
/// file says is kept.
class pqCADDisplay : public QObject
{
  Q_OBJECT

public:
  explicit pqCADDisplay(QObject* parent = nullptr);

  void startup();
  void shutdown();

private:
  void onAdded(pqRepresentation* added);
};

#endif
