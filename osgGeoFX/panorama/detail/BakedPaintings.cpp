// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/BakedPaintings.h>

// The assembler takes the texels as they are; a compiler would need minutes for so long an array.
#define GEOFX_TEXELS(name, file)                                                                             \
    asm(".pushsection .rodata\n"                                                                             \
        ".balign 16\n"                                                                                       \
        ".globl " name "\n"                                                                                  \
        ".hidden " name "\n" name ":\n"                                                                      \
        ".incbin \"" GEOFX_PAINTINGS "/" file "\"\n"                                                         \
        ".popsection\n")

GEOFX_TEXELS("geofx_bakedSky", "sky.rgba");
GEOFX_TEXELS("geofx_bakedBrush", "brush.rgba");
