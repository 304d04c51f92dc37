# Debian packages, by cpack: cadrefine (what people run) and cadrefine-dev (for C++).
install(FILES "${CMAKE_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/cadrefine" RENAME copyright COMPONENT runtime)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_NAME cadrefine)
set(CPACK_PACKAGE_VENDOR "CADRefine")
set(CPACK_PACKAGE_CONTACT "CADRefine developers <cadrefine@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# dpkg-shlibdeps adds the libraries, ParaView and Open CASCADE among them, with their versions.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME cadrefine)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "paraview, python3-paraview, python3-numpy, openmpi-bin")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "python3-matplotlib, python3-meshio, python3-h5py, python3-scipy, xvfb, xauth")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_LIST_DIR}/prerm")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME cadrefine-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "cadrefine (= ${PROJECT_VERSION}), libocct-data-exchange-dev, libgmp-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS paraview-dev)

include(CPack)
