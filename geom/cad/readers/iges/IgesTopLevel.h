// Which entities of an IGES file stand for the model. Private to geom/cad.
#pragma once

#include <cadrefine/cad/readers/iges/IgesRepair.h>

#include <vector>

namespace cadrefine
{

struct IgesTopLevel
{
  std::vector<int> kept;             ///< Directory entry numbers, ascending.
  std::vector<UnreadEntity> leftOut; ///< Geometry that the standard says is no part of the model.
  bool allBlanked = false;           ///< `kept` are blanked: there is nothing else.
};

/// Sorts the curves, surfaces and solids that no other one is made of (members of groups are
/// looked at one by one; subfigures are taken where they are placed):
/// 1. Left out: blanked ones, which are kept where there is nothing else at all; those of use 1
/// (annotation), 2 (definition), 4 (logical) and 5
///    (curves in a parameter plane); unbounded lines and planes; points.
/// 2. Those of use 3 (other) and 6 (construction), and sets of points, are left out too, but are
///    kept where there is nothing else but blanked ones.
/// 3. All others are kept, whatever their subordinate switch: what nothing refers to, stands for
///    itself.
/// After IGES 5.3, 2.2.4.4.9 (status number).
IgesTopLevel findIgesRoots(const RepairedIges& file);

} // namespace cadrefine
