// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/PanoramaEdge.h>

#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/PanoramaTextures.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// The part of the sky's whole turn that lies across the picture, if this is not cylindrical.
constexpr double skyAcross = 0.5;

/// As in shaders/stages/panorama.edge.glsl.
enum Drawn
{
    NONE,
    MAPPED,
    UNKNOWN,
    LAND,
    ISLAND
};

/// The heading as a share of a turn, clockwise from the north or from the y axis.
double headingOf(const ViewGeometry& view, const osg::Matrixd& modelView, const osg::Vec3d& right,
                 const osg::Vec3d& forward)
{
    osg::Vec3d north = view.polarAxis;
    if (!view.ground.ellipsoid) north = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 1.0, 0.0), modelView);
    return std::atan2(-(north * right), north * forward) / (2.0 * osg::PI);
}

} // namespace

PanoramaEdge::PanoramaEdge(const PanoramaMap& settings, PanoramaTextures& textures, const ViewGeometry& view,
                           const osg::Matrixd& modelView, const glsl::geofx_Panorama& panorama)
    : map(textures.noCover()), skyTexture(map)
{
    const osg::Vec3d right = toOsg(panorama.right), forward = toOsg(panorama.forward);
    cylinder = panorama.cylinder;
    const double turns = cylinder.ring > 0.0 ? settings.getHorizontalAngle() / (2.0 * osg::PI) : skyAcross;
    sky.set(settings.getHorizonLine(), settings.getHorizonBend(), headingOf(view, modelView, right, forward),
            turns);
    if (!settings.getSky() || settings.getEdge() == PanoramaMap::SEA) return;
    osg::ref_ptr<const osg::Node> root;
    view.ground.terrain.lock(root);
    const osg::ref_ptr<const EdgeMap> edge = textures.edge(settings, root);
    skyTexture = textures.sky(settings);
    if (!edge)
    {
        kind.w() = UNKNOWN;
        return;
    }
    if (!edge->ends()) return;
    map = edge->texture();
    const TerrainInfo& info = edge->info();
    const double radius = 1.0 / panorama.across;
    kind.z() = std::min(settings.getEdgeWidth() * radius, EdgeMap::widest() * edge->size());
    kind.w() = settings.getProjection() ? MAPPED : edge->island() ? ISLAND : LAND;

    osg::Matrixd toWorld;
    toWorld.invert(modelView);
    const osg::Vec3d place = toWorld.getTrans();
    osg::Vec3d east(1.0, 0.0, 0.0), north(0.0, 1.0, 0.0);
    osg::Vec2d rate(1.0, 1.0); // radians or metres for a metre on the ground
    const double toUnit = info.geocentric ? osg::DegreesToRadians(1.0) : 1.0;
    const osg::Vec2d middle = osg::Vec2d(info.west + info.east, info.south + info.north) * (0.5 * toUnit);
    osg::Vec2d foot(place.x(), place.y());
    if (info.geocentric)
    {
        const osg::EllipsoidModel globe;
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        globe.convertXYZToLatLongHeight(place.x(), place.y(), place.z(), latitude, longitude, height);
        foot.set(std::remainder(longitude - middle.x(), 2.0 * osg::PI) + middle.x(), latitude);
        east.set(-std::sin(longitude), std::cos(longitude), 0.0);
        north.set(-std::sin(latitude) * std::cos(longitude), -std::sin(latitude) * std::sin(longitude),
                  std::cos(latitude));
        // The ellipsoid's radii of curvature to the east and to the north. Its normals turn by a metre over them.
        const double a = globe.getRadiusEquator(), b = globe.getRadiusPolar();
        const double squared = 1.0 - (b * b) / (a * a), sine = std::sin(latitude);
        const double across = a / std::sqrt(1.0 - squared * sine * sine);
        rate.set(1.0 / across, 1.0 / (across * (1.0 - squared) / (1.0 - squared * sine * sine)));
        kind.x() = 1.0;
        kind.y() = middle.y();
    }
    const osg::Vec3d eastInEye = osg::Matrixd::transform3x3(east, modelView);
    const osg::Vec3d northInEye = osg::Matrixd::transform3x3(north, modelView);
    ways.set(right * eastInEye * rate.x(), right * northInEye * rate.y(), forward * eastInEye * rate.x(),
             forward * northInEye * rate.y());
    const double inner = EdgeMap::inner();
    eye.set(foot.x() - middle.x(), info.geocentric ? foot.y() : foot.y() - middle.y(),
            inner / ((info.east - info.west) * toUnit), inner / ((info.north - info.south) * toUnit));
}

glsl::geofx_Edge PanoramaEdge::frame() const
{
    return {kind.x(),
            {eye.x(), eye.y()},
            {ways.x(), ways.y()},
            {ways.z(), ways.w()},
            {eye.z(), eye.w()},
            kind.y(),
            cylinder};
}

} // namespace osgGeoFX
