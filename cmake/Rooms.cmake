# How every room is built, so that a room's own CMakeLists.txt only lists what is in it.

# holdfast_same_bits(TARGET): the same bits with every compiler and level. No fused multiply-add;
# and not the part of g++'s vectoriser that loses roundings: g++ 12.2 takes the conversion of two
# doubles to float and back for none at all, from -O2 on (libs/base/test/rounding_test.cpp). For all
# that is compiled here, as functions of headers are compiled anew everywhere and the linker keeps
# any one of them.
function(holdfast_same_bits target)
  target_compile_options(${target} PRIVATE
    -ffp-contract=off $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
endfunction()

# holdfast_room(NAME HEADERS ... [SOURCES ...] [LINKS ...] [PRIVATE_LINKS ...])
# A static library holdfast_NAME, alias holdfast::NAME; without SOURCES only its headers. HEADERS
# are below include/holdfast/NAME/; that each of them compiles alone is checked by the target
# all_verify_interface_header_sets.
function(holdfast_room name)
  cmake_parse_arguments(ROOM "" "" "HEADERS;SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  set(target holdfast_${name})
  list(TRANSFORM ROOM_HEADERS PREPEND include/holdfast/${name}/)
  set_property(GLOBAL APPEND PROPERTY HOLDFAST_ROOMS ${name})
  set(kind STATIC)
  set(scope PUBLIC)
  if(NOT ROOM_SOURCES)
    set(kind INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(${target} ${kind} ${ROOM_SOURCES})
  add_library(holdfast::${name} ALIAS ${target})
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS include FILES ${ROOM_HEADERS})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_link_libraries(${target} ${scope} ${ROOM_LINKS})
  set_target_properties(${target} PROPERTIES
    VERIFY_INTERFACE_HEADER_SETS "${HOLDFAST_BUILD_TESTS}")
  if(ROOM_SOURCES)
    target_include_directories(${target} PRIVATE src)
    target_link_libraries(${target} PRIVATE ${ROOM_PRIVATE_LINKS})
    holdfast_same_bits(${target})
    holdfast_compiled_together(${target})
    if(HOLDFAST_INSTALL OR HOLDFAST_BUILD_PYTHON)
      # Shared libraries are made of the same objects. Nobody replaces functions within it.
      set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
      target_compile_options(${target} PRIVATE
        $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
    endif()
  endif()
endfunction()

set(HOLDFAST_COMPILES_TOGETHER OFF)
if(CMAKE_BUILD_TYPE MATCHES "^(Release|None)$" OR CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(HOLDFAST_COMPILES_TOGETHER ON)
endif()

# holdfast_compiled_together(TARGET): eight files at a time, as half and more of what a file takes
# to compile is its headers. Names in unnamed namespaces are therefore one room's, not one file's.
# Not in the preset `dev`: ./dev lint looks at each file.
function(holdfast_compiled_together target)
  if(HOLDFAST_COMPILES_TOGETHER)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON)
    # g++ takes a file that is included for a header.
    target_compile_options(${target} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# Freestanding rooms run on a microcontroller.
function(holdfast_freestanding name)
  target_compile_options(holdfast_${name} PRIVATE -fno-exceptions -fno-rtti)
endfunction()

# Tests take longer to compile than what they test, so they are optimised less, and the headers that
# all of them include are compiled once. A compiler's launcher, ccache, knows the files one by one
# and does without, so that it also finds a test that includes too little.
function(holdfast_test_quickly_compiled target level)
  target_compile_options(${target} PRIVATE ${level})
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    return()
  endif()
  set(headers holdfast_test_headers${level})
  if(NOT TARGET ${headers})
    set(empty ${CMAKE_BINARY_DIR}/${headers}.cpp)
    file(CONFIGURE OUTPUT ${empty} CONTENT "")
    add_library(${headers} OBJECT ${empty})
    holdfast_same_bits(${headers})
    target_compile_options(${headers} PRIVATE ${level})
    target_link_libraries(${headers} PRIVATE GTest::gtest_main)
    target_precompile_headers(${headers} PRIVATE <gtest/gtest.h> <algorithm> <array> <cmath>
      <filesystem> <fstream> <functional> <map> <memory> <numeric> <optional> <random> <ranges>
      <set> <span> <sstream> <string> <string_view> <vector>)
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Of strings in precompiled headers GCC 12 says what is not so, as -Wrestrict does anywhere.
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow)
  endif()
endfunction()

# holdfast_test(NAME [LONG] SOURCES ... [APART ...] LINKS ... [LABELS ...]): a test program, its
# tests found by ctest. As WebAssembly it is one test in all, as starting Node takes longer than
# most of them. What does not run LONG is compiled without optimisation under sanitizers, in half of
# the time; the rooms that it tests are compiled as always. Files whose names others have go APART.
function(holdfast_test name)
  cmake_parse_arguments(TEST "LONG" "" "SOURCES;APART;LINKS;LABELS" ${ARGN})
  if(NOT HOLDFAST_BUILD_TESTS)
    return()
  endif()
  add_executable(${name} ${TEST_SOURCES} ${TEST_APART})
  holdfast_same_bits(${name})
  holdfast_compiled_together(${name})
  set_source_files_properties(${TEST_APART} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support src)
  target_link_libraries(${name} PRIVATE ${TEST_LINKS} GTest::gtest_main)
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    if(TEST_LONG)
      holdfast_test_quickly_compiled(${name} -O1)
    else()
      holdfast_test_quickly_compiled(${name} -O0)
    endif()
  elseif(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT EMSCRIPTEN)
    holdfast_test_quickly_compiled(${name} -O1)
  endif()
  if(EMSCRIPTEN)
    target_compile_options(${name} PRIVATE -O1)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES TIMEOUT 600)
  else()
    gtest_discover_tests(${name} NO_PRETTY_VALUES PROPERTIES TIMEOUT 300 LABELS "${TEST_LABELS}")
  endif()
endfunction()
