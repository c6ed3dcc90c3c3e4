# What runs on the real machine must not link a simulation engine. Run:
#   cmake "-DPROGRAMS=a;b" -P check_controller_links.cmake
cmake_minimum_required(VERSION 3.25)
foreach(program IN LISTS PROGRAMS)
  execute_process(COMMAND ldd ${program} OUTPUT_VARIABLE libraries RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "ldd ${program} failed")
  endif()
  string(REGEX MATCH "lib(mujoco|Bullet[A-Za-z0-9-]*|LinearMath[a-z0-9-]*|fcl|OSMesa)[^ ]*" found "${libraries}")
  if(found)
    message(FATAL_ERROR "${program} links ${found}")
  endif()
endforeach()
message("no simulation engine is linked")
