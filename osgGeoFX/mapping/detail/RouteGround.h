// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/paging/Georeference.h>

#include <cstddef>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// The numbers of the places that remain when what lies within the tolerance of the rest is left out (Douglas and Peucker).
std::vector<std::size_t> keptWithin(const std::vector<osg::Vec2d>& places, double tolerance);

/// Where degrees lie in the frame of an effect. All must outlive this.
class RouteGround
{
public:
    /// `ellipsoid`: of a globe; null on a projected terrain, which has a reference.
    RouteGround(const ProjectiveMappings& effect, const osg::EllipsoidModel* ellipsoid,
                const Georeference* reference)
        : _effect(effect), _ellipsoid(ellipsoid), _reference(reference)
    {
    }

    /// False, with a sentence in `error`, if the frame has no place for it.
    bool placeOf(const osg::Vec2d& degrees, osg::Vec2d& place, std::string& error) const;
    /// The places of a line along geodesics, as dense as they are; false as above, also where two neighbours lie on two sides of the
    /// edge of a map.
    bool placesOf(const std::vector<osg::Vec2d>& degrees, std::vector<osg::Vec2d>& places,
                  std::string& error) const;
    /// A route's line through way points: RouteMapping::setGeographicWayPoints().
    bool lay(const std::vector<osg::Vec2d>& degrees, RouteMapping::Way& way, std::string& error) const;

    static constexpr std::size_t mostWayPoints = 20000;
    /// Between places of a dense line, metres. A geodesic in Mercator's projection at 80° bends by half a metre in such a piece.
    static constexpr double step = 2000.0;

private:
    const ProjectiveMappings& _effect;
    const osg::EllipsoidModel* _ellipsoid;
    const Georeference* _reference;
};

} // namespace osgGeoFX
