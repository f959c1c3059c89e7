# Toolchain: Debian's gcc-riscv64-unknown-elf and picolibc for RV32IMAC. It comes without headers of
# the C++ library: those of the Arm compiler serve, of which nothing is linked.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR riscv32)
set(CMAKE_C_COMPILER riscv64-unknown-elf-gcc)
set(CMAKE_CXX_COMPILER riscv64-unknown-elf-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_C_FLAGS_INIT "-march=rv32imac -mabi=ilp32 --specs=picolibc.specs")
file(GLOB headers /usr/include/newlib/c++/*)
set(CMAKE_CXX_FLAGS_INIT "${CMAKE_C_FLAGS_INIT} -isystem ${headers}")
string(APPEND CMAKE_CXX_FLAGS_INIT " -isystem ${headers}/arm-none-eabi/thumb/v6-m/nofp")
