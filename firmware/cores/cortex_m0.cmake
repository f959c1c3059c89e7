# Toolchain: Debian's gcc-arm-none-eabi for a Cortex-M0.
include(${CMAKE_CURRENT_LIST_DIR}/arm.cmake)
set(CMAKE_CXX_FLAGS_INIT "-mcpu=cortex-m0 -mthumb")
set(CMAKE_C_FLAGS_INIT "${CMAKE_CXX_FLAGS_INIT}")
