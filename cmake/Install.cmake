# What `cmake --install` lays down, in three components: program, library (shared), development
# (headers, archive, CMake package, pkg-config). ./dev package makes Debian packages of them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# One library of all rooms but the firmware's, twice of the same objects. In 0.x every minor version
# may change the interface, so it is part of the shared library's name.
get_property(rooms GLOBAL PROPERTY HOLDFAST_ROOMS)
list(REMOVE_ITEM rooms boards cluster softfloat)
foreach(kind static shared)
  set(library holdfast_${kind})
  string(TOUPPER ${kind} KIND)
  add_library(${library} ${KIND})
  foreach(room ${rooms})
    target_sources(${library} PRIVATE $<TARGET_OBJECTS:holdfast_${room}>)
  endforeach()
  set_target_properties(${library} PROPERTIES LINKER_LANGUAGE CXX OUTPUT_NAME holdfast
    EXPORT_NAME ${kind} VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_compile_features(${library} INTERFACE cxx_std_20)
  target_include_directories(${library} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${library} PRIVATE fmt::fmt pugixml::pugixml Threads::Threads
                        deflate ${CMAKE_DL_LIBS})
endforeach()
# Only holdfast's own names are seen from outside, not those of the libraries within.
set(map ${PROJECT_SOURCE_DIR}/cmake/install/holdfast.map)
target_link_options(holdfast_shared PRIVATE -Wl,--no-undefined -Wl,--version-script=${map})
set_target_properties(holdfast_shared PROPERTIES LINK_DEPENDS ${map})

install(TARGETS holdfast holdfast-checker COMPONENT program)
install(TARGETS holdfast_static EXPORT holdfast-static COMPONENT development)
install(TARGETS holdfast_shared EXPORT holdfast-shared
        LIBRARY COMPONENT library NAMELINK_COMPONENT development)
foreach(room ${rooms})
  get_target_property(folder holdfast_${room} SOURCE_DIR)
  install(DIRECTORY ${folder}/include/ COMPONENT development
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()

# find_package(holdfast) and pkg-config.
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/holdfast)
foreach(kind static shared)
  install(EXPORT holdfast-${kind} NAMESPACE holdfast:: DESTINATION ${package}
          COMPONENT development)
endforeach()
configure_package_config_file(cmake/install/holdfast-config.cmake.in holdfast-config.cmake
  INSTALL_DESTINATION ${package} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(holdfast-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/holdfast-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/holdfast-config-version.cmake
        DESTINATION ${package} COMPONENT development)
file(RELATIVE_PATH prefix_from_package /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/install/holdfast.pc.in holdfast.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/holdfast.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# What the programs read and what is said about them. The page and the firmware's image are there if
# ./dev page and ./dev firmware have built them; a schema refers to the structure's above it.
install(FILES docs/structure.schema.json build/page/holdfast.html
        DESTINATION ${CMAKE_INSTALL_DATADIR}/holdfast COMPONENT program OPTIONAL)
install(DIRECTORY docs/schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/holdfast COMPONENT program)
foreach(board firmware firmware/v1)
  install(FILES build/${board}/module_stm32f0.elf
          DESTINATION ${CMAKE_INSTALL_DATADIR}/holdfast/${board} COMPONENT firmware OPTIONAL)
endforeach()
install(FILES build/firmware/module_stm32f091xc.elf
        DESTINATION ${CMAKE_INSTALL_DATADIR}/holdfast/firmware COMPONENT firmware OPTIONAL)
set(manual ${PROJECT_SOURCE_DIR}/apps/cli/manual)
find_program(HOLDFAST_GZIP gzip REQUIRED)
mark_as_advanced(HOLDFAST_GZIP)
foreach(page holdfast holdfast-checker holdfast-check holdfast-steps holdfast-next holdfast-order
             holdfast-move holdfast-simulate holdfast-emulate holdfast-convert holdfast-fit
             holdfast-generate holdfast-robots holdfast-view holdfast-listen holdfast-tell
             holdfast-twin holdfast-conformance)
  set(packed ${CMAKE_CURRENT_BINARY_DIR}/${page}.1.gz)
  add_custom_command(OUTPUT ${packed} DEPENDS ${manual}/${page}.1
                     COMMAND ${HOLDFAST_GZIP} -9nc ${manual}/${page}.1 > ${packed})
  add_custom_target(${page}_manual ALL DEPENDS ${packed})
  install(FILES ${packed} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
endforeach()
install(FILES ${manual}/holdfast.bash RENAME holdfast COMPONENT program
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${manual}/_holdfast DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions
        COMPONENT program)
install(FILES ${manual}/holdfast.fish COMPONENT program
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

include(cmake/install/Package.cmake)
