# Writes a hash of the contents of FILES, in the order of their names, as a C++ function to OUTPUT.
list(SORT FILES)
set(hashes "")
foreach(file ${FILES})
  file(SHA256 ${file} hash)
  string(APPEND hashes "${hash}\n")
endforeach()
string(SHA256 hash "${hashes}")
string(SUBSTRING "${hash}" 0 16 hash)
file(WRITE ${OUTPUT} "// Made by osgGeoFX/cmake/HashSources.cmake; not to be edited.\n"
                     "#include <osgGeoFX/terrain/BuilderCode.h>\n\n"
                     "const char* osgGeoFX::builderCode()\n{\n    return \"${hash}\";\n}\n")
