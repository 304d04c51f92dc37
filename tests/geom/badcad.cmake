# Damaged CAD files: a test with a part of them, and a program that reads many and prints a table.
add_library(badcad STATIC
  badcad/BadIges.cxx
  badcad/BadShapes.cxx
  badcad/BadSplines.cxx
  badcad/BadTexts.cxx
  badcad/Mutation.cxx
  badcad/ReadProbe.cxx
  badcad/ShapeText.cxx
  badcad/Tally.cxx)
target_include_directories(badcad PUBLIC badcad)
target_link_libraries(badcad PUBLIC CADRefineTestSupport PRIVATE CADRefineWarnings)

add_executable(badcad_table badcad/BadCADTable.cxx)
target_link_libraries(badcad_table PRIVATE badcad CADRefineWarnings)

# Files by the hundred are slow.
set(programs "igesMadeByPrograms|splinesInStepAndBrep|brepMadeByPrograms|binaryBrep|cutOffInEachLine")
set(mutations "endWell/.*/(naca0012_sharp|cylinder|DTMB[^/]*|screw|wing)[.]")
cadrefine_geom_test(badcad_tests SOURCES badcad/BadCADTest.cxx LINKS badcad
  SLOW "${programs}|soundFacesAreNotLost|manyPatchesInOnePlace|${mutations}"
  PACKAGED "endWell/.*/usr/share")
