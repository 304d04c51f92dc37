/**
 * @class vtkRefinementAlgorithm
 * @brief common base of the filters that refine a mesh on the CAD
 *
 * Holds what they have in common: how cells are cut, which of them beside those that the subclass
 * marks, and what becomes of new vertices. A cell is refined if any of the criteria marks it. All
 * are taken over all ranks, and mark the same cells on any number of them.
 */
#ifndef vtkRefinementAlgorithm_h
#define vtkRefinementAlgorithm_h

#include "CADRefineFiltersModule.h"
#include "vtkMeshAlgorithm.h"

#include <string>

namespace cadrefine
{
struct MarkingCriterion;
struct RefinementOptions;
} // namespace cadrefine

class CADREFINEFILTERS_EXPORT vtkRefinementAlgorithm : public vtkMeshAlgorithm
{
public:
  vtkTypeMacro(vtkRefinementAlgorithm, vtkMeshAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum RefinementMethod
  {
    LONGEST_EDGE_BISECTION = 0,
    UNIFORM_BISECTION = 1
  };

  enum MarkingStrategy
  {
    THRESHOLD = 0,           ///< Cells whose value is larger than a threshold.
    FRACTION_OF_LARGEST = 1, ///< Cells whose value is at least this part of the largest one.
    BULK = 2                 ///< The fewest cells that carry this part of the sum (W. Doerfler).
  };

  ///@{
  /**
   * LONGEST_EDGE_BISECTION (default) of the marked cells, or UNIFORM_BISECTION: 4 cells
   * of area, 8 of volume (of a pyramid 10) for each marked or unmarked cell.
   */
  vtkSetMacro(Method, int);
  vtkGetMacro(Method, int);
  ///@}

  ///@{
  /**
   * A solver's error indicator: a cell array with one component that marks cells too, by
   * IndicatorMarking (default THRESHOLD) and IndicatorThreshold (default 0) or IndicatorFraction
   * (default 0.5, above 0 and at most 1; of values that are not negative). Empty (default): none.
   */
  vtkSetMacro(IndicatorArray, std::string);
  vtkGetMacro(IndicatorArray, std::string);
  vtkSetMacro(IndicatorMarking, int);
  vtkGetMacro(IndicatorMarking, int);
  vtkSetMacro(IndicatorThreshold, double);
  vtkGetMacro(IndicatorThreshold, double);
  vtkSetMacro(IndicatorFraction, double);
  vtkGetMacro(IndicatorFraction, double);
  ///@}

  ///@{
  /**
   * Size that follows the CAD, by the arrays ChordError and NormalAngle of vtkCADGeometricError:
   * cells with an edge on the CAD whose middle is farther from the CAD than ChordTolerance, and
   * with a facet that makes more than NormalAngle degrees with a neighbour (across no crease) are
   * marked too. Default 0 for both: not used.
   */
  vtkSetMacro(ChordTolerance, double);
  vtkGetMacro(ChordTolerance, double);
  vtkSetMacro(NormalAngle, double);
  vtkGetMacro(NormalAngle, double);
  ///@}

  ///@{
  /**
   * Whether marked cells are bisected until their facets on the CAD are cut: the longest edge of a
   * cell may be inside the mesh, and cutting it there alone does not lower the geometric error.
   */
  vtkSetMacro(CutFacets, bool);
  vtkGetMacro(CutFacets, bool);
  vtkBooleanMacro(CutFacets, bool);
  ///@}

  ///@{
  /**
   * Whether boundary layers are cut along the wall only, all cells over each other alike, and long
   * cells from end to end (see cadrefine::markLongestEdges); off: their cells are cut as others
   * are, and become pyramids and tetrahedra beside finer ones. Default on.
   */
  vtkSetMacro(KeepLayers, bool);
  vtkGetMacro(KeepLayers, bool);
  vtkBooleanMacro(KeepLayers, bool);
  ///@}

  ///@{
  /**
   * Whether new boundary vertices are put onto the CAD; off: they stay in the middle of their edge
   * (classified, with their CADDistance, if the mesh was projected). Default on.
   */
  vtkSetMacro(ProjectNewVertices, bool);
  vtkGetMacro(ProjectNewVertices, bool);
  vtkBooleanMacro(ProjectNewVertices, bool);
  ///@}

  ///@{
  /**
   * Whether the cells are first redistributed over the ranks, by the number of cells that the first
   * level will make of them. Default on.
   */
  vtkSetMacro(Balance, bool);
  vtkGetMacro(Balance, bool);
  vtkBooleanMacro(Balance, bool);
  ///@}

protected:
  /// `cutFacets`: default of CutFacets.
  explicit vtkRefinementAlgorithm(bool cutFacets);
  ~vtkRefinementAlgorithm() override;

  /// The criterion of the subclass; used if it names an array. Throws Error for a property that is
  /// out of range, as the next one does.
  virtual cadrefine::MarkingCriterion GetOwnCriterion() const = 0;

  /// The properties of this class, for one level, with the subclass's criterion.
  cadrefine::RefinementOptions MakeOptions() const;

  std::vector<std::string> GetCellArraysRead() const override;
  bool ChangesCells() const override { return true; }

  /// The criterion of the indicator; empty: none.
  cadrefine::MarkingCriterion GetIndicator() const;

  /// Criterion on an array ("" and "None", the panel's entry for no array: none).
  static cadrefine::MarkingCriterion MakeCriterion(
    const std::string& array, int strategy, double threshold, double fraction);

private:
  vtkRefinementAlgorithm(const vtkRefinementAlgorithm&) = delete;
  void operator=(const vtkRefinementAlgorithm&) = delete;

  int Method = LONGEST_EDGE_BISECTION;
  std::string IndicatorArray;
  int IndicatorMarking = THRESHOLD;
  double IndicatorThreshold = 0;
  double IndicatorFraction = 0.5;
  double ChordTolerance = 0;
  double NormalAngle = 0;
  bool CutFacets;
  bool KeepLayers = true;
  bool ProjectNewVertices = true;
  bool Balance = true;
};

#endif
