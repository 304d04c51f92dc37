#ifndef pqCADChoice_h
#define pqCADChoice_h

#include <QObject>

class pqPipelineSource;

/// Chooses the CAD of a new filter: the one that its mesh was projected onto, or else the only one
/// in the pipeline. With several the panel's list waits for a choice.
class pqCADChoice : public QObject
{
  Q_OBJECT

public:
  explicit pqCADChoice(QObject* parent = nullptr);

  void startup();
  void shutdown();

private:
  void onAdded(pqPipelineSource* filter);
};

#endif
