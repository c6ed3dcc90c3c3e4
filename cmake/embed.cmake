# understudy_embed(OUT_VARIABLE NAMESPACE ns FILES constant=path ...)
# Files become `extern const std::string_view constant` in a generated source, so that the program carries them.
# Bytes, not string literals: no delimiter can clash and no compiler's literal limit is met.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(UNDERSTUDY_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
  function(understudy_embed out_variable)
    cmake_parse_arguments(EMBED "" "NAMESPACE" "FILES" ${ARGN})
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${out_variable}.cpp)
    set(inputs "")
    foreach(pair IN LISTS EMBED_FILES)
      string(REGEX REPLACE "^[^=]*=" "" path "${pair}")
      list(APPEND inputs ${path})
    endforeach()
    string(REPLACE ";" "|" pairs "${EMBED_FILES}")
    add_custom_command(
      OUTPUT ${source}
      COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DNAMESPACE=${EMBED_NAMESPACE} "-DPAIRS=${pairs}"
              -P ${UNDERSTUDY_EMBED_SCRIPT}
      DEPENDS ${inputs} ${UNDERSTUDY_EMBED_SCRIPT}
      VERBATIM)
    set_property(GLOBAL APPEND PROPERTY UNDERSTUDY_EMBEDDED ${inputs})
    set(${out_variable} ${source} PARENT_SCOPE)
  endfunction()
  return()
endif()

set(text "#include <string_view>\n\nnamespace ${NAMESPACE} {\n")
string(REPLACE "|" ";" pairs "${PAIRS}")
foreach(pair IN LISTS pairs)
  string(REGEX MATCH "^([^=]*)=(.*)$" matched "${pair}")
  set(name ${CMAKE_MATCH_1})
  file(READ "${CMAKE_MATCH_2}" bytes HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND text "static const char ${name}_bytes[] = {\n${bytes}'\\0'};\n"
                     "extern const std::string_view ${name};\n"
                     "const std::string_view ${name}(${name}_bytes, sizeof ${name}_bytes - 1);\n")
endforeach()
file(WRITE "${SOURCE}" "${text}}  // namespace ${NAMESPACE}\n")
