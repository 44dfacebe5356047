// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/ViewGeometry.h>
#include <tools/RandomSamples.h>

#include <osg/Matrixd>

#include <iosfwd>
#include <string>
#include <vector>

namespace geofx::test
{

/// A camera over a terrain by the numbers that a person would say: a path of cameras is a path of numbers.
struct CameraPose
{
    enum Lens
    {
        PERSPECTIVE,
        OFF_AXIS,
        ORTHOGRAPHIC
    };

    bool globe = false;         ///< WGS 84, geocentric; else projected
    double x = 0.0;             ///< east, metres; longitude, radians, on the globe
    double y = 0.0;             ///< north, metres; latitude, radians, on the globe
    double height = 1000.0;     ///< of the eye above z = 0 or the ellipsoid
    double heading = 0.0;       ///< radians, clockwise from north
    double pitch = 0.0;         ///< 0 level, −π/2 straight down
    double roll = 0.0;          ///< clockwise
    Lens lens = PERSPECTIVE;    ///<
    double fieldOfView = 0.8;   ///< from the bottom to the top of the picture, radians
    double pictureSize = 1e4;   ///< from the bottom to the top, metres; of an orthographic lens
    double aspect = 1.6;        ///<
    double shiftX = 0.0;        ///< of an off-axis lens, shares of half the picture
    double shiftY = 0.0;        ///<
    double lowestGround = 0.0;  ///< what the deformations are told of the terrain's heights
    double highestGround = 0.0; ///<

    osg::Matrixd modelView() const;
    osg::Matrixd projection() const;
    osgGeoFX::Ground ground() const;
    osgGeoFX::ViewGeometry view() const;
};

std::ostream& operator<<(std::ostream& stream, const CameraPose& pose);

/// Any camera: every lens, rolled, straight down, upside down, from eye level to 300 km, sometimes below ground.
CameraPose randomPose(Random& random);
/// A level or rolled camera that looks at ground from above, as people use them.
CameraPose randomCommonPose(Random& random);

/// Gives every property, also those of the effect's parts, a random value, most often a sensible one.
void randomizeProperties(osgGeoFX::PropertyHolder& effect, Random& random);
/// A deformation of a kind of effectKinds() with random properties; null where the kind is none.
osg::ref_ptr<osgGeoFX::Deformation> randomDeformation(const std::string& kind, Random& random);
/// Of any kind.
osg::ref_ptr<osgGeoFX::Deformation> randomDeformation(Random& random);
/// Moves what acts in one region of the ground to where a camera is, or near it. Other deformations stay as they are.
void bringNear(osgGeoFX::Deformation& deformation, const CameraPose& pose, Random& random);
/// The kinds that are deformations.
std::vector<std::string> deformationKinds();

/// The properties as text, for messages.
std::string describe(osgGeoFX::PropertyHolder& effect);

/// A point of eye space on or near the ground, up to `reach` metres from the eye's foot.
osg::Vec3d randomGroundPoint(Random& random, const osgGeoFX::ViewGeometry& view, double reach = 3e5);
osg::Vec3d randomDirection(Random& random);

/// Points of a panorama map's bending curve: one to six, now and then two of one height.
std::vector<osg::Vec2d> randomCurve(Random& random);

/// The numbers of a bend, from its uniforms.
struct BendNumbers
{
    osg::Vec3d normal;
    osg::Vec3d forward;
    double height = 0.0;
    double start = 0.0;
    double size = 0.0;
    double angle = 0.0;

    /// A point of eye space by its place along the bend, above T, and across.
    osg::Vec3d point(double s, double h, double across) const
    {
        return forward * (start + s) + normal * (h - height) + (forward ^ normal) * across;
    }
    double alongOf(const osg::Vec3d& point) const { return point * forward - start; }
    double heightOf(const osg::Vec3d& point) const { return point * normal + height; }
};

/// False where the frame is no bend.
bool bendNumbers(const osgGeoFX::DeformationSnapshot& snapshot, BendNumbers& numbers);
/// The largest curvature of a bend, with the angle's sign; `curve` as PerspectiveBend has it.
double bendCurvature(const BendNumbers& numbers, int curve);

/// The numbers of a regional liberty, from its uniforms.
struct LibertyNumbers
{
    osg::Vec3d up; ///< in eye space
    /// Half of the region's widths, metres.
    double across = 0.0;
    double along = 0.0;
};

/// False where the frame is no regional liberty.
bool libertyNumbers(const osgGeoFX::DeformationSnapshot& snapshot, LibertyNumbers& numbers);

/// A point whose place in a bend's profile is random, before, in or behind the zone; else a ground point.
osg::Vec3d randomPointFor(const osgGeoFX::DeformationSnapshot& snapshot, const osgGeoFX::ViewGeometry& view,
                          Random& random);

} // namespace geofx::test
