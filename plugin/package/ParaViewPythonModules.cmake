# To be included before find_package(ParaView).
#
# Debian 13 names ParaView's Python modules with the suffix of their ABI (vtkCommonCore.cpython-313-x86_64-linux-gnu.so),
# which paraview-dev's CMake files leave out: find_package(ParaView) then ends with an error about files that do not
# exist. Nobody links to these modules, so the check is switched off for each of them, by the variable that makes
# CMake's export files pass over a target which they have taken for a framework of macOS.
file(GLOB files
  "/usr/lib/*/cmake/paraview-*/*Python*-targets.cmake" "/usr/lib/*/cmake/paraview-*/vtk/*Python*-targets.cmake")
foreach (file IN LISTS files)
  file(STRINGS "${file}" lines REGEX "^add_library\\([^ ]+ MODULE IMPORTED\\)")
  foreach (line IN LISTS lines)
    string(REGEX REPLACE "^add_library\\(([^ ]+) .*" "\\1" target "${line}")
    set("_cmake_import_check_xcframework_for_${target}" "/usr")
  endforeach ()
endforeach ()
unset(files)
