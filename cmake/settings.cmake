# Compiler settings that every room shares.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

option(UNDERSTUDY_WERROR "Warnings are errors" OFF)
option(UNDERSTUDY_PRECOMPILE "Precompile the headers that most sources include, which hides missing includes" OFF)
option(UNDERSTUDY_JOIN "Compile sources of a target together, which takes less time but hides missing includes" OFF)
if(UNDERSTUDY_JOIN)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
endif()
set(UNDERSTUDY_SANITIZE "" CACHE STRING "Sanitizers, e.g. address,undefined or thread")

# Paths below the source folder are hashed relative to it, so clones in other folders share objects. What a source
# includes comes from the compiler (depend mode), not from preprocessing it twice.
set(UNDERSTUDY_IGNORELIST ${PROJECT_SOURCE_DIR}/cmake/ubsan_ignorelist.txt)
find_program(CCACHE ccache)
if(CCACHE)
  set(read_too)
  if(UNDERSTUDY_SANITIZE)
    set(read_too CCACHE_EXTRAFILES=${UNDERSTUDY_IGNORELIST})
  endif()
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 CCACHE_DEPEND=1 ${read_too}
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${CCACHE})
endif()

# The same inputs must give the same bytes: no contraction that depends on inlining.
add_compile_options(
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -ffp-contract=off
  $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>  # clang counts it to -Wconversion, GCC does not
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # GCC 12 sees overlaps in std::string that are not there (PR 105651)
  # The same in a precompiled header. Preset dev has none and keeps these; AddressSanitizer finds the true ones.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${UNDERSTUDY_PRECOMPILE}>>:-Wno-array-bounds>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${UNDERSTUDY_PRECOMPILE}>>:-Wno-stringop-overflow>
  # Where sources are joined, a type of one source looks like a type of a header. Preset dev keeps this one too.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${UNDERSTUDY_JOIN}>>:-Wno-subobject-linkage>
  # And a local name of one source hides a constant of another, for clang at least. Stage clang of ./check keeps this one.
  $<$<AND:$<CXX_COMPILER_ID:Clang>,$<BOOL:${UNDERSTUDY_JOIN}>>:-Wno-shadow>
  $<$<BOOL:${UNDERSTUDY_WERROR}>:-Werror>)
# GCC collects garbage whenever its heap has doubled from 128 MB, less than the precompiled header takes. Where there is memory
# for it, it begins later (docs/build.md).
cmake_host_system_information(RESULT memory_mb QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR memory_per_core_mb "${memory_mb} / ${cores}")
if(UNDERSTUDY_PRECOMPILE AND memory_per_core_mb GREATER 3000)
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>)
endif()
# A program loads only the libraries of the sources that it takes from an archive: OpenCV's pictures alone are 130 more.
add_link_options(LINKER:--as-needed)
if(UNDERSTUDY_SANITIZE)
  set(sanitizers ${UNDERSTUDY_SANITIZE})
  set(undefined undefined)
  if(UNDERSTUDY_FUZZ)  # a double that no int holds becomes any int: undefined behaviour that the group leaves out
    string(APPEND sanitizers ,float-cast-overflow)
    string(APPEND undefined ,float-cast-overflow)
  endif()
  add_compile_options(
    -fsanitize=${sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=${undefined}
    $<$<CXX_COMPILER_ID:Clang>:-fsanitize-ignorelist=${UNDERSTUDY_IGNORELIST}>)
  add_link_options(-fsanitize=${sanitizers})
  add_compile_definitions(UNDERSTUDY_SANITIZED _GLIBCXX_ASSERTIONS)
endif()

# A test's own code runs for milliseconds and is half of all sources.
set(UNDERSTUDY_TEST_OPTIONS $<$<CONFIG:Release>:-O1>
  # A local name of one source hides a constant of another where they are joined. Preset dev keeps this one.
  $<$<BOOL:${UNDERSTUDY_JOIN}>:-Wno-shadow>)

# What every room's users inherit: C++20, and headers found from the top, here or where they are installed.
set(UNDERSTUDY_HEADERS include/understudy)
add_library(understudy_settings INTERFACE)
target_compile_features(understudy_settings INTERFACE cxx_std_20)
target_include_directories(understudy_settings INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${UNDERSTUDY_HEADERS}>)
set_property(TARGET understudy_settings PROPERTY EXPORT_NAME settings)
set_property(GLOBAL APPEND PROPERTY UNDERSTUDY_LIBRARIES understudy_settings)

# understudy_precompiled(TARGET): one precompiled header for every room and one for every test; one more for rooms that
# a shared object is made of, since GCC takes it only where it was compiled alike.
function(understudy_precompiled target)
  if(NOT UNDERSTUDY_PRECOMPILE)
    return()
  endif()
  get_target_property(shared ${target} POSITION_INDEPENDENT_CODE)
  set(header understudy_precompiled)
  if(shared)
    set(header understudy_precompiled_shared)
    set(properties POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden)
  elseif(target MATCHES "_test$")
    set(header understudy_precompiled_test)
    set(options ${UNDERSTUDY_TEST_OPTIONS})
  endif()
  if(NOT TARGET ${header})
    understudy_precompile(${header} ${properties})
    target_compile_options(${header} PRIVATE ${options})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${header})
  # GCC uses the header only where every macro that it mentions is what it was.
  target_compile_definitions(${target} PRIVATE GTEST_HAS_PTHREAD=1)
  cmake_language(EVAL CODE "cmake_language(DEFER CALL understudy_skip_precompiled ${target})")
endfunction()

# understudy_precompile(NAME [property value ...])
function(understudy_precompile name)
  find_package(Eigen3 3.4 REQUIRED NO_MODULE)
  find_package(GTest REQUIRED)
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/${name}.cpp CONTENT "")
  add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/${name}.cpp)
  if(ARGN)
    set_target_properties(${name} PROPERTIES ${ARGN})
  endif()
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_link_libraries(${name} PRIVATE understudy_settings Eigen3::Eigen GTest::gmock)
  target_precompile_headers(${name} PRIVATE
    <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <span> <string> <vector>
    <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <gmock/gmock.h> <gtest/gtest.h>)
endfunction()

# A source with options of its own cannot use a header that was compiled without them.
function(understudy_skip_precompiled target)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(options)
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()
