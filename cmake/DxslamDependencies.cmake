# Every third-party package, found once. docs/dependencies.md says why each is here.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc imgcodecs features2d calib3d)
# Ceres takes SuiteSparse to be built with TBB wherever TBB is installed. Debian's is not, and linking
# Debian's TBB directly would compete with the one that OpenVINO brings along.
set(CMAKE_DISABLE_FIND_PACKAGE_TBB ON)
find_package(Ceres 2.1 REQUIRED)
set(CMAKE_DISABLE_FIND_PACKAGE_TBB OFF)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)

# OpenVINO comes as the pinned wheel in .venv (scripts/setup); it carries its own CMake package.
file(GLOB DXSLAM_OPENVINO_CMAKE ${CMAKE_SOURCE_DIR}/.venv/lib/python3*/site-packages/openvino/cmake)
find_package(OpenVINO REQUIRED CONFIG COMPONENTS Runtime
             PATHS ${DXSLAM_OPENVINO_CMAKE} $ENV{OpenVINO_DIR} NO_DEFAULT_PATH)

if(DXSLAM_BUILD_TESTS)
  find_package(GTest 1.12 REQUIRED)
endif()
