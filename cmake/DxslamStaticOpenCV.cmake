# OpenCV linked statically, for the Python wheel: Debian's shared libraries would bring X11, gfortran and
# 20 others along. All is Debian's own but the core, which scripts/build_opencv builds anew.
find_path(OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
find_library(OPENCV_CORE libopencv_core.a PATHS ${CMAKE_SOURCE_DIR}/.cache/opencv REQUIRED
             NO_DEFAULT_PATH)
find_package(ZLIB REQUIRED)
# As in the program, OpenCV shares OpenVINO's threads.
get_target_property(OPENVINO_LIBRARY openvino::runtime IMPORTED_LOCATION_RELEASE)
get_filename_component(OPENVINO_FOLDER ${OPENVINO_LIBRARY} DIRECTORY)
file(GLOB OPENCV_TBB ${OPENVINO_FOLDER}/libtbb.so.12)

add_library(opencv_core STATIC IMPORTED)
set_target_properties(opencv_core PROPERTIES IMPORTED_LOCATION ${OPENCV_CORE})
target_include_directories(opencv_core SYSTEM INTERFACE ${OPENCV_INCLUDE})
target_link_libraries(opencv_core INTERFACE ZLIB::ZLIB ${OPENCV_TBB} Threads::Threads ${CMAKE_DL_LIBS})

# dxslam_static_opencv(MODULE modules it needs...)
function(dxslam_static_opencv MODULE)
  find_library(OPENCV_${MODULE} libopencv_${MODULE}.a REQUIRED)
  add_library(opencv_${MODULE} STATIC IMPORTED)
  set_target_properties(opencv_${MODULE} PROPERTIES IMPORTED_LOCATION ${OPENCV_${MODULE}})
  list(TRANSFORM ARGN PREPEND opencv_)
  target_link_libraries(opencv_${MODULE} INTERFACE ${ARGN})
endfunction()
dxslam_static_opencv(imgproc core)
dxslam_static_opencv(flann core)
dxslam_static_opencv(features2d flann imgproc)
dxslam_static_opencv(calib3d features2d flann imgproc)
