// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/panorama/detail/PictureCurve.h>
#include <osgGeoFX/panorama/detail/ReliefWorth.h>

#include <optional>
#include <vector>

namespace osgGeoFX
{

/// The movements of a liberty about its center, for local places (across, along, height); metres.
glsl::geofx_Liberty movementsOf(const PanoramaLiberty& liberty);
/// A liberty's half of a relief: the terrain as it is with the liberty, on the same cells.
void take(const PanoramaLiberty& liberty, TerrainRelief& relief);

/** Looks for what a painter would enlarge, turn and widen in a picture. The relief, its worth and the view must outlive
    it. */
class LibertyFinder
{
public:
    /// `strength`: of all liberties, 0…1.
    LibertyFinder(const TerrainRelief& relief, const ReliefWorth& worth, const PanoramaComposition& view,
                  double aspect, double strength);

    /// Liberties that suit, the most important first. No two of the same kind have a center in common.
    std::vector<PanoramaLiberty> found() const;

private:
    /// What surrounds a summit.
    struct Mountain
    {
        double radius = 0.0; ///< of a region that has the mountain and its foot, metres
        double foot = 0.0;   ///< the height that stays, metres
        double longer = 1.0; ///< its length over its width, by the second moments of its heights
        double axis = 0.0;   ///< the direction of its length, from the picture's x towards s, −π/2…π/2
    };
    struct Valley
    {
        double x = 0.0, s = 0.0; ///< its middle, metres in the picture
        double angle = 0.0;      ///< of its length, clockwise from the picture's up
        double half = 0.0;       ///< of its length, metres
        double depth = 0.0;      ///< from its floor to the lower of its sides, metres
        double width = 0.0;      ///< half way up its sides, metres
        double hidden = 0.0;     ///< share of its floor that mountains hide
        double worth = 0.0;
    };

    double height(double x, double s) const; ///< NaN where there is no ground
    double tip(double x, double s, double height) const;
    bool isSeen(double x, double s, double height) const;
    bool fits(const PanoramaLiberty& liberty) const;
    std::optional<Mountain> mountainAt(const ReliefSummit& summit) const;
    double mostEnlarged(const PanoramaLiberty& liberty, double wanted) const;
    std::optional<PanoramaLiberty> enlarged(const ReliefSummit& summit, const Mountain& mountain) const;
    std::optional<PanoramaLiberty> turned(const ReliefSummit& summit, const Mountain& mountain) const;
    std::optional<Valley> valleyAt(double x, double s, double angle) const;
    std::optional<PanoramaLiberty> widened() const;

    const TerrainRelief& _relief;
    const ReliefWorth& _worth;
    const PanoramaComposition& _view;
    const PictureCurve _curve;
    const PicturePlace _place;
    const double _strength;
};

} // namespace osgGeoFX
