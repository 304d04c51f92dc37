# The library of filters, CADRefine::Filters, with what it is made of. It is shared, so that plugin, Python and C++
# programs have the same classes in one process; its parts are static, and not seen outside.
# (filters/CMakeLists.txt is that of the VTK module.)
set(BUILD_SHARED_LIBS ON)

add_subdirectory(filters/parallel)
add_subdirectory(filters/distributed)
add_subdirectory(filters/steps)

vtk_module_scan(
  MODULE_FILES "${CMAKE_SOURCE_DIR}/filters/vtk.module"
  REQUEST_MODULES CADRefine::Filters
  PROVIDES_MODULES modules
  REQUIRES_MODULES required_modules
  HIDE_MODULES_FROM_CACHE ON
  ENABLE_TESTS OFF)

# cadrefine_require_modules(<module>...): those of VTK and ParaView that are built upon.
function (cadrefine_require_modules)
  foreach (module IN LISTS ARGN)
    if (NOT TARGET "${module}")
      message(FATAL_ERROR "ParaView was built without the module ${module}")
    endif ()
  endforeach ()
endfunction ()
cadrefine_require_modules(${required_modules})

vtk_module_build(
  MODULES ${modules}
  PACKAGE CADRefineFilters
  INSTALL_EXPORT CADRefineFilters
  HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/cadrefine/filters"
  CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/CADRefine"
  HIERARCHY_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/CADRefine/hierarchy")
