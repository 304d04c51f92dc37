if (NOT TARGET CADRefineTestSupport)
  add_subdirectory("${CMAKE_SOURCE_DIR}/tests/support" "${CMAKE_BINARY_DIR}/tests/support")
endif ()

cadrefine_geom_test(mesh_tests
  SOURCES
    mesh/CellJacobianTest.cxx
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
