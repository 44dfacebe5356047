// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/mapping/RoutePath.h>
#include <osgGeoFX/paging/Georeference.h>

#include <osg/MatrixTransform>

#include <functional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** A way with heights as geometry in the air: a ribbon, a tube, or a curtain down to the ground.

    @code
    osgGeoFX::PathRibbon look;
    look.shape = osgGeoFX::PathRibbon::TUBE;
    scene->addChild(look.make(path, *reference, error)); // below an EffectScene
    @endcode

    It is plain geometry in a frame at the way's middle, so that floats suffice. Below an EffectScene every effect moves it as it moves the ground, and close-ups show
    it; its edges are short enough for that (`step`). OSG writes and reads it, and picks it; the node has the way's name. A curtain
    goes down to the ground, or to `foot`, and the ground hides what is below.

    A plain value; make() may be called from any thread.
    @ingroup mapping */
struct OSGGEOFX_EXPORT PathRibbon
{
    enum Shape
    {
        RIBBON,  ///< level across the way
        CURTAIN, ///< upright below the way
        TUBE     ///< round about the way
    };
    Shape shape = RIBBON;
    /// Of a ribbon or tube, metres; 0: a 200th of the way's extent, or of the ground's if that is smaller, 4 m at least.
    double width = 0.0;
    double groundExtent = 0.0; ///< RoutePath::Look's
    /// A ribbon or tube is never narrower than so many pixels, 0…10, as far as the driver draws lines so wide; 0: from afar it fades
    /// into single pixels.
    double leastPixels = 2.0;
    double foot = 0.0; ///< of a curtain: a height above the database's zero height, metres
    /// The ground at a longitude and latitude, degrees: metres above the database's zero height; not a number where there is none. With it
    /// a curtain ends at the ground, and a way of heights above the ground has them there. Without it both count from the zero height.
    std::function<double(double longitude, double latitude)> ground;
    double step = 0.0; ///< the longest edge along the way, metres; 0: a 100th of its extent
    osg::Vec4 color = {0.13f, 0.45f, 0.95f,
                       1.0f}; ///< the way's own goes before it; a curtain is a third as opaque

    /** The node to add to a scene. Between places it follows geodesics, at heights that change evenly: those of a way above the
        ground, too, which has its heights above the ground at its own places. Null, with a sentence in `error`, if it has less than two places, or leaves the terrain's
        projection. */
    osg::ref_ptr<osg::MatrixTransform> make(const RoutePath& path, const Georeference& reference,
                                            std::string& error) const;

    using Ground = std::function<double(double longitude, double latitude)>;
    /// How programs and scene files show a way: a tube of the look's width, and if it is extruded a curtain. `ground`: as above, or empty. Empty,
    /// with a sentence in `error`, if it cannot.
    static std::vector<osg::ref_ptr<osg::Node>> nodesOf(const RoutePath& path, const RoutePath::Look& look,
                                                        const Georeference& reference, std::string& error,
                                                        const Ground& ground = {});
};

} // namespace osgGeoFX
