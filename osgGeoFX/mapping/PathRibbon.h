// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/mapping/RoutePath.h>
#include <osgGeoFX/paging/Georeference.h>

#include <osg/MatrixTransform>

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
    goes down to `foot`, and the ground hides what is below.

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
    double width = 0.0; ///< of a ribbon or tube, metres; 0: a 200th of the way's extent, 4 m at least
    double foot = 0.0;  ///< of a curtain: a height above the database's zero height, metres
    double step = 0.0;  ///< the longest edge along the way, metres; 0: a 100th of its extent
    osg::Vec4 color = {0.13f, 0.45f, 0.95f,
                       1.0f}; ///< the way's own goes before it; a curtain is a third as opaque

    /** The node to add to a scene. The path's heights count from the database's zero height, whatever its altitude mode is. Between places it
        follows great circles. Null, with a sentence in `error`, if it has less than two places, or leaves the terrain's
        projection. */
    osg::ref_ptr<osg::MatrixTransform> make(const RoutePath& path, const Georeference& reference,
                                            std::string& error) const;

    /// How programs and scene files show a way: a tube of the look's width, and if it is extruded a curtain. Empty, with a sentence in `error`, if it
    /// cannot.
    static std::vector<osg::ref_ptr<osg::Node>> nodesOf(const RoutePath& path, const RoutePath::Look& look,
                                                        const Georeference& reference, std::string& error);
};

} // namespace osgGeoFX
