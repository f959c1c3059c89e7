# How every room is built, so that a room's own CMakeLists.txt only lists what is in it.

# holdfast_room(NAME SOURCES ... [LINKS ...] [PRIVATE_LINKS ...])
# A static library holdfast_NAME, alias holdfast::NAME, headers in include/.
function(holdfast_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  set(target holdfast_${name})
  add_library(${target} STATIC ${ROOM_SOURCES})
  add_library(holdfast::${name} ALIAS ${target})
  target_include_directories(${target} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/include
                             PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # The same bits with every compiler and level: no fused multiply-add.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  target_link_libraries(${target} PUBLIC ${ROOM_LINKS} PRIVATE ${ROOM_PRIVATE_LINKS})
  if(HOLDFAST_BUILD_TESTS)
    holdfast_check_headers(${name})
  endif()
endfunction()

# Freestanding rooms run on a microcontroller.
function(holdfast_freestanding name)
  target_compile_options(holdfast_${name} PRIVATE -fno-exceptions -fno-rtti)
endfunction()

# Every public header compiles alone: one generated source per header.
function(holdfast_check_headers name)
  file(GLOB_RECURSE headers RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/include CONFIGURE_DEPENDS
       ${CMAKE_CURRENT_SOURCE_DIR}/include/*.hpp)
  set(sources)
  foreach(header IN LISTS headers)
    string(MAKE_C_IDENTIFIER ${header} stem)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/headers/${stem}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n")
    list(APPEND sources ${source})
  endforeach()
  add_library(holdfast_${name}_headers OBJECT ${sources})
  target_link_libraries(holdfast_${name}_headers PRIVATE holdfast::${name})
endfunction()

# holdfast_test(NAME SOURCES ... LINKS ...): one test program, its tests found by ctest.
function(holdfast_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;LINKS" ${ARGN})
  if(NOT HOLDFAST_BUILD_TESTS)
    return()
  endif()
  add_executable(${name} ${TEST_SOURCES})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support)
  target_link_libraries(${name} PRIVATE ${TEST_LINKS} GTest::gtest_main)
  gtest_discover_tests(${name} PROPERTIES TIMEOUT 300)
endfunction()
