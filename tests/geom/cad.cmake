cadrefine_geom_test(cad_tests
  SOURCES
    cad/AeroplaneTest.cxx
    cad/AnalyticShapesTest.cxx
    cad/CurveModelTest.cxx
    cad/FileErrorsTest.cxx
    cad/GapsTest.cxx
    cad/IgesCurvesTest.cxx
    cad/IgesRepairTest.cxx
    cad/IgesStatusTest.cxx
    cad/IgesSurfacesTest.cxx
    cad/IsolatedRunTest.cxx
    cad/AttributesTest.cxx
    cad/LossTest.cxx
    cad/ModelBytesTest.cxx
    cad/NakedFacesTest.cxx
    cad/RealFilesTest.cxx
    cad/SurfaceConversionTest.cxx
    cad/TessellationTest.cxx
    cad/UnitsTest.cxx
    cad/UnreadTest.cxx
  LINKS CADRefineFloatingPoint CADRefineTestSupport CADRefineReaders
  PACKAGED "RealFiles[.]")
target_compile_definitions(cad_tests PRIVATE CADREFINE_TEST_READER="$<TARGET_FILE:cad_test_reader>")
add_dependencies(cad_tests cad_test_reader)

# What is read of CAD files, beside what Open CASCADE's plain reader reads: for any folder, see cad_files.py.
add_executable(cad_file_probe cad/CADFileProbe.cxx)
target_include_directories(cad_file_probe SYSTEM PRIVATE ${OpenCASCADE_INCLUDE_DIR})
target_link_libraries(cad_file_probe PRIVATE CADRefineCad CADRefineWarnings
  ${CADREFINE_IGES} ${CADREFINE_STEP} TKXSBase TKPrim TKTopAlgo TKBRep)
add_dependencies(cad_file_probe cadrefine-read-cad)
add_test(NAME cad_files COMMAND /usr/bin/python3 -B "${CMAKE_CURRENT_SOURCE_DIR}/cad_files.py" --all
  $<TARGET_FILE:cad_file_probe> "${CMAKE_SOURCE_DIR}/data" /usr/share/opencascade/data/iges
  /usr/share/opencascade/data/step)
set_tests_properties(cad_files PROPERTIES LABELS "unit;packaged" TIMEOUT 300)
