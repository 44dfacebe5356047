// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <cstdint>
#include <functional>
#include <string>

namespace osgGeoFX
{

/// The unit of a town's heights.
enum class HeightUnit
{
    METRES,
    FEET
};

/** The source and settings of a town.
    @ingroup town */
struct TownOptions
{
    /// The folder of a finished terrain database, which gets the town.
    std::string database;
    /// Polygons with heights, in any format and CRS that OGR reads. Parts of buildings (`building:part`) stand in place of an outline
    /// if they cover half of it at least, and begin at their `min_height` or `building:min_level`.
    std::string buildings;
    std::string layer; ///< the layer; empty for all that have polygons
    /// The field of heights, from the ground to the highest point of the roof. Empty: one of the usual names. Where it has
    /// nothing, the height follows from the number of storeys, or else from the area of the footprint.
    std::string heightField;
    /// The field of the roof's shape: what contains "gable", "pitch", "hip", "saddle" or "sattel" is gabled where the outline is a
    /// rectangle, all else flat. Empty: one of the usual
    /// names. Where it has nothing, small houses on a rectangle are gabled.
    std::string roofField;
    /// The unit of heights that do not say theirs ("12 m", "40 ft").
    HeightUnit unit = HeightUnit::METRES;
    /// Walls and roofs are darker where neighbours, courtyards or the ground shut them in, and the ground around buildings
    /// (GroundShade). It is in the colors of vertices, and belongs to the town before any effect bends it. For walls and roofs it
    /// costs nothing when the town is drawn; for the ground, one more drawable for each cell.
    bool ambientOcclusion = true;
    int threads = 0; ///< worker threads; 0 for one for each core
};

/** Figures of a finished town.
    @ingroup town */
struct TownSummary
{
    std::uint64_t buildings = 0; ///< in the database
    std::uint64_t gabled = 0;    ///< of these, with a gabled roof
    std::uint64_t byStoreys = 0; ///< whose height is that of their storeys
    std::uint64_t byArea = 0;    ///< whose height is a guess, since nothing tells it
    std::uint64_t badHeights =
        0;                      ///< whose height was no usable number; they are among the two numbers before
    std::uint64_t repaired = 0; ///< whose outline was invalid and was mended
    std::uint64_t leftOut = 0;  ///< whose outline could not be used
    std::uint64_t outside = 0;  ///< that stand where the terrain has no ground
    std::uint64_t parts =
        0; ///< features that are parts of buildings, such as towers and what stands on columns
    std::uint64_t inParts = 0;       ///< buildings that are drawn by their parts in place of their outline
    std::uint64_t otherFeatures = 0; ///< features that are no polygons, or no buildings by their own words
    std::uint64_t files = 0;
    std::uint64_t bytes = 0; ///< of the town's files
    double readSeconds = 0.0, seconds = 0.0;
    std::uint64_t peakMemoryBytes = 0; ///< largest resident size of the process

    /// The figures in sentences, a line each, with line ends.
    OSGGEOFXDATA_EXPORT std::string text() const;
};

/// Called from any worker, but never from two at once: the units that are done, all units, and the phase. While the source is
/// read, both numbers are those of features, and the second one is 0 if it is not known. Return false to cancel.
using TownProgress = std::function<bool(std::uint64_t done, std::uint64_t total, const std::string& phase)>;

/** Puts a town into a finished terrain database: walls and roofs of all buildings, with levels of detail.

    The result is `DATABASE/buildings`, which `terrain.osgb` then refers to beside the ground. The tiles of the ground stay as
    they are. Plain OpenSceneGraph draws the town. In a scene with effects each building keeps its shape (RigidParts). A town
    that the database has is replaced, and stays until the new one is ready. The same sources and options give the same bytes,
    for any number of threads.

    Memory does not grow with the number of buildings, but for 16 bytes each. Outlines wait in a work file meanwhile.

    Throws BuildError. Any thread may call it, but only one build at a time may use a folder.
    @ingroup town */
OSGGEOFXDATA_EXPORT TownSummary buildTown(const TownOptions& options, const TownProgress& progress = {});

/// Removes what a town has left in a database's folder if `terrain.osgb` does not refer to it any more. True if there was a
/// town. Folders that no town has made stay.
/// @ingroup town
OSGGEOFXDATA_EXPORT bool removeStrayTown(const std::string& database);

} // namespace osgGeoFX
