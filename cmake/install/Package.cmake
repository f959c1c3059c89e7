# Debian packages of what is installed: holdfast (the programs), libholdfast0.2, libholdfast-dev
# and, if they are built, python3-holdfast and holdfast-firmware, the images that holdfast emulates.
# cpack -G DEB, or ./dev package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "The holdfast authors <authors@holdfast.invalid>")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program library development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
    GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
string(CONCAT about
  "Answers one question: will a modular robot hold when modules are attached?\n"
  "Verdicts with margins and loads, after Piranda et al., IEEE T-RO 37(6), 2021.\n")

# holdfast_package(COMPONENT NAME SECTION SUMMARY [DEPENDS])
macro(holdfast_package component name section summary)
  string(TOUPPER ${component} COMPONENT)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_DEPENDS "${ARGN}")
  set(CPACK_COMPONENT_${COMPONENT}_DESCRIPTION "${summary}\n${about}")
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/install/copyright
                ${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
  # What lintian is told to accept, each with its reason.
  set(NAME ${name})
  set(overrides "")
  foreach(part common ${component})
    if(EXISTS ${PROJECT_SOURCE_DIR}/cmake/install/lintian/${part})
      file(READ ${PROJECT_SOURCE_DIR}/cmake/install/lintian/${part} lines)
      string(APPEND overrides "${lines}")
    endif()
  endforeach()
  string(CONFIGURE "${overrides}" overrides @ONLY)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/lintian/${name} "${overrides}")
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/lintian/${name}
          DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT ${component})
endmacro()

set(version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(library libholdfast${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(needed "${library} (= ${version}), libfmt-dev, libpugixml-dev, libdeflate-dev")
holdfast_package(program holdfast science "will a modular robot hold? (programs)")
holdfast_package(library ${library} libs "will a modular robot hold? (shared library)")
holdfast_package(development libholdfast-dev libdevel
                 "will a modular robot hold? (headers and static library)" "${needed}")
if(HOLDFAST_BUILD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  # The extension is for this version of Python alone.
  math(EXPR minor "${Python_VERSION_MINOR} + 1")
  set(this ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})
  set(next ${Python_VERSION_MAJOR}.${minor})
  holdfast_package(python python3-holdfast python "will a modular robot hold? (Python package)"
    "python3 (>= ${this}), python3 (<< ${next}), python3-numpy (>= 1:1.24)")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # Pictures; the page in notebooks is the program's.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS
      "python3-matplotlib, python3-pil, python3-vtk9, holdfast")
endif()
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "librsvg2-2")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "xdg-utils, holdfast-firmware")
if(EXISTS ${PROJECT_SOURCE_DIR}/build/firmware/module_stm32f0.elf)
  list(APPEND CPACK_COMPONENTS_ALL firmware)
  holdfast_package(firmware holdfast-firmware science
    "will a modular robot hold? (firmware images for holdfast emulate)" "libunicorn2")
  set(CPACK_DEBIAN_FIRMWARE_PACKAGE_ARCHITECTURE all)
endif()
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/shlibs
     "libholdfast ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} ${library} (>= ${version})\n")
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA
    ${CMAKE_CURRENT_BINARY_DIR}/shlibs ${CMAKE_CURRENT_BINARY_DIR}/triggers)

# Debian's own change log only points to ours.
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
string(CONCAT changelog "holdfast (${version}) unstable; urgency=medium\n\n"
  "  * See CHANGELOG.md of the sources.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${now}\n")
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian "${changelog}")
execute_process(COMMAND ${HOLDFAST_GZIP} -9nkf changelog.Debian
                WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR} COMMAND_ERROR_IS_FATAL ANY)
include(CPack)
