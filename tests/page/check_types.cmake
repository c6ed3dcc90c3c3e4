# tsc resolves packages from where the sources lie, so they are copied beside node_modules.
file(REMOVE_RECURSE ${BUILT}/types)
file(COPY ${WEB}/tsconfig.json ${WEB}/report DESTINATION ${BUILT}/types)
execute_process(COMMAND ${NODE} ${BUILT}/node_modules/typescript/bin/tsc -p ${BUILT}/types RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "tsc found faults")
endif()
