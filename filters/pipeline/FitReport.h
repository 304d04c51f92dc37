// What the user is told of the fit of mesh and CAD.
#pragma once

#include "projection/Fit.h"

#include <string>

class vtkFieldData;

namespace cadrefine
{

/// What is to be said of a mesh that seems not to fit: less than half of its boundary on the CAD,
/// or most of it in another place while the CAD is not covered (both where `isWhole`: no region was
/// chosen), or boxes whose sizes compare like two units of length where the CAD is not covered and
/// not nearly all of the boundary is on it, or that are alike but shifted. Of a mesh that lies on
/// curved faces (Fit::wasOnCurved) only the last is said: it is a part of the CAD. Names the units
/// and what to do. Empty: nothing.
std::string warningOfMisfit(const Fit& fit, const std::string& cadUnit, bool isWhole);

/// What is to be said of vertices that were moved onto the CAD among others that lay on it: they
/// may be those of a wall that is not in the CAD, and meets it at a small angle. Empty: nothing.
std::string warningOfStrays(const Fit& fit);

/// All of the fit, for a person: several lines.
std::string describeFit(const Fit& fit, const std::string& cadUnit);

/// Sets field arrays: MeshBox, CADBox (xmin xmax ymin ymax zmin zmax), BoundaryOnCAD,
/// BoundaryInBox, CADCovered, VerticesOffCAD, ClassificationConflicts, FarthestVertices (x y z
/// distance), BridgingFacets, BridgingFacetCentroids and ConflictPoints (x y z).
void writeFit(vtkFieldData* data, const Fit& fit);
/// Takes away those field arrays of writeFit that another fit may not have.
void removeFit(vtkFieldData* from);

} // namespace cadrefine
