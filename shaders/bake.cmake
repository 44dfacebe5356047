# Writes the shader FILES of FOLDER as C++ string literals to OUTPUT.
set(text "// Made by shaders/bake.cmake from the files of shaders/; not to be edited.\n")
string(APPEND text "#include <BakedShaders.h>\n\nconst osgGeoFX::BakedShader osgGeoFX::bakedShaders[] = {\n")
foreach(file ${FILES})
  # Hexadecimal, because CMake's lists mangle brackets and semicolons.
  file(READ ${FOLDER}/${file} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(MAKE_C_IDENTIFIER ${file} id)
  string(PREPEND text "static const unsigned char ${id}[] = {${bytes}0};\n")
  string(APPEND text "    {\"${file}\", reinterpret_cast<const char*>(${id})},\n")
endforeach()
list(LENGTH FILES count)
string(APPEND text "};\nconst std::size_t osgGeoFX::bakedShaderCount = ${count};\n")
file(WRITE ${OUTPUT} "${text}")
