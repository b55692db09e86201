# Compiler settings and the three kinds of target: a room, a kernel library, a program.
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug, …" FORCE)
endif()
# -O3 with assertions: a programmer's error must never become a number in a table.
set(CMAKE_CXX_FLAGS_RELEASE "-O3")

option(HALFSLOPE_BUILD_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(HALFSLOPE_BUILD_BENCHMARKS "Build the benchmarks" ${PROJECT_IS_TOP_LEVEL})
option(HALFSLOPE_SANITIZE "Build with AddressSanitizer and UndefinedBehaviorSanitizer" OFF)
option(HALFSLOPE_FUZZ "Build the fuzzers, which needs clang++; all code is then instrumented for them" OFF)

add_library(halfslope_flags INTERFACE)
# Contraction off: an fma stands where the code says fma, so every build gives the same bits.
target_compile_options(halfslope_flags INTERFACE -ffp-contract=off -fno-math-errno -Wall -Wextra -Wpedantic -Wconversion
  -Wshadow -Wno-psabi)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms of GCC 12 inside its own string and fmt's buffer (bugs 105329 and 105651).
  target_compile_options(halfslope_flags INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)
endif()
if(HALFSLOPE_SANITIZE)
  target_compile_options(halfslope_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
    -fno-omit-frame-pointer)
  target_link_options(halfslope_flags INTERFACE -fsanitize=address,undefined)
endif()

if(HALFSLOPE_FUZZ)
  target_compile_options(halfslope_flags INTERFACE -fsanitize=fuzzer-no-link,address,undefined
    -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(halfslope_flags INTERFACE -fsanitize=address,undefined)
endif()

# halfslope_room(core PUBLIC … PRIVATE …): a static library of every .cpp in the folder but kernels and main.
function(halfslope_room room)
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${room}/*.cpp")
  list(FILTER sources EXCLUDE REGEX "\\.kernel\\.cpp$|/main\\.cpp$")
  add_library(halfslope_${room} STATIC ${sources})
  add_library(halfslope::${room} ALIAS halfslope_${room})
  target_include_directories(halfslope_${room} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}>)
  target_compile_features(halfslope_${room} PUBLIC cxx_std_20)
  target_link_libraries(halfslope_${room} ${ARGN} PRIVATE $<BUILD_INTERFACE:halfslope_flags>)
  set_target_properties(halfslope_${room} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

# halfslope_kernels(avx2 -march=…): every *.kernel.cpp as one library that exports only its entries.
function(halfslope_kernels isa)
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*/*.kernel.cpp")
  set(target halfslope_kernels_${isa})
  add_library(${target} MODULE ${sources})
  target_include_directories(${target} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
  target_include_directories(${target} SYSTEM PRIVATE ${RANDOM123_INCLUDE_DIR})
  target_link_libraries(${target} PRIVATE halfslope_flags halfslope_xsimd)
  target_compile_options(${target} PRIVATE ${ARGN})
  # Hidden visibility leaves libstdc++'s templates exported, and the host would then run this library's copies of them.
  set(script "${CMAKE_CURRENT_SOURCE_DIR}/cmake/kernels.map")
  target_link_options(${target} PRIVATE "LINKER:--version-script=${script}" "LINKER:-Bsymbolic")
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME "halfslope-kernels-${isa}" CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/kernels" LINK_DEPENDS "${script}")
  set_property(GLOBAL APPEND PROPERTY HALFSLOPE_KERNEL_TARGETS ${target})
endfunction()

# halfslope_program(name): an executable that lies in the build folder's root and has the kernels beside it.
function(halfslope_program target)
  target_link_libraries(${target} PRIVATE halfslope_flags)
  get_property(kernels GLOBAL PROPERTY HALFSLOPE_KERNEL_TARGETS)
  add_dependencies(${target} ${kernels})
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}")
endfunction()
