# understudy_room(NAME SOURCES ... [USES room ...] [PUBLIC lib ...] [PRIVATE lib ...])
# One static library a folder: understudy::NAME. USES names our own rooms, the rest are third-party targets.
function(understudy_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;PUBLIC;PRIVATE" ${ARGN})
  add_library(understudy_${name} STATIC ${ROOM_SOURCES})
  add_library(understudy::${name} ALIAS understudy_${name})
  target_link_libraries(understudy_${name} PUBLIC understudy_settings)
  foreach(used IN LISTS ROOM_USES)
    target_link_libraries(understudy_${name} PUBLIC understudy::${used})
  endforeach()
  target_link_libraries(understudy_${name} PUBLIC ${ROOM_PUBLIC} PRIVATE ${ROOM_PRIVATE})
endfunction()

# understudy_test(NAME SOURCES ... USES room ... [PRIVATE lib ...] [LABELS ...] [TIMEOUT s])
# One GoogleTest program a room; tests whose name starts with Slow run under ./test --all only.
function(understudy_test name)
  cmake_parse_arguments(TEST "" "TIMEOUT" "SOURCES;USES;PRIVATE" ${ARGN})
  add_executable(${name}_test ${TEST_SOURCES})
  foreach(used IN LISTS TEST_USES)
    target_link_libraries(${name}_test PRIVATE understudy::${used})
  endforeach()
  target_link_libraries(${name}_test PRIVATE ${TEST_PRIVATE} GTest::gmock_main)
  target_compile_definitions(${name}_test PRIVATE
    UNDERSTUDY_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  set(leaks "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/cmake/lsan.supp:print_suppressions=0")
  gtest_discover_tests(${name}_test TEST_PREFIX "${name}." TEST_FILTER "-Slow*" NO_PRETTY_VALUES
    PROPERTIES ENVIRONMENT ${leaks} TIMEOUT ${TEST_TIMEOUT} DISCOVERY_TIMEOUT 60)
  gtest_discover_tests(${name}_test TEST_PREFIX "${name}." TEST_FILTER "Slow*" NO_PRETTY_VALUES
    TEST_LIST ${name}_slow_tests
    PROPERTIES ENVIRONMENT ${leaks} LABELS slow TIMEOUT 3600 DISCOVERY_TIMEOUT 60)
endfunction()
