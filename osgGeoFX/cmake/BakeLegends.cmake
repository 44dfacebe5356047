# Writes the legends NAMES of FOLDER as C++ string literals to OUTPUT.
set(text "// Made by osgGeoFX/cmake/BakeLegends.cmake from data/legends; not to be edited.\n")
string(APPEND text "#include <osgGeoFX/geodata/detail/BakedLegends.h>\n\nnamespace\n{\n")
foreach(name ${NAMES})
  # Hexadecimal, because CMake's lists mangle brackets and semicolons.
  file(READ ${FOLDER}/${name}.csv hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(APPEND text "const unsigned char ${name}[] = {${bytes}0};\n")
  string(APPEND entries "    {\"${name}\", reinterpret_cast<const char*>(${name})},\n")
endforeach()
list(LENGTH NAMES count)
string(APPEND text "} // namespace\n\nconst osgGeoFX::BakedLegend osgGeoFX::bakedLegends[] = {\n${entries}};\n"
                   "const std::size_t osgGeoFX::bakedLegendCount = ${count};\n")
file(WRITE ${OUTPUT} "${text}")
