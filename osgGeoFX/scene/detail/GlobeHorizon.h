// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osg/ClusterCullingCallback>
#include <osg/Matrixd>
#include <osg/Vec3d>
#include <osg/Vec4d>

#include <cstddef>
#include <optional>

namespace osgGeoFX
{

/** The horizon of a deformed globe, for one camera and one drawn frame. It is conservative: what it hides lies behind deformed
    ground.

    An ellipsoid within all ground that is drawn stands for the globe. Deformations that move places along
    their verticals change the ellipsoid, and the heights above it. Where the rest of the deformations is one affine map, that map's
    inverse moves the eye instead. The last stretch of a line of sight is then a straight line in undeformed space, and ends at the
    place that it would reach. Where this stretch runs through the ellipsoid, it comes from within the deformed globe, whose surface
    has therefore hidden the place before.

    All positions are in the view's eye space, metres. Immutable, so every thread may use it. */
class GlobeHorizon
{
public:
    /// Of the equator's radius: no mountain is higher, and no sea deeper, on the Earth, the Moon and Mars.
    static constexpr double UNKNOWN_SHARE = 0.0035;

    /// Hides nothing.
    GlobeHorizon() = default;
    /// `chain` must outlive the object. `eye`: of the camera that draws. Hides nothing where the ground is a plane. Unknown heights count
    /// as those of the highest mountains and the deepest seas.
    GlobeHorizon(const DeformationChain& chain, const ViewGeometry& view, const osg::Vec3d& eye);

    /// Whether it may hide anything.
    explicit operator bool() const { return _chain != nullptr; }

    /// Whether a tile with a callback by createHorizonCulling() is hidden. `modelView`: from the tile's frame to eye space.
    /// `ball`: of the tile, undeformed. False for callbacks of another make.
    bool hides(const osg::ClusterCullingCallback& callback, const osg::Matrixd& modelView,
               const Ball& ball) const;
    /// Whether all ground within a ball is hidden.
    bool hides(const Ball& ball) const;
    /// Whether the ellipsoid, or what vertical movements make of it, hides a position, given undeformed. It is exact for a smooth
    /// globe, as osgEarth has it for labels, which are drawn without a depth test.
    bool hidesPlace(const osg::Vec3d& position) const;
    /// A plane such that all ground is visible at most on its positive side, given undeformed: a unit normal and a distance, in eye
    /// space. It goes through the smooth globe's horizon. Empty where there is none, as in panorama maps, or where it is unknown.
    std::optional<osg::Vec4d> plane() const;

private:
    /// A part of the globe, as seen from its center.
    struct Cap
    {
        osg::Vec3d middle; ///< a unit vector
        double radius;     ///< an angle
    };
    /// Of an ellipsoid, metres.
    struct Radii
    {
        double equator, polar;
    };
    bool hides(const Cap& cap, const Ball& ball) const;
    /// How far drawn triangles sink below the ground's curve at most where the globe hides anything, metres.
    double meshSag(const osg::Vec3d& eye) const;
    /// A vector from the center, in a space where an ellipsoid is the unit sphere.
    osg::Vec3d scaled(const osg::Vec3d& fromCenter, const Radii& radii) const;
    /// A position, from the center, in the space where the smooth globe is the unit sphere.
    osg::Vec3d scaled(const osg::Vec3d& position) const;
    /// The eye before the affine map in force at a place far ahead; the eye itself where nothing but vertical movements is.
    std::optional<osg::Vec3d> eyeAhead() const;
    /// The eye before the affine map of all that is within `stretch` of a ball; empty where there is no such map.
    std::optional<osg::Vec3d> eyeBefore(const Ball& ball, double stretch) const;
    /// The longest part of a line of sight from a place on a cap to the unit sphere. `highest`: the largest distance of ground from its
    /// center.
    static double stretchWithin(const Cap& cap, const osg::Vec3d& eye, double highest);

    const DeformationChain* _chain = nullptr;
    osg::Vec3d _eye;
    osg::Vec3d _up;
    double _surface = 0.0; ///< the deformed height of the smooth globe
    double _mountains =
        0.0; ///< how much farther beyond the horizon mountains show than they did, as seen from the center: an angle
    std::size_t _affineFrom = 0; ///< the first snapshot that does not move places along their verticals
    osg::Vec3d _center;          ///< of the globe
    osg::Vec3d _axis;            ///< of the globe, a unit vector
    double _equator = 0.0;       ///< the radii of the ellipsoid, or of what vertical movements make of it
    double _polar = 0.0;
    double _flat = 0.0;   ///< acos(the sphere of createHorizonCulling() / equator)
    double _lowest = 0.0; ///< the heights of the deformed ground, metres; not above 0 and not below it
    double _highest = 0.0;
    double _slack =
        0.0; ///< how far a vertical movement goes sideways at most, as seen from the center: an angle
};

} // namespace osgGeoFX
