cadrefine_geom_test(cad_tests
  SOURCES
    cad/AeroplaneTest.cxx
    cad/AnalyticShapesTest.cxx
    cad/CurveModelTest.cxx
    cad/FileErrorsTest.cxx
    cad/GapsTest.cxx
    cad/IgesCases.cxx
    cad/IgesCurvesTest.cxx
    cad/IgesRepairTest.cxx
    cad/IgesStatusTest.cxx
    cad/IgesSurfacesTest.cxx
    cad/IgesWriter.cxx
    cad/IsolatedRunTest.cxx
    cad/LooksTest.cxx
    cad/ModelBytesTest.cxx
    cad/NakedFacesTest.cxx
    cad/RealFilesTest.cxx
    cad/SurfaceConversionTest.cxx
    cad/TessellationTest.cxx
    cad/TestFiles.cxx
    cad/UnitsTest.cxx
    cad/UnreadTest.cxx
  LINKS CADRefineFloatingPoint CADRefineCad ${CADREFINE_IGES} ${CADREFINE_STEP} TKXSBase TKPrim TKBO TKTopAlgo TKBRep)
target_include_directories(cad_tests SYSTEM PRIVATE ${OpenCASCADE_INCLUDE_DIR})
