#ifndef pqAdaptationAbort_h
#define pqAdaptationAbort_h

#include <QObject>

class pqPipelineSource;
class vtkAlgorithm;
class vtkObject;

/// Makes ParaView's abort button, beside its progress bar, stop Adapt To CAD, which then keeps its
/// last whole step. ParaView has the button and never enables it, since filters run in the thread
/// of the window, which does not look at the mouse meanwhile; here it does, at each news of the
/// progress, for that button alone. A filter of a server cannot be reached while it runs.
class pqAdaptationAbort : public QObject
{
  Q_OBJECT

public:
  explicit pqAdaptationAbort(QObject* parent = nullptr);

  void startup();
  void shutdown();

  /// While the window looks at the mouse: drops what is meant for anything but the button.
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  void watch(pqPipelineSource* source);
  void begin(vtkObject* filter, unsigned long event, void* data);
  void look(vtkObject* filter, unsigned long event, void* data);
  void end(vtkObject* filter, unsigned long event, void* data);
  void abort();

  vtkAlgorithm* running_ = nullptr;
};

#endif
