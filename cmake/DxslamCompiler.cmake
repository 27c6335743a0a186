# Language level, warnings and sanitizers, the same for every target.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})

option(DXSLAM_WERROR "Treat warnings as errors" ON)
option(DXSLAM_TIDY "Run clang-tidy while compiling" OFF)
option(DXSLAM_BUILD_TESTS "Build the unit tests" ON)
option(DXSLAM_QUICK_BUILD "Precompile shared headers and optimise the command line less" OFF)
set(DXSLAM_SANITIZE "" CACHE STRING "Value for -fsanitize, e.g. address,undefined")

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()
find_program(MOLD_PROGRAM mold)
if(MOLD_PROGRAM)
  add_link_options(-fuse-ld=mold)
endif()
if(DXSLAM_QUICK_BUILD)  # Precompiled headers want the same flags everywhere: no -fPIE for programs.
  set(CMAKE_POSITION_INDEPENDENT_CODE OFF)
  add_compile_options(-fPIC -fpch-preprocess)
  if(CCACHE_PROGRAM)
    set(CMAKE_CXX_COMPILER_LAUNCHER
        ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
  endif()
endif()
if(DXSLAM_TIDY)
  find_program(CLANG_TIDY_PROGRAM NAMES clang-tidy-19 REQUIRED)
  set(CMAKE_CXX_CLANG_TIDY ${CLANG_TIDY_PROGRAM} --quiet)
endif()
if(DXSLAM_SANITIZE)  # Cheap to build, with the assertions of Eigen and of the standard library.
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1 -D_GLIBCXX_ASSERTIONS")
  add_compile_options(-fsanitize=${DXSLAM_SANITIZE} -fno-sanitize-recover=all
                      -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${DXSLAM_SANITIZE})
endif()

add_library(dxslam_warnings INTERFACE)
target_compile_options(dxslam_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wcast-align -Woverloaded-virtual
  $<$<BOOL:${DXSLAM_WERROR}>:-Werror>)
# GCC 12 guesses these from optimised code, and is wrong about std::string depending on what it happened
# to inline (GCC bug 105329), so the same source passes in one folder and fails in another.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(dxslam_warnings INTERFACE
    -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread
    -Wno-maybe-uninitialized -Wno-free-nonheap-object)
endif()
