# SPDX-License-Identifier: GPL-3.0-or-later
# Writes OUT, a .cpp with the texts of our includes and of the default scene, so that `#include "colors.inc"` works
# wherever the program lies. The function NAME, declared in HEADER, gives them. Run by the build:
# cmake -DOUT=... -DNAME=... -DHEADER=... -DFILES=... -P embed.cmake
set(code "// SPDX-License-Identifier: GPL-3.0-or-later\n#include \"${HEADER}\"\n\nnamespace pnr {\n\nnamespace {\n\n")
set(table "")
set(number 0)
foreach(file ${FILES})
    get_filename_component(name ${file} NAME)
    file(READ ${file} bytes HEX)
    string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
    string(REGEX REPLACE "(([^,]*,){24})" "\\1\n" bytes "${bytes}")
    string(APPEND code "// ${name}\nconst unsigned char file_${number}[] = {\n${bytes}0};\n\n")
    string(APPEND table "        {\"${name}\", {reinterpret_cast<const char*>(file_${number}), sizeof file_${number} - 1}},\n")
    math(EXPR number "${number} + 1")
endforeach()
string(APPEND code "} // namespace\n\nconst std::vector<EmbeddedFile>& ${NAME}() {\n"
       "    static const std::vector<EmbeddedFile> files = {\n${table}    };\n    return files;\n}\n\n} // namespace pnr\n")
file(WRITE ${OUT} "${code}")
