cadrefine_geom_test(nurbs_tests
  SOURCES
    nurbs/BezierTest.cxx
    nurbs/BruteForceTest.cxx
    nurbs/ClosedFormsTest.cxx
    nurbs/ContractTest.cxx
  LINKS CADRefineFloatingPoint CADRefineNurbs)
