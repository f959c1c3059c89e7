# Emscripten: the libraries that holdfast needs, from Debian's packages, without the host's own
# headers and archives. /usr/include as a whole must not be seen, it is another machine's C library.

# find_header_folder(VARIABLE PATH PACKAGE): the host's folder that holds PATH; errors name PACKAGE.
function(find_header_folder variable path package)
  find_path(${variable} ${path} PATHS /usr/include /usr/include/eigen3 NO_DEFAULT_PATH
            NO_CMAKE_FIND_ROOT_PATH)
  if(NOT ${variable})
    message(FATAL_ERROR "${path} is not there: install ${package}")
  endif()
endfunction()

# The folders fmt and nlohmann alone, by links.
set(headers ${CMAKE_BINARY_DIR}/headers)
find_header_folder(HOLDFAST_EIGEN_INCLUDE Eigen/Core libeigen3-dev)
find_header_folder(HOLDFAST_FMT_INCLUDE fmt/format.h libfmt-dev)
find_header_folder(HOLDFAST_JSON_INCLUDE nlohmann/json.hpp nlohmann-json3-dev)
file(MAKE_DIRECTORY ${headers})
file(CREATE_LINK ${HOLDFAST_FMT_INCLUDE}/fmt ${headers}/fmt SYMBOLIC)
file(CREATE_LINK ${HOLDFAST_JSON_INCLUDE}/nlohmann ${headers}/nlohmann SYMBOLIC)

add_library(Eigen3::Eigen INTERFACE IMPORTED)
target_include_directories(Eigen3::Eigen INTERFACE ${HOLDFAST_EIGEN_INCLUDE})
add_library(fmt::fmt INTERFACE IMPORTED)
target_include_directories(fmt::fmt INTERFACE ${headers})
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
add_library(nlohmann_json::nlohmann_json INTERFACE IMPORTED)
target_include_directories(nlohmann_json::nlohmann_json INTERFACE ${headers})

# One thread: nothing to link.
add_library(Threads::Threads INTERFACE IMPORTED)

# Debian has pugixml only as an archive for the host; ./dev lays its source package here.
set(HOLDFAST_PUGIXML_SOURCE ${PROJECT_SOURCE_DIR}/build/pugixml/src CACHE PATH
    "Folder of pugixml.cpp (Emscripten only)")
if(NOT EXISTS ${HOLDFAST_PUGIXML_SOURCE}/pugixml.cpp)
  message(FATAL_ERROR "no pugixml.cpp in ${HOLDFAST_PUGIXML_SOURCE}: './dev page' lays it there")
endif()
add_library(pugixml STATIC ${HOLDFAST_PUGIXML_SOURCE}/pugixml.cpp)
target_compile_options(pugixml PRIVATE -w)
target_compile_definitions(pugixml PUBLIC PUGIXML_NO_EXCEPTIONS)
target_include_directories(pugixml SYSTEM PUBLIC ${HOLDFAST_PUGIXML_SOURCE})
add_library(pugixml::pugixml ALIAS pugixml)

add_compile_options(-include ${PROJECT_SOURCE_DIR}/cmake/wasm/missing.hpp)

# GoogleTest from Debian's sources; programs run under Node and read the repository's files.
if(HOLDFAST_BUILD_TESTS)
  set(googletest /usr/src/googletest/googletest)
  add_library(gtest_main STATIC ${googletest}/src/gtest-all.cc ${googletest}/src/gtest_main.cc)
  target_include_directories(gtest_main SYSTEM PUBLIC ${googletest}/include PRIVATE ${googletest})
  target_compile_options(gtest_main PRIVATE -w)
  # -O1 leaves out the passes of Binaryen, which take longer than the tests.
  target_link_options(gtest_main INTERFACE -O1 -sNODERAWFS=1 -sALLOW_MEMORY_GROWTH=1
                                           -sEXIT_RUNTIME=1 -sENVIRONMENT=node
                                           -sWASM_ASYNC_COMPILATION=0)
  add_library(GTest::gtest_main ALIAS gtest_main)
endif()
