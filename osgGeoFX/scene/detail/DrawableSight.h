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

/** Whether drawables are in sight once they are deformed, by their boxes and by the smaller ones within, and between which depths
    they lie. For one thread at a time. */
class DrawableSight
{
public:
    explicit DrawableSight(Visibility& sight) : _sight(sight) {}

    struct Wishes
    {
        bool depths = true;  ///< near and far are to be found
        bool hides = true;   ///< what a deformation hides is left out
        bool bounds = false; ///< all boxes are to be shown
    };
    /// For one traversal.
    void begin(const Wishes& wishes);

    /// What is in force for a drawable.
    struct Place
    {
        const DeformationChain& chain;
        const osg::Matrixd& modelView; ///< to the view's eye space
        double scale;                  ///< of that
        Visibility::Mask planes;       ///< that it may cross
        bool smallCounts;              ///< whether its size tells
    };
    /// False where it is out of sight; `depth` of its middle otherwise, metres.
    bool inSight(const osg::Drawable& drawable, const Place& place, double& depth);

    DepthRange& depths() { return _depths; }
    BoundsPicture& bounds() { return _bounds; }
    /// What is to be said once, from this traversal; empty as a rule.
    const std::string& complaint() const { return _complaint; }
    /// Forgets what has been deleted.
    void purge() { _meshBoxes.purge(); }

private:
    /// Whether all smaller boxes of a drawable miss the picture; false where it has none.
    bool meshOutside(const osg::Drawable& drawable, const Place& place, Visibility::Mask planes);
    bool misses(const osg::BoundingBox& box, const Place& place, Visibility::Mask planes);
    /// Whether the middle of one of them shows; of that one which showed last time.
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
