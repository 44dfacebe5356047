// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <filesystem>

namespace geofx::bench
{

/** GDAL virtual rasters over data/oahu/elevation.tif, written as text: a program that writes them needs no
   GDAL, and nothing but the text is stored. Throw BenchError where it cannot be written. */

/// The whole raster on samples × samples posts, by cubic resampling.
void writeResampledOahu(const std::filesystem::path& elevation, int samples,
                        const std::filesystem::path& vrt);

/// A window of the raster itself, its samples × samples (at most 1621) middle posts those of the window from
/// Pearl Harbor to Makapuʻu and from the sea off Waikīkī to Lāʻie: both sides of the Koʻolau, and sea on all
/// sides.
void writeWindowOfOahu(const std::filesystem::path& elevation, int samples, const std::filesystem::path& vrt);

/// The whole raster on samples × samples posts, with noise of ±`metres` that differs from post to post within 2,048 posts. Writes
/// the files `noise`, `noise.hdr`, `noise.vrt`, `smooth.vrt` beside the VRT.
void writeNoisyOahu(const std::filesystem::path& elevation, int samples, double metres,
                    const std::filesystem::path& vrt);

} // namespace geofx::bench
