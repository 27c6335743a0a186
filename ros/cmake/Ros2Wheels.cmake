# The target ros2_wheels: ROS 2's C API, messages and middleware, out of the wheels of .venvs/ros.
# find_package(rcl) cannot be used: the wheels' own CMake files name paths of the machine they were
# built on.
set(DXSLAM_ROS2_PREFIX ${CMAKE_CURRENT_LIST_DIR}/../../.venvs/ros CACHE PATH
    "The Python environment that holds the wheels of ROS 2")
cmake_path(NORMAL_PATH DXSLAM_ROS2_PREFIX)
if(NOT EXISTS ${DXSLAM_ROS2_PREFIX}/.stamp)
  message(FATAL_ERROR "${DXSLAM_ROS2_PREFIX} is missing, run scripts/setup --with-ros")
endif()
set(DXSLAM_ROS2_PYTHON ${DXSLAM_ROS2_PREFIX}/bin/python)

file(GLOB ROS2_INCLUDES ${DXSLAM_ROS2_PREFIX}/include/*)
file(GLOB ROS2_BUNDLED LIST_DIRECTORIES true
     ${DXSLAM_ROS2_PREFIX}/lib/python3.11/site-packages/ros_*.libs)
set(ROS2_LIBRARIES rcl rcl_yaml_param_parser rmw rcutils rosidl_runtime_c rosidl_typesupport_c
    rosidl_typesupport_cpp rosidl_typesupport_fastrtps_c rosidl_typesupport_fastrtps_cpp
    rosidl_typesupport_introspection_c rosidl_typesupport_introspection_cpp fastcdr)
foreach(PACKAGE builtin_interfaces diagnostic_msgs geometry_msgs nav_msgs rcl_interfaces
        rosgraph_msgs sensor_msgs service_msgs std_msgs std_srvs)
  foreach(PART generator_c typesupport_c typesupport_cpp typesupport_fastrtps_c typesupport_fastrtps_cpp
          typesupport_introspection_c typesupport_introspection_cpp)
    list(APPEND ROS2_LIBRARIES ${PACKAGE}__rosidl_${PART})
  endforeach()
  list(APPEND ROS2_PYTHON_LIBRARIES ${PACKAGE}__rosidl_generator_py)
endforeach()

# What the wheels' librcl pulls in are also its Python messages, and they want Python.
find_library(DXSLAM_PYTHON_LIBRARY python3.11 REQUIRED PATHS /usr/lib/x86_64-linux-gnu)
find_path(DXSLAM_PYTHON_INCLUDE Python.h REQUIRED PATHS /usr/include/python3.11)

add_library(ros2_wheels INTERFACE)
target_include_directories(ros2_wheels SYSTEM INTERFACE
  ${ROS2_INCLUDES} ${DXSLAM_ROS2_PREFIX}/include)  # the latter for fastcdr alone
target_link_directories(ros2_wheels INTERFACE ${DXSLAM_ROS2_PREFIX}/lib)
# The wheels' libraries name each other without a place. Only an old-style run path (RPATH) of the
# program is searched for libraries of libraries, too.
list(TRANSFORM ROS2_BUNDLED PREPEND "-Wl,-rpath," OUTPUT_VARIABLE ROS2_RPATHS)
target_link_options(ros2_wheels INTERFACE -Wl,--disable-new-dtags -Wl,--allow-shlib-undefined
                    -Wl,-rpath,${DXSLAM_ROS2_PREFIX}/lib ${ROS2_RPATHS})
target_link_libraries(ros2_wheels INTERFACE
  ${ROS2_LIBRARIES} -Wl,--no-as-needed ${DXSLAM_PYTHON_LIBRARY} -Wl,--as-needed)
