// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/detail/WayBands.h>

#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Pieces of a leg: bends bend it.
constexpr int PIECES = 4;

/// A place's neighborhood: heights of names.
class Heights
{
public:
    Heights(const osg::EllipsoidModel& globe, const NameSet& names, const std::vector<NameSet::Seen>& seen)
        : _globe(globe)
    {
        for (const NameSet::Seen& each : seen)
        {
            const osg::Vec3d& place = names.names()[each.name].places.front();
            double latitude = 0.0, longitude = 0.0, height = 0.0;
            globe.convertXYZToLatLongHeight(place.x(), place.y(), place.z(), latitude, longitude, height);
            _places.push_back({place, height});
        }
    }
    osg::Vec3d world(const osg::Vec2d& degrees) const
    {
        const osg::Vec3d level = worldAt(degrees, 0.0);
        double nearest = HUGE_VAL, height = 0.0;
        for (const Place& each : _places)
        {
            const double away = (each.world - level).length2();
            if (away >= nearest) continue;
            nearest = away;
            height = each.height;
        }
        return worldAt(degrees, height);
    }

private:
    struct Place
    {
        osg::Vec3d world;
        double height;
    };
    osg::Vec3d worldAt(const osg::Vec2d& degrees, double height) const
    {
        osg::Vec3d world;
        _globe.convertLatLongHeightToXYZ(osg::DegreesToRadians(degrees.y()),
                                         osg::DegreesToRadians(degrees.x()), height, world.x(), world.y(),
                                         world.z());
        return world;
    }
    const osg::EllipsoidModel& _globe;
    std::vector<Place> _places;
};

/// Half of a way's width at a place, pixels.
double pixelsAcross(const DeformedView& view, const osg::Vec3d& world, double metres)
{
    osg::Vec3d up = world;
    up.normalize();
    osg::Vec3d east = osg::Vec3d(0.0, 0.0, 1.0) ^ up;
    if (east.normalize() < 1e-9) east.set(1.0, 0.0, 0.0);
    osg::Vec2d here, there;
    double most = 0.0;
    for (const osg::Vec3d& way : {east, up ^ east})
        if (view.project(world, here) && view.project(world + way * metres, there))
            most = std::max(most, (there - here).length());
    return most;
}

} // namespace

std::vector<LabelBand> bandsOfWays(const EffectScene& scene, const DeformedView& view, const NameSet& names,
                                   const std::vector<NameSet::Seen>& seen)
{
    std::vector<LabelBand> bands;
    const osg::EllipsoidModel* const globe = view.ground().ellipsoid.get();
    if (!globe || seen.empty()) return bands;
    const Heights heights(*globe, names, seen);
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        const auto* ways = dynamic_cast<const ProjectiveMappings*>(scene.getEffect(i));
        for (unsigned int k = 0; ways && ways->getEnabled() && k < ways->getNumRoutes(); ++k)
        {
            const RouteMapping& route = *ways->getRoute(k);
            const std::vector<osg::Vec2d>& degrees = route.getGeographicWayPoints();
            const RouteMapping::Style style = route.getStyle();
            bool known = false;
            LabelBand band;
            for (std::size_t leg = 0; leg + 1 < degrees.size(); ++leg)
                for (int piece = leg == 0 ? 0 : 1; piece <= PIECES; ++piece)
                {
                    const osg::Vec3d world = heights.world(degrees[leg] + (degrees[leg + 1] - degrees[leg]) *
                                                                              (double(piece) / PIECES));
                    const bool seenBefore = known;
                    band.from = band.to;
                    known = view.project(world, band.to);
                    if (!known || !seenBefore) continue;
                    band.halfWidth = pixelsAcross(view, world, style.halfWidth + style.casing);
                    bands.push_back(band);
                }
        }
    }
    return bands;
}

} // namespace osgGeoFX
