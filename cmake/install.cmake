# cmake --install: the command with models, scenarios, examples and licences (component program); the rooms' libraries, their
# headers as they lie here, and what find_package(Understudy) reads (component development).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(data ${CMAKE_INSTALL_DATADIR}/understudy)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Understudy)

install(DIRECTORY models/ DESTINATION ${data}/models COMPONENT program
        FILES_MATCHING PATTERN "*.yaml" PATTERN "*.urdf" PATTERN "*.stl")
install(DIRECTORY scenarios examples DESTINATION ${data} COMPONENT program)
install(DIRECTORY docs/schemas DESTINATION ${data}/docs COMPONENT program)
install(FILES README.md CHANGELOG.md LICENSE docs/licences.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
if(TARGET understudy)
  install(TARGETS understudy RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()

# What the command is made of, and the notices of what is compiled into it: from Debian's database and Ninja's.
get_property(embedded GLOBAL PROPERTY UNDERSTUDY_EMBEDDED)
list(REMOVE_DUPLICATES embedded)
list(JOIN embedded "\n" embedded)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/embedded.txt CONTENT "${embedded}\n")
find_package(Python3 COMPONENTS Interpreter)
find_program(DPKG_QUERY dpkg-query)
if(TARGET understudy AND CMAKE_GENERATOR STREQUAL Ninja AND Python3_FOUND AND DPKG_QUERY)
  set(script ${PROJECT_SOURCE_DIR}/scripts/bill_of_materials.py)
  set(bill ${PROJECT_BINARY_DIR}/understudy.cdx.json ${PROJECT_BINARY_DIR}/third-party-notices.txt)
  list(GET bill 0 materials)
  list(GET bill 1 notices)
  add_custom_command(OUTPUT ${bill} VERBATIM DEPENDS understudy understudy_formats ${script} ${PROJECT_BINARY_DIR}/embedded.txt
    COMMAND Python3::Interpreter ${script} ${PROJECT_BINARY_DIR} -o ${materials} --notices ${notices} --release ${PROJECT_VERSION}
      --optional)
  add_custom_target(bill-of-materials ALL DEPENDS ${bill})
  install(FILES ${bill} DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program OPTIONAL)
endif()

get_property(libraries GLOBAL PROPERTY UNDERSTUDY_LIBRARIES)
install(TARGETS ${libraries} EXPORT UnderstudyTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(EXPORT UnderstudyTargets NAMESPACE understudy:: DESTINATION ${package} COMPONENT development)
install(DIRECTORY ${UNDERSTUDY_ROOMS} DESTINATION ${UNDERSTUDY_HEADERS} COMPONENT development
        FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${PROJECT_BINARY_DIR}/core/generated/core DESTINATION ${UNDERSTUDY_HEADERS} COMPONENT development)
set(MODELS ${data}/models)
configure_package_config_file(cmake/UnderstudyConfig.cmake.in ${PROJECT_BINARY_DIR}/UnderstudyConfig.cmake
  INSTALL_DESTINATION ${package} PATH_VARS MODELS)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/UnderstudyConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/UnderstudyConfig.cmake ${PROJECT_BINARY_DIR}/UnderstudyConfigVersion.cmake
              cmake/FindOSMesa.cmake
        DESTINATION ${package} COMPONENT development)

# cpack -G DEB --config build/release/CPackConfig.cmake: the command with its data as a Debian package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME understudy)
set(CPACK_PACKAGE_VENDOR Understudy)
set(CPACK_PACKAGE_CONTACT "Understudy <understudy@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME understudy)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
include(CPack)
