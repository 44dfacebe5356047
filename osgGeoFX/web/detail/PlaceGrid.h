// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/web/WebPage.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** The places that a picture shows, at every few pixels of it, as a short text.

    Samples stand in rows from the uppermost one. Longitude and latitude are steps of 1e-5 degrees and heights are metres; each one is the difference to what its
    neighbors let expect (left + upper − upper left). Numbers are groups of five bits, the lowest ones first, with 32 added to all but the
    last; a sign is the lowest bit. A group is a letter of the alphabet of base64url. A dot and a number are so many samples of the sky.

    A second text has six bits a letter, one for each square of four samples: whether the place within it may be interpolated. It may where the picture
    itself says so: in the middle of the square, and of its sides, where its places are known. Across the edge of a ridge it may not. */
struct PlaceGrid
{
    PlaceGrid(const WebPlaces& places);

    int step = 0;    ///< pixels from sample to sample
    int first = 0;   ///< the pixel of the first one, in its column and in its row
    int columns = 0; ///< samples
    int rows = 0;
    std::string samples;
    std::string squares;

    static constexpr double unit = 1e-5; ///< degrees
    static constexpr double most = 1e5;  ///< samples
};

} // namespace osgGeoFX
