// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <osg/Matrixd>
#include <osg/Vec2d>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

class PanoramaMap;

/// What a picture must have; whatever is empty, PanoramaComposer chooses.
/// @ingroup panorama
struct PanoramaWishes
{
    double aspect = 16.0 / 9.0;       ///< the picture's width over its height, 0.1…10
    std::optional<double> heading;    ///< up in the picture, radians clockwise from north
    std::optional<osg::Vec2d> place;  ///< at the middle of the picture's base, in the relief's units
    std::optional<osg::Vec2d> focus;  ///< to be seen near the picture's middle, in the relief's units
    std::optional<double> viewRadius; ///< as PanoramaMap's properties of these names
    std::optional<double> horizonLine;
    std::optional<double> horizonDistance;
    std::optional<double> exaggeration;
    double horizontalAngle = 0.0;        ///< as PanoramaMap's; 0…2π
    double horizonExaggeration = -1.0;   ///< as PanoramaMap's; nothing is chosen in its place
    std::vector<osg::Vec2d> curvePoints; ///< the same
};

/// A camera for a panorama map, and the values of the map's projection that belong to it.
/// @ingroup panorama
struct OSGGEOFX_EXPORT PanoramaComposition
{
    osg::Vec2d place;         ///< the ground at the middle of the picture's base, in the relief's units
    double heading = 0.0;     ///< up in the picture, radians clockwise from north
    double viewRadius = 0.0;  ///< metres
    double horizonLine = 0.8; ///< of the picture's height
    double curveDistance = 0.4;
    double horizonDistance = 3.6; ///< in view radii
    double horizonBend = 0.05;
    double exaggeration = 2.0;
    double baseHeight = 0.0; ///< metres
    double edgeWidth = 0.06; ///< in view radii
    /// Radians; not 0 for a cylindrical map. `place` is then the ground below the eye, and the base a circle around it.
    double horizontalAngle = 0.0;
    double horizonExaggeration = -1.0;   ///< of the wishes
    std::vector<osg::Vec2d> curvePoints; ///< of the wishes

    /// Sets the map's properties of these names, and `baseFromTerrain` to false.
    void applyTo(PanoramaMap& map) const;
    /// World to eye space, for a camera above the place.
    osg::Matrixd viewMatrix(const TerrainRelief& relief) const;
};

/** A liberty that a painter would take with a region of a picture's terrain: an ellipse whose middle gets the whole of it.
    The values are those of the effect RegionalLiberty. It is a plain value.
    @ingroup panorama */
struct PanoramaLiberty
{
    osg::Vec2d place;        ///< the region's center, in the relief's units
    double across = 0.0;     ///< half its width across its heading, metres
    double along = 0.0;      ///< and along it
    double heading = 0.0;    ///< radians clockwise from north
    double enlarge = 1.0;    ///< the factor of heights
    double baseHeight = 0.0; ///< the height that stays, metres
    double widen = 1.0;      ///< the factor of widths across the heading
    double lengthen = 1.0;   ///< and along it
    double turn = 0.0;       ///< clockwise from above, radians
    std::string why;         ///< a sentence that names it and says why
};

/// How a composition shows the terrain. Shares are 0…1.
/// @ingroup panorama
struct PanoramaJudgement
{
    double worth = 0.0;   ///< the measure, a sum of the shares below; the higher the better
    double detail = 0.0;  ///< mean worth of what the picture shows
    double summits = 0.0; ///< share of the terrain's summits that are seen, by their prominence
    double crown = 0.0;   ///< share of the most prominent summits that stand against the sky
    double rise =
        0.0; ///< how much higher the land is below the horizon than at the base, of the relief; −1…1
    double coverage = 0.0; ///< share of all that is worth seeing that the picture shows
    double skyline = 0.0;  ///< how much the skyline varies
    double sky = 0.0;      ///< share of the picture
    double water = 0.0;    ///< share of the shown ground
    double hidden = 0.0;   ///< share of the ground in the picture's rectangle that mountains hide
    double blank = 0.0;    ///< share of the picture where the data has no ground
    double cut = 0.0;      ///< share of the picture's width where summits go beyond its upper edge
    double flatness =
        0.0;          ///< logarithm of the suitable exaggeration over the composition's; 0 if that is no less
    double top = 0.0; ///< height of the highest summit's tip, of the picture
};

/** Chooses the view of a panorama map, as Heinrich Berann did (Brown and Samavati 2017, Section 2.1): from lowland at
    the picture's base to highland at the horizon, with the summits in sight.

    The measure of a view is

        worth = detail + summits + 1.5 crown + 0.8 rise + 0.8 coverage + 0.3 skyline
                − 10 blank − 2 min(blank / 0.5 %, 1) − 3 cut − 0.5 hidden
                − 0.8 (water above 45 %) − 3 (sky outside 12 to 30 %) − 0.6 flatness

    A place is worth seeing by its relief (the spread of heights around it, compared with the roughest tenth of the
    terrain) and by shores. Summits count by their prominence, so that one tall mountain counts more than the many
    knobs on its ridge. `crown` asks the most prominent ones to stand against the sky, in the picture's middle half. `rise` is the paper's "from lowlands near the bottom to highlands on the horizon". `coverage`
    keeps the view from being a close-up of one mountain. `blank` keeps the data's borders out of the picture.
    `flatness` is the logarithm of how much livelier the relief would be with the exaggeration that suits its slopes. Places
    count as much as their share of the picture, and nothing that mountains before it hide counts.

    Immutable after construction. Any thread may call it.
    @ingroup panorama */
class OSGGEOFX_EXPORT PanoramaComposer
{
public:
    explicit PanoramaComposer(const TerrainRelief& relief, const PanoramaWishes& wishes = {});
    ~PanoramaComposer();
    PanoramaComposer(const PanoramaComposer&) = delete;
    PanoramaComposer& operator=(const PanoramaComposer&) = delete;

    /// The best composition that was found. The same relief and wishes give the same one.
    PanoramaComposition compose() const;
    PanoramaJudgement judge(const PanoramaComposition& composition) const;
    /// The same, of the terrain with liberties, which act one after the other.
    PanoramaJudgement judge(const PanoramaComposition& composition,
                            const std::vector<PanoramaLiberty>& liberties) const;
    /** The liberties that suit a composition (Section 2.1: Berann enlarged landmarks, widened valleys and turned mountains).
        Up to three of the most prominent summits in sight that look small are enlarged above their foot, or above water
        there, which stays level. The main valley that leads into the picture is widened if it is narrow or hidden. One
        mountain whose broad side looks away is turned. `strength` 0…1: at 1 a summit grows by up to 1.5, the valley by
        1.6, and the turn is up to 20 degrees.

        No tip rises above the sky's lower half. A liberty is left out if, with it, the picture would hide notably more, show
        fewer summits or less of the data. */
    std::vector<PanoramaLiberty> liberties(const PanoramaComposition& composition, double strength) const;
    /// The usual strength of liberties.
    static constexpr double usualLiberties = 0.7;
    /// What was chosen and why, a sentence for each choice.
    std::vector<std::string> explain(const PanoramaComposition& composition) const;

private:
    class Parts;
    std::unique_ptr<Parts> _parts;
};

} // namespace osgGeoFX
