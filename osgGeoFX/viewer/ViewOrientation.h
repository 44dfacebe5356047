// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/BendOnGround.h>

#include <osg/Camera>
#include <osg/Vec2d>
#include <osg/Vec3d>

#include <array>
#include <optional>
#include <vector>

namespace osgGeoFX
{

/** How a camera stands over the map, and how steeply its picture shows the ground. A value, for the time when it was made.

    Directions are those of the undeformed map, at the camera. North is true north if a Georeference is given or the terrain
    is a globe; otherwise it is the grid's. Angles are radians, lengths metres.

    The ground's parts are those of a bend: the focus, the transition zone and the context. Without a bend all ground is the
    focus. The ground is taken as level here, at the height of the bend's reference plane or, without one, at the height
    that is nearest to 0.
    @ingroup viewer */
struct OSGGEOFX_EXPORT ViewOrientation
{
    enum Part
    {
        FOCUS,
        ZONE,
        CONTEXT
    };

    double heading = 0.0; ///< of the picture's upward direction on the map, clockwise from north, 0…2π
    double pitch = 0.0;   ///< of the line of sight, −π/2…π/2; 0 is level, negative looks down
    /// The angle at which the middle of what the picture shows of each part is seen, 0…π/2: 0 from its edge, π/2 from
    /// above. Empty if the picture does not show the part. The middle is that in the picture's middle column.
    std::array<std::optional<double>, 3> seen;

    /// The ground below the line of sight, as the picture has it, from the side.
    struct Point
    {
        double distance = 0.0; ///< from the eye's foot, on the map
        osg::Vec2d place;      ///< ahead of the eye, and above it; below is negative
        Part part = FOCUS;
        bool inPicture = false;
    };
    std::vector<Point> profile; ///< with growing distance; empty if the eye is not above the ground's level

    // The eye's foot and unit vectors there, in the frame of the scene's children.
    osg::Vec3d foot, north, east, up;
    double height = 0.0;              ///< of the eye above the ground's level
    std::optional<BendOnGround> bend; ///< empty without one

    /// Empty if the camera has no viewport, or its picture stands on its side, so that nothing in it points upwards.
    static std::optional<ViewOrientation> of(EffectScene& scene, const osg::Camera& camera,
                                             const Georeference* reference = nullptr);
};

} // namespace osgGeoFX
