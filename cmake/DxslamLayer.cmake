include(GoogleTest)

# dxslam_share_headers(TARGET): with DXSLAM_QUICK_BUILD, TARGET gets the headers below precompiled.
# The core, first in line, compiles them; sources still include all that they use, and the presets
# for development build without.
function(dxslam_share_headers TARGET)
  if(NOT DXSLAM_QUICK_BUILD)
    return()
  elseif("${TARGET}" STREQUAL "dxslam_core")
    target_precompile_headers(${TARGET} PRIVATE
      <Eigen/Core> <Eigen/Geometry> <opencv2/core.hpp> <fmt/format.h>
      <algorithm> <cmath> <memory> <optional> <string> <vector>)
  else()
    target_precompile_headers(${TARGET} REUSE_FROM dxslam_core)
  endif()
endfunction()

# dxslam_layer(NAME DEPENDS targets...): one library from the sources in src/NAME and its folders
# and, from *_test.cpp beside them, one test program NAME_test. Headers are included as
# "NAME/folder/header.h".
function(dxslam_layer NAME)
  cmake_parse_arguments(ARG "" "" "DEPENDS;TEST_DEPENDS" ${ARGN})
  file(GLOB SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp
       ${CMAKE_CURRENT_SOURCE_DIR}/*/*.cpp)
  set(TESTS ${SOURCES})
  list(FILTER SOURCES EXCLUDE REGEX "_test\\.cpp$")
  list(FILTER TESTS INCLUDE REGEX "_test\\.cpp$")

  if(SOURCES)
    add_library(dxslam_${NAME} STATIC ${SOURCES})
    set(SCOPE PUBLIC)
    target_link_libraries(dxslam_${NAME} PRIVATE dxslam_warnings)
    dxslam_share_headers(dxslam_${NAME})
  else()
    add_library(dxslam_${NAME} INTERFACE)
    set(SCOPE INTERFACE)
  endif()
  target_include_directories(dxslam_${NAME} ${SCOPE} ${CMAKE_SOURCE_DIR}/src)
  target_link_libraries(dxslam_${NAME} ${SCOPE} ${ARG_DEPENDS})

  if(DXSLAM_BUILD_TESTS AND TESTS)
    add_executable(${NAME}_test ${TESTS})
    target_link_libraries(${NAME}_test PRIVATE dxslam_${NAME} ${ARG_TEST_DEPENDS} dxslam_warnings
                          GTest::gmock GTest::gtest_main)
    dxslam_share_headers(${NAME}_test)
    target_compile_options(${NAME}_test PRIVATE $<$<BOOL:${DXSLAM_QUICK_BUILD}>:-O1>)
    target_compile_definitions(${NAME}_test PRIVATE DXSLAM_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
    gtest_discover_tests(${NAME}_test TEST_PREFIX ${NAME}. DISCOVERY_TIMEOUT 120
                         WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
  endif()
endfunction()
