cadrefine_geom_test(nurbs_tests
  SOURCES
    nurbs/TestBezier.cxx
    nurbs/TestBruteForce.cxx
    nurbs/TestClosedForms.cxx
    nurbs/TestContract.cxx
  LINKS CADRefineFloatingPoint CADRefineNurbs)
