#include "vtkRefinementAlgorithm.h"

#include "fields/CADArrays.h"
#include "pipeline/PropertyCheck.h"
#include "pipeline/Refinement.h"

#include <algorithm>

using cadrefine::MarkingCriterion;

vtkRefinementAlgorithm::vtkRefinementAlgorithm(bool cutFacets)
  : vtkMeshAlgorithm(true), CutFacets(cutFacets)
{
}

vtkRefinementAlgorithm::~vtkRefinementAlgorithm() = default;

MarkingCriterion vtkRefinementAlgorithm::MakeCriterion(
  const std::string& array, int strategy, double threshold, double fraction)
{
  MarkingCriterion criterion;
  criterion.array = array == "None" ? "" : array;
  criterion.strategy = static_cast<MarkingCriterion::Strategy>(strategy);
  criterion.value = strategy == THRESHOLD ? threshold : fraction;
  return criterion;
}

cadrefine::RefinementOptions vtkRefinementAlgorithm::MakeOptions() const
{
  using cadrefine::checkProperty;
  checkProperty("Method", this->Method, LONGEST_EDGE_BISECTION, UNIFORM_BISECTION);
  checkProperty("IndicatorMarking", this->IndicatorMarking, THRESHOLD, BULK);
  checkProperty("IndicatorThreshold", this->IndicatorThreshold);
  checkProperty("ChordTolerance", this->ChordTolerance, 0);
  checkProperty("NormalAngle", this->NormalAngle, 0, 180);
  cadrefine::RefinementOptions options;
  options.uniform = this->Method == UNIFORM_BISECTION;
  const auto add = [&](const MarkingCriterion& criterion)
  {
    if (!criterion.array.empty())
    {
      options.criteria.push_back(criterion);
    }
  };
  add(this->GetOwnCriterion());
  add(this->GetIndicator());
  for (const auto& [array, limit] :
    { std::pair(cadrefine::arrays::chordError, this->ChordTolerance),
      std::pair(cadrefine::arrays::normalAngle, this->NormalAngle) })
  {
    if (limit > 0)
    {
      add(MakeCriterion(array, THRESHOLD, limit, 0));
    }
  }
  options.faces = this->GetFaces();
  options.cutFacets = this->CutFacets;
  options.keepLayers = this->KeepLayers;
  options.projectNewVertices = this->ProjectNewVertices;
  options.balance = this->Balance;
  options.minimumQuality = this->FindMinimumQuality();
  return options;
}

MarkingCriterion vtkRefinementAlgorithm::GetIndicator() const
{
  return MakeCriterion(this->IndicatorArray, this->IndicatorMarking, this->IndicatorThreshold,
    this->IndicatorFraction);
}

std::vector<std::string> vtkRefinementAlgorithm::GetCellArraysRead() const
{
  const cadrefine::RefinementOptions options = this->MakeOptions();
  std::vector<std::string> names;
  for (const MarkingCriterion& criterion : options.criteria)
  {
    names.push_back(criterion.array);
  }
  const std::vector<std::string>& faces = this->GetFaces();
  if (std::any_of(faces.begin(), faces.end(),
        [](const std::string& face) { return face.find('=') != std::string::npos; }))
  {
    names.emplace_back(cadrefine::arrays::chordError); // for tolerances of their own
  }
  return options.uniform ? std::vector<std::string>{} : names;
}

void vtkRefinementAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "IndicatorArray: " << this->IndicatorArray << "\n";
  os << indent << "IndicatorMarking: " << this->IndicatorMarking << "\n";
  os << indent << "IndicatorThreshold: " << this->IndicatorThreshold << "\n";
  os << indent << "IndicatorFraction: " << this->IndicatorFraction << "\n";
  os << indent << "ChordTolerance: " << this->ChordTolerance << "\n";
  os << indent << "NormalAngle: " << this->NormalAngle << "\n";
  os << indent << "CutFacets: " << this->CutFacets << "\n";
  os << indent << "KeepLayers: " << this->KeepLayers << "\n";
  os << indent << "ProjectNewVertices: " << this->ProjectNewVertices << "\n";
  os << indent << "Balance: " << this->Balance << "\n";
}
