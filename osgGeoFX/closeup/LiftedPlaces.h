// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/BoundingSphere>
#include <osg/Matrixd>
#include <osg/Vec2d>
#include <osg/Vec3d>

#include <memory>
#include <optional>

namespace osgGeoFX
{

class EffectScene;

/** Where the close-ups of a scene show places of the ground in one picture. Names ride on close-ups by it.

    World coordinates are those of the scene's children. An object keeps the camera and the close-ups as they were when it was made; do not
    change close-ups while it lives. A program makes it where it may read the scene graph: in event, update and cull traversals.
    @ingroup closeup */
class OSGGEOFX_EXPORT LiftedPlaces
{
public:
    /// `view`: a camera's view matrix, from the viewer's world to eye space. `time`: the simulation time, seconds.
    LiftedPlaces(EffectScene& scene, const osg::Matrixd& view, const osg::Matrixd& projection,
                 double time = 0.0);
    ~LiftedPlaces();
    LiftedPlaces(const LiftedPlaces&) = delete;
    LiftedPlaces& operator=(const LiftedPlaces&) = delete;

    /// A place as a close-up shows it.
    struct Place
    {
        osg::Vec3d drawn;   ///< where it is drawn, world coordinates
        osg::Vec2d picture; ///< x and y from −1 to 1 within the picture, if nothing hides it
    };
    /// Of a place of the ground, on the last close-up whose region has it. Empty outside of all regions, and behind the eye.
    std::optional<Place> of(const osg::Vec3d& world) const;
    /// Whether any place of a sphere of the undeformed world may be in a region.
    bool mayHave(const osg::BoundingSphered& ball) const;

    /// Looks at the ground of all regions, as the camera draws it with this LOD scale; groundOf() needs it.
    void lookAtGround(EffectScene& scene, double lodScale);
    /// The place of the ground that a close-up draws at a place, both in world coordinates. Empty if none does. Any thread may call it.
    std::optional<osg::Vec3d> groundOf(const osg::Vec3d& drawn) const;

private:
    struct Items;
    std::unique_ptr<Items> _items;
};

} // namespace osgGeoFX
