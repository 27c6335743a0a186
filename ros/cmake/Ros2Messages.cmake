# dxslam_ros2_messages(TARGET package folders...): a shared library with the C and C++ type support of
# our message packages, made anew when a message changes, and beside it, in the build folder's
# messages/python, the same packages for Python.
function(dxslam_ros2_messages TARGET)
  set(GENERATOR ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../ros2/generate_messages.py)
  set(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/messages)
  set(ROS2_MESSAGES_BUILD ${OUTPUT} PARENT_SCOPE)  # for tests: where the Python packages are
  add_library(${TARGET} SHARED)
  set(SOURCES)
  foreach(PACKAGE ${ARGN})
    file(GLOB INTERFACES CONFIGURE_DEPENDS ${PACKAGE}/msg/*.msg ${PACKAGE}/srv/*.srv)
    execute_process(COMMAND ${DXSLAM_ROS2_PYTHON} ${GENERATOR} --list ${PACKAGE} ${OUTPUT}
                    OUTPUT_VARIABLE LIST OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    string(REPLACE "\n" ";" LIST "${LIST}")
    set(MADE)
    set(PYTHON_SOURCES)
    foreach(LINE ${LIST})
      string(REGEX MATCH "^([^:]*):(.*)$" LINE ${LINE})
      set(KIND ${CMAKE_MATCH_1})
      set(SOURCE ${CMAKE_MATCH_2})
      list(APPEND MADE ${SOURCE})
      if(KIND MATCHES "^(c|cpp)$")
        list(APPEND SOURCES ${SOURCE})
      else()
        list(APPEND PYTHON_SOURCES ${SOURCE})
        set(MODULE ${KIND})
      endif()
    endforeach()
    cmake_path(GET PACKAGE FILENAME NAME)
    add_library(${MODULE} MODULE ${PYTHON_SOURCES})
    set_target_properties(${MODULE} PROPERTIES
      PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${OUTPUT}/python/${NAME})
    target_include_directories(${MODULE} SYSTEM PRIVATE ${DXSLAM_PYTHON_INCLUDE}
      ${DXSLAM_ROS2_PREFIX}/lib/python3.11/site-packages/numpy/_core/include)
    target_compile_options(${MODULE} PRIVATE -w)
    target_link_libraries(${MODULE} PRIVATE ${TARGET} ${ROS2_PYTHON_LIBRARIES})
    # ROS looks for each kind of type support in a library of its own; all are in ours.
    foreach(SUPPORT fastrtps_c fastrtps_cpp introspection_c introspection_cpp)
      file(CREATE_LINK lib${TARGET}.so
           ${CMAKE_CURRENT_BINARY_DIR}/lib${NAME}__rosidl_typesupport_${SUPPORT}.so SYMBOLIC)
    endforeach()
    add_custom_command(
      OUTPUT ${MADE} COMMAND ${DXSLAM_ROS2_PYTHON} ${GENERATOR} ${PACKAGE} ${OUTPUT} > ${OUTPUT}/${NAME}.log
      DEPENDS ${INTERFACES} ${GENERATOR} ${DXSLAM_ROS2_PREFIX}/.stamp
      COMMENT "Generating the messages of ${NAME}" VERBATIM)
  endforeach()
  file(MAKE_DIRECTORY ${OUTPUT})
  target_sources(${TARGET} PRIVATE ${SOURCES})
  set_target_properties(${TARGET} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  # Generated code is not ours to mend: no warnings, and no optimisation worth waiting for.
  target_compile_options(${TARGET} PRIVATE -w)
  target_include_directories(${TARGET} SYSTEM PUBLIC ${OUTPUT}/include PRIVATE
    ${OUTPUT}/rosidl_typesupport_introspection_c ${OUTPUT}/rosidl_typesupport_introspection_cpp)
  target_link_libraries(${TARGET} PUBLIC ros2_wheels)
endfunction()
