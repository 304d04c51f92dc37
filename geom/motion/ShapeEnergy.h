// How badly shaped the cells round a vertex are, as a function of where the vertex is.
#pragma once

#include <cadrefine/base/Vector3.h>

#include <array>
#include <optional>
#include <vector>

namespace cadrefine
{

/// Directions in which a vertex may move: orthonormal, the first `count` of them.
struct Directions
{
  std::array<Vector3, 3> axes{};
  int count = 0;

  static Directions everywhere();
  /// The two directions across `normal`, which need not have length 1; none where it is zero.
  static Directions across(const Vector3& normal);
  static Directions along(const Vector3& tangent);
};

/// The sum of the squares, or of a higher power, of the regularised inverse mean ratios of the
/// cells round a vertex x:
///
///     eta = L(x) / h(s(x))^p,     h(s) = (s + sqrt(s^2 + 4 delta^2)) / 2,
///
/// with L the sum of a cell's squared edge lengths and s its signed measure, both scaled so that
/// eta is 1 for an equilateral cell; p is 2/3 for tetrahedra, 1 for triangles. A simplex that is to
/// keep the shape of a reference is measured in the same way against this: with weights in L that
/// make eta the squared norm of the map from the reference, over its determinant to the power p,
/// which is 1 where the map is a scaled rotation. With delta = 0 it is
/// infinite where a cell is inverted or flat; with delta > 0 it is finite and smooth, and inverted
/// cells pull x to where they are valid (J. M. Escobar, E. Rodriguez, R. Montenegro, G. Montero,
/// J. M. Gonzalez-Yuste, "Simultaneous untangling and smoothing of tetrahedral meshes", CMAME 192,
/// 2003). The higher the power, the more the worst cell counts. L is quadratic and s linear in x,
/// so that derivatives are closed forms. Work linear in the number of cells.
class ShapeEnergy
{
public:
  /// The energy of tetrahedra (`dimension` 3) or triangles (2), none of them added yet.
  explicit ShapeEnergy(int dimension) : dimension_(dimension) {}

  /// Adds a tetrahedron (a, b, c, x), in VTK's order; `delta` is in the unit of its measure s.
  void addTetrahedron(const Point3& a, const Point3& b, const Point3& c, double delta);
  /// Adds a triangle (a, b, x), seen from the end of the unit vector `normal`.
  void addTriangle(const Point3& a, const Point3& b, const Vector3& normal, double delta);
  /// Adds simplices that are to have the shape of `reference`, in the same order, x last. Against a
  /// reference that is inverted or flat they are to be equilateral.
  void addTetrahedron(const Point3& a, const Point3& b, const Point3& c, double delta,
    const std::array<Point3, 4>& reference);
  void addTriangle(const Point3& a, const Point3& b, const Vector3& normal, double delta,
    const std::array<Point3, 3>& reference);

  double at(const Point3& x) const;
  /// The largest regularised inverse mean ratio of a cell with the vertex at x.
  double largestAt(const Point3& x) const;
  /// Sets the exponent of the inverse mean ratios: a power of two.
  void setExponent(int exponent) { exponent_ = exponent; }

  /// A step of Newton's method from x in the given directions, with a shift where the second
  /// derivatives are not positive definite, no longer than half of the distance to the farthest
  /// vertex of a cell; zero where there is nothing to gain.
  Vector3 step(const Point3& x, const Directions& directions) const;

private:
  /// What a cell adds to the energy.
  struct Term
  {
    std::array<Point3, 3> others;
    double otherLengths = 0; ///< Squared lengths of the edges away from x, by their weights.
    Vector3 slope{};         ///< s = slope . (x - others[0]).
    double delta = 0;
    std::array<double, 3> weights{ 1, 1, 1 }; ///< Of the squared lengths of the edges at x.
  };
  struct Derivatives
  {
    Vector3 gradient{};
    std::array<Vector3, 3> hessian{};
  };

  double lengths(const Term& term, const Point3& x) const;
  double inverseRatioOf(const Term& term, const Point3& x) const;
  double raised(double eta) const;
  Derivatives derivativesAt(const Point3& x) const;

  int dimension_;
  int exponent_ = 2;
  std::vector<Term> terms_;
};

/// The delta of ShapeEnergy for cells of which this is the smallest measure (1: equilateral,
/// negative: inverted), in terms of the size of a cell; 0 where no cell is nearly flat.
double regularisation(double smallestMeasure);

/// The measure s (see ShapeEnergy) of the equilateral cell with this sum of squared edge lengths.
double equilateralMeasure(int dimension, double squaredLengths);

} // namespace cadrefine
