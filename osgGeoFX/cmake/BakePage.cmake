# Writes the FILES of FOLDER, which make a web page, as C++ string literals to OUTPUT.
set(text "// Made by osgGeoFX/cmake/BakePage.cmake from osgGeoFX/web/page; not to be edited.\n")
string(APPEND text "#include <osgGeoFX/web/detail/BakedPage.h>\n\n")
foreach(file ${FILES})
  # Hexadecimal, because CMake's lists mangle brackets and semicolons.
  file(READ ${FOLDER}/${file} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(MAKE_C_IDENTIFIER ${file} id)
  string(APPEND text "static const unsigned char ${id}[] = {${bytes}0};\n")
  string(APPEND entries "    {\"${file}\", reinterpret_cast<const char*>(${id}), sizeof(${id}) - 1},\n")
endforeach()
list(LENGTH FILES count)
string(APPEND text "\nconst osgGeoFX::BakedFile osgGeoFX::bakedPage[] = {\n${entries}};\n"
                   "const std::size_t osgGeoFX::bakedPageCount = ${count};\n")
file(WRITE ${OUTPUT} "${text}")
