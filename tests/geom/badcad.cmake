# Damaged CAD files: a test with a part of them, and a program that reads many and prints a table.
add_library(badcad STATIC
  badcad/BadIges.cxx
  badcad/BadShapes.cxx
  badcad/BadSplines.cxx
  badcad/BadTexts.cxx
  badcad/Mutation.cxx
  badcad/ReadProbe.cxx
  badcad/ShapeText.cxx
  badcad/Tally.cxx
  cad/IgesCases.cxx
  cad/IgesWriter.cxx
  cad/TestFiles.cxx)
target_include_directories(badcad PUBLIC badcad cad)
target_include_directories(badcad SYSTEM PUBLIC ${OpenCASCADE_INCLUDE_DIR})
target_link_libraries(badcad PUBLIC CADRefineCad ${data_exchange} TKXSBase TKPrim TKTopAlgo TKBRep GTest::gtest
  PRIVATE CADRefineWarnings)

add_executable(badcad_table badcad/BadCADTable.cxx)
target_link_libraries(badcad_table PRIVATE badcad CADRefineWarnings)

# Files by the hundred are slow.
set(slow BadCAD.igesMadeByPrograms BadCAD.splinesInStepAndBrep BadCAD.brepMadeByPrograms BadCAD.binaryBrep
  BadCAD.soundFacesAreNotLost BadCAD.manyPatchesInOnePlace)
foreach (file RANGE 2 6)
  list(APPEND slow Files/Mutations.endWell/${file})
endforeach ()
list(JOIN slow ":" slow)
cadrefine_geom_test(badcad_tests SOURCES badcad/BadCADTest.cxx LINKS badcad SLOW "${slow}")
