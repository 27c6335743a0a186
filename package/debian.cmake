# `cpack -G DEB` in the build folder makes a Debian package of all that is installed.
set(DEBIAN ${CMAKE_CURRENT_SOURCE_DIR}/debian)
install(FILES ${DEBIAN}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${DEBIAN}/overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME dxslam)
configure_file(${DEBIAN}/changelog.in changelog @ONLY)
configure_file(${DEBIAN}/shlibs.in shlibs @ONLY)
configure_file(${DEBIAN}/dxslam.1 dxslam.1 COPYONLY)
find_program(GZIP_PROGRAM gzip REQUIRED)
execute_process(COMMAND ${GZIP_PROGRAM} -9nf changelog dxslam.1 COMMAND_ERROR_IS_FATAL ANY
                WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/dxslam.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME dxslam)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The dxslam authors <dxslam@example.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "visual SLAM with deep features for RGB-D cameras")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "A recording goes in; a trajectory, a map and a summary come out. The map can be\n\
saved, and the camera finds itself in it another day. Program and C++ library.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
    ${DEBIAN}/triggers ${CMAKE_CURRENT_BINARY_DIR}/shlibs)
# What program and library link is found by dpkg-shlibdeps; the others compile with the library.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${OPENVINO_FOLDER})
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libeigen3-dev, libopencv-dev")
include(CPack)
