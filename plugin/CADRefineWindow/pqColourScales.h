#ifndef pqColourScales_h
#define pqColourScales_h

#include <QObject>
#include <QSet>

#include <vtkType.h>

class pqDataRepresentation;
class pqPipelineSource;
class pqRepresentation;

/// Colours errors and distances on a logarithmic scale of four decades that ends at their largest
/// value, when an array is coloured by for the first time, and keeps the scale to the data that
/// were shown or computed last while the user leaves it like that. ParaView's own logarithmic scale
/// warns at each rescaling where some values are 0, as those of all cells away from the CAD are.
///
/// Hides the legend of CAD entities, which would have a line for each of them, and of the CAD
/// file's own colours, which has no meaning. What a state file or the user's saved defaults say is
/// kept.
class pqColourScales : public QObject
{
  Q_OBJECT

public:
  explicit pqColourScales(QObject* parent = nullptr);

  void startup();
  void shutdown();

private:
  void onAdded(pqRepresentation* added);
  void onDataUpdated(pqPipelineSource* source);
  void colour(pqDataRepresentation* representation);

  QSet<vtkTypeUInt32> seen_; ///< Look-up tables that have their scale.
};

#endif
