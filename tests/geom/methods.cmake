if (NOT TARGET CADRefineTestSupport)
  add_subdirectory("${CMAKE_SOURCE_DIR}/tests/support" "${CMAKE_BINARY_DIR}/tests/support")
endif ()

cadrefine_geom_test(method_tests
  SOURCES
    classification/BoundaryProjectorTest.cxx
    classification/FaceFinderTest.cxx
    classification/MidpointProjectionTest.cxx
    error/CurvedErrorTest.cxx
    error/GeometricErrorTest.cxx
    motion/CellStacksTest.cxx
    motion/MoveGuardTest.cxx
    motion/PatchOptimiserTest.cxx
    motion/ShapeEnergyTest.cxx
    motion/ThreadsTest.cxx
    operations/CoarseningTest.cxx
    operations/FieldRowsTest.cxx
    operations/ImprovementTest.cxx
    operations/OperationsTest.cxx
    operations/QualityCostTest.cxx
    operations/SplitSwapsTest.cxx
    operations/SurfaceRuleTest.cxx
    operations/TriangleImprovementTest.cxx
    operations/TriangleOperationsTest.cxx
    quadratic/CurvedCellsTest.cxx
    quadratic/MidNodeGuardTest.cxx
    quadratic/SerendipityCellsTest.cxx
    refinement/BisectionTest.cxx
    refinement/CellCuttingTest.cxx
    refinement/LongestEdgeMarkingTest.cxx
    refinement/MixedSplitTest.cxx
    refinement/UniformSplitTest.cxx
  LINKS CADRefineFloatingPoint CADRefineTestSupport)
