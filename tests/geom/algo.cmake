if (NOT TARGET CADRefineTestSupport)
  add_subdirectory("${CMAKE_SOURCE_DIR}/tests/support" "${CMAKE_BINARY_DIR}/tests/support")
endif ()

cadrefine_geom_test(algo_tests
  SOURCES
    algo/BisectionTest.cxx
    algo/BoundaryProjectorTest.cxx
    algo/CurvedErrorTest.cxx
    algo/FaceFinderTest.cxx
    algo/GeometricErrorTest.cxx
    algo/LongestEdgeMarkingTest.cxx
    algo/MidNodeGuardTest.cxx
    algo/MoveGuardTest.cxx
    algo/PatchOptimiserTest.cxx
    algo/ShapeEnergyTest.cxx
    algo/UniformSplitTest.cxx
  LINKS CADRefineFloatingPoint CADRefineTestSupport)
