# Compile options every target shares: C++20, warnings as errors, and floating point that means what it says.
add_library(weft_options INTERFACE)
target_compile_features(weft_options INTERFACE cxx_std_20)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# Designated initialisers leave members at their defaults on purpose: -Wno-missing-field-initializers.
# -ffp-contract=off: the reference must round after every operation, as the shaders do under `precise`.
# -fno-math-errno: lets sqrt become one instruction (and vectorise); results are unchanged.
target_compile_options(weft_options INTERFACE
  -Wall -Wextra -Wpedantic -Werror -Wshadow -Wconversion -Wno-sign-conversion
  -Wno-missing-field-initializers
  -ffp-contract=off -fno-math-errno -fno-trapping-math)
target_compile_definitions(weft_options INTERFACE GLM_FORCE_XYZW_ONLY GLM_FORCE_DEPTH_ZERO_TO_ONE)

if(WEFT_SANITIZE)
  target_compile_options(weft_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
    -fno-omit-frame-pointer)
  # g++ reports uninitialised values in the sanitizers' own instrumentation.
  target_compile_options(weft_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(weft_options INTERFACE -fsanitize=address,undefined)
endif()

if(WEFT_SANITIZE_THREADS)
  target_compile_options(weft_options INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(weft_options INTERFACE -fsanitize=thread)
endif()

if(WEFT_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES Clang)
    message(FATAL_ERROR "WEFT_FUZZ needs clang's libFuzzer: configure with -DCMAKE_CXX_COMPILER=clang++")
  endif()
  # Every library is instrumented for coverage; the fuzz programs add the driver with its main().
  target_compile_options(weft_options INTERFACE -fsanitize=fuzzer-no-link,address,undefined
    -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(weft_options INTERFACE -fsanitize=fuzzer-no-link,address,undefined)
endif()

if(WEFT_TIDY)
  find_program(CLANG_TIDY clang-tidy REQUIRED)
  set(CMAKE_CXX_CLANG_TIDY ${CLANG_TIDY} --quiet --extra-arg=-Wno-unknown-warning-option)
endif()

# For code that is not hot (reading, planning, recording, drawing, the tests): compiles in two thirds of the time.
set(WEFT_COLD $<$<CONFIG:Release>:-O1>)

# Two thirds of a build from scratch are the same headers read again: without a cache, several files of a folder
# are compiled as one. With ccache every file is cached by itself, so that a change compiles little.
find_program(WEFT_CCACHE ccache)
if(WEFT_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${WEFT_CCACHE})
  set(WEFT_UNITY_DEFAULT OFF)
else()
  set(WEFT_UNITY_DEFAULT ON)
endif()
option(WEFT_UNITY "compile the files of a folder together" ${WEFT_UNITY_DEFAULT})
if(WEFT_UNITY AND NOT WEFT_TIDY)
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)
  # A joined file includes the sources, so g++ takes what they keep to themselves for a header's.
  target_compile_options(weft_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
