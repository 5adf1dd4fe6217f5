# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` puts where, and the Debian package that CPack makes of it: the program, its two modules, and what
# the program says of itself: manual page and completions.
include(GNUInstallDirs)
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

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pnr)
set(CPACK_PACKAGE_CONTACT "the pnr project <pnr@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "renders scene texts as photographs and as paintings, by photon mapping")
set(CPACK_PACKAGE_DESCRIPTION "A command that reads scenes of POV-Ray's language and traces their light with photon maps;\nobjects marked as painted get strokes that follow their form, under the same light.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON) # the dependencies are those of the binaries
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
include(CPack)
