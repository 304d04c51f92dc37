# The library of filters, CADRefine::Filters, with what it is made of. It is shared, so that plugin, Python and C++
# programs have the same classes in one process; its parts are static, and not seen outside.
# (filters/CMakeLists.txt is that of the VTK module.)
set(BUILD_SHARED_LIBS ON)

set(CADREFINE_VTK_HEADERS <vtkCellData.h> <vtkDoubleArray.h> <vtkMultiProcessController.h> <vtkNew.h> <vtkPointData.h>
  <vtkPolyData.h> <vtkUnstructuredGrid.h>)
cadrefine_precompiled_headers(CADRefineFilterHeaders LINKS VTK::CommonDataModel VTK::ParallelCore
  HEADERS ${CADREFINE_VTK_HEADERS})

# cadrefine_filters_library(<folder> SOURCES ... DEPENDS ...): CADRefineFilters<Folder>, static, so that the module and
# the tests link it without exporting its classes. Its headers are included as "FOLDER/Name.h".
function (cadrefine_filters_library folder)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  cadrefine_library_name(name CADRefineFilters ${folder})
  add_library(${name} STATIC ${arg_SOURCES})
  target_include_directories(${name} PUBLIC "${CMAKE_SOURCE_DIR}/filters")
  target_link_libraries(${name} PUBLIC ${arg_DEPENDS} PRIVATE CADRefineWarnings ${arg_PRIVATE_DEPENDS})
  target_precompile_headers(${name} REUSE_FROM CADRefineFilterHeaders)
endfunction ()

# Each sees only those above it.
foreach (folder IN ITEMS comm mesh fields balancing cad classification motion projection error refinement quadratic
    operations pipeline formats)
  add_subdirectory(filters/${folder})
endforeach ()

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
