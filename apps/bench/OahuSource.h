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

/// Colors for the whole raster, samples × samples texels of noise that differs from texel to texel within 2,048 texels. Writes
/// the files `noise` and `noise.hdr` beside the VRT.
void writeNoisyImagery(int samples, const std::filesystem::path& vrt);

} // namespace geofx::bench
