cadrefine_geom_test(mesh_tests
  SOURCES
    mesh/CellJacobianTest.cxx
    mesh/CellSizeTest.cxx
    mesh/EdgeTableTest.cxx
    mesh/FacetsTest.cxx
    mesh/OrientationTest.cxx
    mesh/OverlapTest.cxx
    mesh/PieceLimitTest.cxx
    mesh/QuadTableTest.cxx
    mesh/QualitySummaryTest.cxx
    mesh/QualityTest.cxx
    mesh/RadixOrderTest.cxx
  LINKS CADRefineFloatingPoint CADRefineTestSupport)
