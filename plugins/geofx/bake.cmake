# Writes FILE as a C++ string to OUTPUT.
file(READ ${FILE} hex HEX) # hexadecimal, because CMake's lists mangle brackets and semicolons
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
file(WRITE ${OUTPUT} "// Made by plugins/geofx/bake.cmake from geofx.xsd; not to be edited.
#include <geofx/SceneSchema.h>

static const unsigned char text[] = {${bytes}0};
const char* const osgGeoFX::sceneSchema = reinterpret_cast<const char*>(text);
")
