# understudy_room(NAME [RECURSE] [EXCLUDE regex] [SOURCES extra ...] [USES room ...] [PUBLIC lib ...] [PRIVATE lib ...])
# One static library a folder: understudy::NAME, of every source in it (RECURSE: in its sub-rooms too). USES names
# our own rooms, the rest are third-party targets.
function(understudy_room name)
  cmake_parse_arguments(ROOM "RECURSE" "EXCLUDE" "SOURCES;USES;PUBLIC;PRIVATE" ${ARGN})
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
# One GoogleTest program of every source in the folder; tests whose name starts with Slow run under ./test --all only.
function(understudy_test name)
  cmake_parse_arguments(TEST "RECURSE" "TIMEOUT;EXCLUDE;LOCK" "SOURCES;USES;PRIVATE" ${ARGN})
  understudy_sources(sources "${TEST_RECURSE}" "${TEST_EXCLUDE}")
  add_executable(${name}_test ${sources} ${TEST_SOURCES})
  foreach(used IN LISTS TEST_USES)
    target_link_libraries(${name}_test PRIVATE understudy::${used})
  endforeach()
  target_link_libraries(${name}_test PRIVATE ${TEST_PRIVATE} GTest::gmock_main)
  understudy_precompiled(${name}_test)
  target_compile_definitions(${name}_test PRIVATE
    UNDERSTUDY_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  if(UNDERSTUDY_SANITIZE)
    math(EXPR TEST_TIMEOUT "4 * ${TEST_TIMEOUT}")
  endif()
  set(leaks "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/cmake/lsan.supp:print_suppressions=0")
  if(TEST_LOCK)
    set(lock RESOURCE_LOCK ${TEST_LOCK})
  endif()
  gtest_discover_tests(${name}_test TEST_PREFIX "${name}." TEST_FILTER "-Slow*" NO_PRETTY_VALUES
    PROPERTIES ENVIRONMENT ${leaks} TIMEOUT ${TEST_TIMEOUT} ${lock} DISCOVERY_TIMEOUT 60)
  gtest_discover_tests(${name}_test TEST_PREFIX "${name}." TEST_FILTER "Slow*" NO_PRETTY_VALUES
    TEST_LIST ${name}_slow_tests
    PROPERTIES ENVIRONMENT ${leaks} LABELS slow TIMEOUT 3600 ${lock} DISCOVERY_TIMEOUT 60)
endfunction()
