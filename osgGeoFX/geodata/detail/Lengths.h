// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <optional>
#include <string>

class GDALRasterBand;
class OGRSpatialReference;

namespace osgGeoFX
{

/** Lengths as people and files write them. Thread-safe. */
class Lengths
{
public:
    static constexpr double METRES_PER_FOOT = 0.3048;

    /// Metres in a unit of length: "m", "metres", "dm", "cm", "mm", "km", "ft", "foot", "feet", "ftUS", "US survey foot",
    /// "yd", "fathom" and their like, in any case. Empty for any other word.
    static std::optional<double> metresPerUnit(const std::string& unit);

    /// A unit in words: "metres", "feet", "US survey feet"; others as "units of 0.9144 m".
    static std::string unitInWords(double metres);

    /** A length in words, metres: "12", "12.5 m", "2,014 ft", "2 014 m", "12'6\"". Commas, spaces and apostrophes may stand
        between groups of three digits; any other comma is a decimal point. A number without a unit counts `metresPerPlain`.
        Words behind the unit, such as "(about)", are left out. Empty if the text begins with no number or goes on with anything
        but a unit. */
    static std::optional<double> read(const std::string& text, double metresPerPlain = 1.0);

    /// Metres in the unit of a band of heights: that of the band, else that of the vertical part of the coordinate system. An
    /// unknown unit counts as metres, which one warning for each file states.
    static double metresPerHeight(GDALRasterBand& band, const OGRSpatialReference& srs,
                                  const std::string& file);
};

} // namespace osgGeoFX
