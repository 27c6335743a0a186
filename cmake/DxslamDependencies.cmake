# Every third-party package, found once. docs/dependencies.md says why each is here.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(PNG 1.6 REQUIRED)
find_package(JPEG REQUIRED)
# Debian's package for CMake names files of another package and says so at length.
find_path(OPENEXR_INCLUDE ImfInputFile.h PATH_SUFFIXES OpenEXR REQUIRED)
find_path(IMATH_INCLUDE ImathBox.h PATH_SUFFIXES Imath REQUIRED)
find_library(OPENEXR_LIBRARY OpenEXR REQUIRED)
add_library(dxslam_openexr INTERFACE)
target_include_directories(dxslam_openexr SYSTEM INTERFACE ${OPENEXR_INCLUDE} ${IMATH_INCLUDE})
target_link_libraries(dxslam_openexr INTERFACE ${OPENEXR_LIBRARY})
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)

# OpenVINO comes as the pinned wheel in .venv (scripts/setup); it carries its own CMake package.
file(GLOB DXSLAM_OPENVINO_CMAKE ${CMAKE_SOURCE_DIR}/.venv/lib/python3*/site-packages/openvino/cmake)
find_package(OpenVINO REQUIRED CONFIG COMPONENTS Runtime
             PATHS ${DXSLAM_OPENVINO_CMAKE} $ENV{OpenVINO_DIR} NO_DEFAULT_PATH)

option(DXSLAM_STATIC_OPENCV "Link OpenCV statically (needs scripts/build_opencv)" OFF)
if(DXSLAM_STATIC_OPENCV)
  include(DxslamStaticOpenCV)
else()
  find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc features2d calib3d)
endif()

if(DXSLAM_BUILD_TESTS)
  find_package(GTest 1.12 REQUIRED)
endif()
