#ifndef pqPipelineCAD_h
#define pqPipelineCAD_h

class pqPipelineSource;
class vtkSMProxy;

/// An output in the pipeline, or none.
struct pqPipelineCAD
{
  vtkSMProxy* source = nullptr;
  unsigned int port = 0;

  /// What the input property holds, as the panel shows it, applied or not.
  static pqPipelineCAD inputOf(vtkSMProxy* filter, const char* property);

  /// The CAD of the filter itself, or of the nearest one above it that has one.
  static pqPipelineCAD findFor(vtkSMProxy* filter);

  /// The CAD that the source draws, or what it is made from is, or that its mesh was projected
  /// onto.
  static pqPipelineCAD findBehind(pqPipelineSource* source);

  /// Whether the source is a CAD Reader, which may not have read yet, or reads a saved CAD.
  static bool isCAD(pqPipelineSource* source);
};

#endif
