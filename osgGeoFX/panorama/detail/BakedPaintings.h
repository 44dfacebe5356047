// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

/// The texels of UsualPaintings, RGBA8, row by row. They are painted when the kit is built (panorama/bake/BakePaintings.cpp), so
/// that the first frame of a map need not wait for them.
extern "C"
{
    extern const unsigned char geofx_bakedSky[];
    extern const unsigned char geofx_bakedBrush[];
}
