# Toolchain: Debian's gcc-arm-none-eabi for a Cortex-M4 with floating point in single precision.
include(${CMAKE_CURRENT_LIST_DIR}/arm.cmake)
set(CMAKE_CXX_FLAGS_INIT "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16")
set(CMAKE_C_FLAGS_INIT "${CMAKE_CXX_FLAGS_INIT}")
