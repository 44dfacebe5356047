// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/scene/detail/EyeFrustum.h>

#include <osg/Matrixd>
#include <osg/Polytope>
#include <osg/Vec2d>
#include <osg/Vec4d>
#include <osg/Viewport>

#include <utility>

namespace osgGeoFX
{

/** What one camera sees of balls and boxes once they are deformed: by the planes of its frustum, by hulls in its picture, and by
    their size in pixels. Knows nothing of a scene graph. Everything is in the view's eye space, metres. For one thread at a time. */
class Visibility
{
public:
    using Mask = EyeFrustum::Mask;

    struct Camera
    {
        osg::Matrixd projection;
        const ViewGeometry::Image* image = nullptr; ///< where it draws another camera's view; null: its own
        const osg::Viewport* viewport = nullptr;    ///< null: sizes in pixels are unknown
        const osg::Polytope* planes =
            nullptr; ///< of the frustum, in the camera's eye space; null: they cull nothing
        /// Which of them there are: those of the picture's sides, of the depths −1 and 1.
        bool sides = true, nearPlane = true, farPlane = true;
        double smallPixels = 0.0; ///< what is smaller is out of sight; 0: nothing is too small
        double reach = 0.0;       ///< how far beyond its own part of the picture a thing may draw, pixels
    };
    void set(const Camera& camera);

    /// All planes.
    Mask all() const { return _frustum.all(); }
    bool cullsSmall() const { return _smallPixels > 0.0; }
    /// The radius, metres, of a ball at a point that is one pixel wide as OSG counts it.
    double radiusOfPixel(const osg::Vec3d& point) const;
    /// What a depth in front of the camera's eye is, metres: the product with (x, y, z, 1).
    const osg::Vec4d& depths() const { return _depths; }
    /// The sides of the picture, whatever culls.
    const EyeFrustum& picture() const { return _picture; }

    /// Whether a deformed ball is out of sight. Removes the planes from the mask that have the whole ball on their
    /// inner side. `mayBeSmall`: its size does not count.
    bool outOfSight(const Ball& deformed, Mask& planes, bool mayBeSmall = false) const;
    bool tooSmall(const Ball& deformed) const;
    /// Whether nothing of a ball, still undeformed, is to be drawn, wherever it goes.
    bool hides(const DeformationChain& chain, const Ball& ball) const
    {
        return _hides && chain.hides(ball, _room);
    }
    bool hides(const DeformationChain& chain, const EyeBox& box) const
    {
        return _hides && chain.hides(box, _room);
    }
    /// The least and the greatest depth of a deformed box; any numbers.
    std::pair<double, double> depthsOf(const DeformationChain& chain, const EyeBox& box);
    /// Whether a point is inside of the planes of a mask.
    bool holds(const osg::Vec3d& deformed, Mask planes) const { return _frustum.holds(deformed, planes); }
    /// Whether the hull of a deformed box misses the picture. Slow. What it holds may reach beyond the box' image by `margin`,
    /// metres.
    bool misses(const DeformationChain& chain, const EyeBox& box, Mask planes, double margin = 0.0);
    /// The same, with a test of a ball around the box first. A box whose hull is loose is halved up to `halvings` times.
    bool outOfSight(const DeformationChain& chain, const EyeBox& box, Mask planes, int halvings = 0);

private:
    EyeFrustum _frustum, _picture;
    osg::Vec2d _room; ///< the reach in the picture's x and y (−1…1)
    double _smallPixels = 0.0;
    osg::Vec4d _pixelSize;
    osg::Vec4d _depths = osg::Vec4d(0.0, 0.0, -1.0, 0.0);
    bool _hides = true; ///< what the view hides is not in this image, either
    Hull _hull;
};

} // namespace osgGeoFX
