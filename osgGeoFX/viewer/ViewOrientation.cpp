// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/ViewOrientation.h>

#include <osgGeoFX/scene/DeformedView.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr int samples = 48; ///< of each part

/// True north at the eye, in eye space.
osg::Vec3d northOf(const ViewGeometry& geometry, const osg::Matrixd& toWorld, const Georeference* reference)
{
    double longitude = 0.0, latitude = 0.0, height = 0.0;
    osg::Matrixd frame;
    if (reference && reference->toGeodetic(toWorld.getTrans(), longitude, latitude, height) &&
        reference->localToWorld(longitude, latitude, height, frame))
        return osg::Matrixd::transform3x3(osg::Vec3d(0.0, 1.0, 0.0), frame * geometry.modelView);
    if (geometry.ground.ellipsoid) return geometry.polarAxis;
    return osg::Matrixd::transform3x3(osg::Vec3d(0.0, 1.0, 0.0), geometry.modelView);
}

/// Distances from the eye's foot that show the shape of the ground.
std::vector<double> distancesOf(const ViewGeometry& geometry, const ViewOrientation& view,
                                const osg::Vec3d& forward)
{
    // Where the picture's lower edge shows the ground; the ground farther back is not seen.
    osg::Vec3d origin, ray;
    geometry.ray(0.0, -1.0, origin, ray);
    const double down = -(ray * geometry.up);
    const double height = view.height + origin * geometry.up;
    const double edge = down > 0.0 ? origin * forward + height * (ray * forward) / down : -10.0 * view.height;
    const double nearest = std::max(edge, -10.0 * view.height);
    std::vector<double> result;
    const auto add = [&](double from, double to)
    {
        for (int i = 0; i < samples; ++i)
            result.push_back(from + (to - from) * i / samples);
    };
    if (!view.bend)
    {
        // Evenly by the angle below the eye, down to a degree below the horizon.
        const double first = std::atan2(nearest, view.height);
        for (int i = 0; i <= samples; ++i)
            result.push_back(view.height *
                             std::tan(first + (osg::DegreesToRadians(89.0) - first) * i / samples));
        return result;
    }
    const BendPlacement& place = view.bend->place;
    const double end = place.start + place.size;
    if (nearest < place.start) add(nearest, place.start);
    add(place.start, end);
    // What lies behind is straight; its beginning shows how it lies, and its far part is small in the picture.
    add(end, end + std::max(place.size, 2.0 * view.height));
    for (double factor = 1.0; factor < 1e3; factor *= 2.0)
        result.push_back(end + factor * std::max(place.size, 2.0 * view.height));
    return result;
}

} // namespace

std::optional<ViewOrientation> ViewOrientation::of(EffectScene& scene, const osg::Camera& camera,
                                                   const Georeference* reference)
{
    if (!camera.getViewport()) return std::nullopt;
    const DeformedView picture(scene, camera);
    const osg::Matrixd& projection = camera.getProjectionMatrix();
    const ViewGeometry geometry(picture.modelView(), projection, picture.ground());
    osg::Matrixd toWorld;
    toWorld.invert(picture.modelView());

    const osg::Vec3d up = geometry.up;
    osg::Vec3d forward = up ^ osg::Vec3d(1.0, 0.0, 0.0);
    if (forward.normalize() < 0.05) return std::nullopt;
    osg::Vec3d north = northOf(geometry, toWorld, reference);
    north -= up * (north * up);
    // A pole has no north.
    if (north.normalize() <= 0.0) north = forward;
    const osg::Vec3d east = north ^ up;

    ViewOrientation view;
    view.heading = std::atan2(forward * east, forward * north);
    if (view.heading < 0.0) view.heading += 2.0 * osg::PI;
    view.pitch = std::asin(std::clamp(-up.z(), -1.0, 1.0));
    view.bend = BendOnGround::of(scene, camera);
    const Ground& ground = picture.ground();
    const double level = std::clamp(0.0, ground.minHeight, std::max(ground.minHeight, ground.maxHeight));
    view.height = view.bend ? view.bend->place.planeHeight : geometry.eyeHeight - level;
    view.north = osg::Matrixd::transform3x3(north, toWorld);
    view.east = osg::Matrixd::transform3x3(east, toWorld);
    view.up = osg::Matrixd::transform3x3(up, toWorld);
    view.foot = toWorld.getTrans() - view.up * view.height;
    if (!(view.height > 0.0)) return view;

    const osg::Vec3d across = forward ^ up;
    std::vector<osg::Vec3d> places;
    std::vector<double> rows;
    for (const double distance : distancesOf(geometry, view, forward))
    {
        const osg::Vec3d before = forward * distance - up * view.height;
        const osg::Vec3d after = picture.chain().deform(before);
        const osg::Vec4d clip = osg::Vec4d(after, 1.0) * projection;
        Point point;
        point.distance = distance;
        point.place.set(after * forward, after * up);
        const double style = picture.chain().style(before);
        point.part = style <= 0.0 ? FOCUS : style < 1.0 ? ZONE : CONTEXT;
        const double row = clip.w() > 0.0 ? clip.y() / clip.w() : 2.0;
        point.inPicture = std::abs(row) <= 1.0 + 1e-9;
        places.push_back(after);
        rows.push_back(row);
        view.profile.push_back(point);
    }

    const bool perspective = projection(3, 3) == 0.0;
    for (const Part part : {FOCUS, ZONE, CONTEXT})
    {
        double low = 2.0, high = -2.0;
        for (std::size_t i = 0; i < rows.size(); ++i)
        {
            if (view.profile[i].part != part || !view.profile[i].inPicture) continue;
            low = std::min(low, rows[i]);
            high = std::max(high, rows[i]);
        }
        if (low > high) continue;
        std::size_t middle = 0;
        double best = 2.0;
        for (std::size_t i = 0; i < rows.size(); ++i)
        {
            const double away = std::abs(rows[i] - 0.5 * (low + high));
            if (view.profile[i].part != part || !(away < best)) continue;
            best = away;
            middle = i;
        }
        // Along the ground as it is shown, within the part: it may end with a kink.
        const auto inPart = [&](std::size_t i)
        {
            return view.profile[i].part == part ? i : middle;
        };
        const std::size_t before = inPart(middle > 0 ? middle - 1 : 0);
        const std::size_t after = inPart(std::min(middle + 1, places.size() - 1));
        osg::Vec3d normal = (places[after] - places[before]) ^ across;
        osg::Vec3d sight = perspective ? places[middle] : osg::Vec3d(0.0, 0.0, -1.0);
        if (normal.normalize() <= 0.0 || sight.normalize() <= 0.0) continue;
        view.seen[part] = std::asin(std::clamp(std::abs(normal * sight), 0.0, 1.0));
    }
    return view;
}

} // namespace osgGeoFX
