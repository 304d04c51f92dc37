cadrefine_geom_test(exact_tests
  SOURCES
    exact/BoundingBlocks.cxx
    exact/ModelList.cxx
    exact/OccOracle.cxx
    exact/SamplePoints.cxx
    exact/WholeModelTest.cxx
  LINKS CADRefineFloatingPoint CADRefineTestSupport TKGeomBase TKShHealing
  SLOW "data_aeroplane_igs|packaged_(terrain_brep|shell1_brep|bearing_iges|MAT_brep)"
  PACKAGED "/packaged_")
target_include_directories(exact_tests PRIVATE nurbs)
