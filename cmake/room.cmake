# understudy_room(NAME [RECURSE] [APART] [EXCLUDE regex] [SOURCES extra ...] [USES room ...] [PUBLIC lib ...] [PRIVATE lib ...])
# One static library a folder: understudy::NAME, of every source in it (RECURSE: in its sub-rooms too). USES names
# our own rooms, the rest are third-party targets. APART: each source is compiled on its own, where most of them are
# Eigen's expressions, which take longer together.
function(understudy_room name)
  cmake_parse_arguments(ROOM "RECURSE;APART" "EXCLUDE" "SOURCES;USES;PUBLIC;PRIVATE" ${ARGN})
  understudy_sources(sources "${ROOM_RECURSE}" "${ROOM_EXCLUDE}")
  add_library(understudy_${name} STATIC ${sources} ${ROOM_SOURCES})
  add_library(understudy::${name} ALIAS understudy_${name})
  target_link_libraries(understudy_${name} PUBLIC understudy_settings)
  foreach(used IN LISTS ROOM_USES)
    target_link_libraries(understudy_${name} PUBLIC understudy::${used})
  endforeach()
  target_link_libraries(understudy_${name} PUBLIC ${ROOM_PUBLIC} PRIVATE ${ROOM_PRIVATE})
  set_property(TARGET understudy_${name} PROPERTY EXPORT_NAME ${name})
  # Compiled once: for the command, for the Python module, and in every preset alike.
  set_target_properties(understudy_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden)
  set_property(GLOBAL APPEND PROPERTY UNDERSTUDY_LIBRARIES understudy_${name})
  understudy_precompiled(understudy_${name})
  if(NOT ROOM_APART)
    understudy_join_sources(understudy_${name} 16)
  endif()
endfunction()

# The sources of the folder that calls, without those that match EXCLUDE.
function(understudy_sources out recurse exclude)
  if(recurse)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  else()
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  endif()
  if(exclude)
    list(FILTER sources EXCLUDE REGEX "${exclude}")
  endif()
  set(${out} ${sources} PARENT_SCOPE)
endfunction()

# understudy_test(NAME [RECURSE] [EXCLUDE regex] [SOURCES extra ...] USES room ... [PRIVATE lib ...] [TIMEOUT s]
# [LOCK what])
# LOCK: tests that share what there is once on a computer never run at the same time.
# One GoogleTest program of every source in the folder; suites whose name starts with Extended or Slow do not run under ./test.
function(understudy_test name)
  cmake_parse_arguments(TEST "RECURSE" "TIMEOUT;EXCLUDE;LOCK" "SOURCES;USES;PRIVATE" ${ARGN})
  understudy_sources(sources "${TEST_RECURSE}" "${TEST_EXCLUDE}")
  add_executable(${name}_test ${sources} ${TEST_SOURCES})
  foreach(used IN LISTS TEST_USES)
    target_link_libraries(${name}_test PRIVATE understudy::${used})
  endforeach()
  target_link_libraries(${name}_test PRIVATE ${TEST_PRIVATE} GTest::gmock_main)
  target_compile_options(${name}_test PRIVATE ${UNDERSTUDY_TEST_OPTIONS})
  understudy_precompiled(${name}_test)
  target_compile_definitions(${name}_test PRIVATE
    UNDERSTUDY_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  understudy_join_sources(${name}_test 16)
  understudy_list_suites(${name} "${TEST_TIMEOUT}" "${TEST_LOCK}")
endfunction()

# understudy_list_suites(NAME TIMEOUT LOCK): CTest's tests of NAME_test, one for each suite; under a sanitizer one for
# each test.
function(understudy_list_suites name timeout lock)
  if(NOT timeout)
    set(timeout 120)
  endif()
  set(each OFF)
  if(UNDERSTUDY_SANITIZE)
    math(EXPR timeout "4 * ${timeout}")
    set(each ON)
  endif()
  set(properties "ENVIRONMENT LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/cmake/lsan.supp:print_suppressions=0")
  if(lock)
    string(APPEND properties " RESOURCE_LOCK ${lock}")
  endif()
  set_property(TARGET ${name}_test APPEND PROPERTY LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/list_suites.cmake)
  set(tests ${CMAKE_CURRENT_BINARY_DIR}/${name}_tests.cmake)
  add_custom_command(TARGET ${name}_test POST_BUILD VERBATIM
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${name}_test> -DPREFIX=${name} -DTIMEOUT=${timeout}
      "-DPROPERTIES=${properties}" -DEACH=${each} -DOUT=${tests} -P ${PROJECT_SOURCE_DIR}/cmake/list_suites.cmake)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}_include.cmake
    "if(EXISTS \"${tests}\")\n  include(\"${tests}\")\nelse()\n  add_test(${name}_test_NOT_BUILT ${name}_test_NOT_BUILT)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}_include.cmake)
endfunction()

# understudy_join_sources(TARGET COUNT): compiles up to COUNT sources as one, since they instantiate the same templates.
# Preset dev compiles each on its own, and finds an include that is missing.
function(understudy_join_sources target count)
  if(NOT UNDERSTUDY_JOIN)
    return()
  endif()
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "^${PROJECT_BINARY_DIR}/")
  execute_process(COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/join_sources.py ${count} ${sources}
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE lines OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\n" ";" lines "${lines}")
  foreach(line IN LISTS lines)
    string(REGEX MATCH "^([0-9]+)>(.*)$" _ "${line}")
    set_source_files_properties(${CMAKE_MATCH_2} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${CMAKE_MATCH_1})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
