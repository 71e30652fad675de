# What all of our own targets share: warnings as errors, sanitizers, coverage, ccache.

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

add_library(skincal_options INTERFACE)
target_compile_options(skincal_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-align -Woverloaded-virtual
  -Wnull-dereference -Wdouble-promotion -Wformat=2 -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports these inside Eigen and libstdc++ when it inlines them into our code.
  target_compile_options(skincal_options INTERFACE
    -Wno-null-dereference -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict)
endif()
target_include_directories(skincal_options INTERFACE ${CMAKE_SOURCE_DIR})
if(SKINCAL_SANITIZE)
  target_compile_options(skincal_options INTERFACE -fsanitize=${SKINCAL_SANITIZE} -fno-omit-frame-pointer
    $<IF:$<BOOL:${SKINCAL_FUZZ}>,-fno-sanitize-recover=all,-fno-sanitize-recover=undefined>)
  # Eigen aligns by itself under the address sanitizer, and what Ceres, which is built without, allocates with malloc was
  # freed otherwise. Everybody's malloc is aligned well enough here.
  target_compile_definitions(skincal_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
  target_link_options(skincal_options INTERFACE -fsanitize=${SKINCAL_SANITIZE})
endif()
if(SKINCAL_COVERAGE)
  target_compile_options(skincal_options INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(skincal_options INTERFACE --coverage)
endif()

# One precompiled header for everything in core: Eigen and the standard library are in every file.
function(skincal_precompile target)
  if(NOT SKINCAL_FUZZ)
    target_precompile_headers(${target} PRIVATE
      <Eigen/Dense> <Eigen/Geometry> <algorithm> <cmath> <filesystem> <map> <optional> <random> <span> <string>
      <vector> <tl/expected.hpp>)
  endif()
endfunction()

# skincal_core_library(skin SOURCES … PUBLIC … PRIVATE …): the library skincal::skin in core/skin.
function(skincal_core_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(skincal_${name} STATIC ${ARG_SOURCES})
  add_library(skincal::${name} ALIAS skincal_${name})
  target_link_libraries(skincal_${name} PUBLIC ${ARG_PUBLIC} PRIVATE skincal_options ${ARG_PRIVATE})
  target_include_directories(skincal_${name} PUBLIC ${CMAKE_SOURCE_DIR})
  skincal_precompile(skincal_${name})
endfunction()

# skincal_test(unit_skin SOURCES … LIBRARIES …): one GoogleTest program, each case a ctest test.
function(skincal_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LIBRARIES" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE skincal_options ${ARG_LIBRARIES} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE SKINCAL_TEST_DATA="${CMAKE_SOURCE_DIR}/tests/data"
    SKINCAL_RESOURCES="${CMAKE_SOURCE_DIR}/resources")
  skincal_precompile(${name})
  gtest_discover_tests(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} DISCOVERY_TIMEOUT 60)
endfunction()
