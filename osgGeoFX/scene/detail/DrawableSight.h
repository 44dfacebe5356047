// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/detail/BoundsPicture.h>
#include <osgGeoFX/scene/detail/MeshBoxes.h>
#include <osgGeoFX/scene/detail/Visibility.h>

#include <osg/Drawable>

#include <string>

namespace osgGeoFX
{

/** Finds out whether drawables are in sight after their deformation, and between which depths they lie. It goes by
    their boxes and by the smaller boxes within. For one thread at a time. */
class DrawableSight
{
public:
    explicit DrawableSight(Visibility& sight) : _sight(sight) {}

    struct Wishes
    {
        bool depths = true;  ///< whether near and far are wanted
        bool hides = true;   ///< whether things that a deformation hides are left out
        bool bounds = false; ///< whether all boxes are to be shown
        DepthRange::Meshes meshes = DepthRange::Meshes::No; ///< by which near and far go
    };
    /// Starts a traversal.
    void begin(const Wishes& wishes);

    /// What applies to a drawable.
    struct Place
    {
        const DeformationChain& chain;
        const osg::Matrixd& modelView; ///< to the view's eye space
        double scale;                  ///< of that
        Visibility::Mask planes;       ///< that it may cross
        bool smallCounts;              ///< whether its size tells
        bool depthCounts = true;       ///< for near and far
        bool rigid = false;            ///< whether things in it may have references of their own (RigidParts)
    };
    /// False if the drawable is out of sight. Otherwise `depth` is the depth of its middle, metres.
    bool inSight(const osg::Drawable& drawable, const Place& place, double& depth);

    DepthRange& depths() { return _depths; }
    BoundsPicture& bounds() { return _bounds; }
    /// A sentence from this traversal that should be printed once; empty as a rule.
    const std::string& complaint() const { return _complaint; }
    /// Forgets deleted drawables.
    void purge() { _meshBoxes.purge(); }

private:
    /// Whether all smaller boxes of a drawable miss the picture. False for a drawable without such boxes.
    bool meshOutside(const osg::Drawable& drawable, const Place& place, Visibility::Mask planes);
    bool misses(const osg::BoundingBox& box, const Place& place, Visibility::Mask planes);
    /// Whether a box's middle shows; whether the middle of the box that showed last time shows.
    bool middleInSight(const osg::BoundingBox& box, const Place& place, Visibility::Mask planes) const;
    bool witnessInSight(const osg::Drawable& drawable, const Place& place, Visibility::Mask planes);

    Visibility& _sight;
    Wishes _wishes;
    DepthRange _depths;
    MeshBoxes _meshBoxes;
    BoundsPicture _bounds;
    std::string _complaint;
};

} // namespace osgGeoFX
