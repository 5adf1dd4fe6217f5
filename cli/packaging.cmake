# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` puts where, and the Debian package that CPack makes of it: the program, its two modules, and what
# the program says of itself: manual page and completions.
include(GNUInstallDirs)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON) # tests and benchmarks are not installed: no need to wait for them
set(pnr_said ${CMAKE_CURRENT_BINARY_DIR}/said)
add_custom_command(
    OUTPUT ${pnr_said}/pnr.1 ${pnr_said}/pnr.bash ${pnr_said}/_pnr ${pnr_said}/pnr.fish
    COMMAND ${CMAKE_COMMAND} -E make_directory ${pnr_said}
    COMMAND $<TARGET_FILE:pnr> man > ${pnr_said}/pnr.1
    COMMAND $<TARGET_FILE:pnr> completions bash > ${pnr_said}/pnr.bash
    COMMAND $<TARGET_FILE:pnr> completions zsh > ${pnr_said}/_pnr
    COMMAND $<TARGET_FILE:pnr> completions fish > ${pnr_said}/pnr.fish
    DEPENDS pnr)
add_custom_target(pnr_said ALL DEPENDS ${pnr_said}/pnr.1)

install(TARGETS pnr RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(module pnr_image pnr_font)
    if(TARGET ${module})
        install(TARGETS ${module} LIBRARY DESTINATION lib/pnr) # where core/module.cpp looks: beside bin
    endif()
endforeach()
install(FILES ${pnr_said}/pnr.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${pnr_said}/pnr.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME pnr)
install(FILES ${pnr_said}/_pnr DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${pnr_said}/pnr.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${CMAKE_SOURCE_DIR}/LICENSE
              ${CMAKE_SOURCE_DIR}/grammar/manual.md ${CMAKE_SOURCE_DIR}/grammar/pnr.ebnf
              ${CMAKE_SOURCE_DIR}/grammar/differences.md ${CMAKE_SOURCE_DIR}/grammar/references.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${CMAKE_SOURCE_DIR}/scenes/course DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The libraries for programs of other people: `find_package(pnr)` gives pnr::core, pnr::parser, pnr::npr and pnr::pipeline,
# the calls of cli/pipeline.h. Headers are included as here: "core/scene.h".
include(CMakePackageConfigHelpers)
set(pnr_config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pnr)
foreach(floor core parser npr exact)
    set_target_properties(pnr_${floor} PROPERTIES EXPORT_NAME ${floor})
endforeach()
set_target_properties(pnr_cli PROPERTIES EXPORT_NAME pipeline)
# So that a program finds the modules wherever it lies itself.
target_link_options(pnr_core INTERFACE $<INSTALL_INTERFACE:-Wl,-rpath,$<INSTALL_PREFIX>/lib/pnr>)
target_compile_features(pnr_core INTERFACE cxx_std_20)
install(TARGETS pnr_exact pnr_core pnr_parser pnr_npr pnr_cli EXPORT pnr
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(EXPORT pnr NAMESPACE pnr:: FILE pnrTargets.cmake DESTINATION ${pnr_config_folder} COMPONENT development)
foreach(floor core parser npr cli)
    install(DIRECTORY ${CMAKE_SOURCE_DIR}/${floor} DESTINATION include/pnr COMPONENT development FILES_MATCHING PATTERN "*.h")
endforeach()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/pnrConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/pnrConfig.cmake
                              INSTALL_DESTINATION ${pnr_config_folder})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/pnrConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/pnrConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/pnrConfigVersion.cmake
        DESTINATION ${pnr_config_folder} COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pnr)
set(CPACK_PACKAGE_CONTACT "the pnr project <pnr@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "renders scene texts as photographs and as paintings, by photon mapping")
set(CPACK_PACKAGE_DESCRIPTION "A command that reads scenes of POV-Ray's language and traces their light with photon maps;\nobjects marked as painted get strokes that follow their form, under the same light.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME pnr)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpnr-dev)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers and libraries to render scenes from C++: find_package(pnr).")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "pnr (= ${PROJECT_VERSION}), libcgal-dev, libfmt-dev, libglm-dev, libtbb-dev, zlib1g-dev")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON) # the dependencies are those of the binaries
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
include(CPack)
