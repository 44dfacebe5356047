// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <osg/Vec2d>

#include <array>

namespace osgGeoFX
{

/// The projective map between a picture, 0…1 from its lower left corner, and a convex quadrilateral: corners from the lower left
/// one counter-clockwise in the picture.
class QuadMap
{
public:
    explicit QuadMap(const std::array<osg::Vec2d, 4>& corners) : _origin(corners[0])
    {
        // Relative to a corner, since degrees and metres have many digits.
        const osg::Vec2d b = corners[1] - _origin, c = corners[2] - _origin, d = corners[3] - _origin;
        const osg::Vec2d s = c - b, t = c - d, e = b + d - c;
        const double area = s.x() * t.y() - s.y() * t.x();
        const double g = (e.x() * t.y() - e.y() * t.x()) / area;
        const double h = (s.x() * e.y() - s.y() * e.x()) / area;
        _toPlace = glm::dmat3(glm::dvec3(b.x() * (1.0 + g), b.y() * (1.0 + g), g),
                              glm::dvec3(d.x() * (1.0 + h), d.y() * (1.0 + h), h), glm::dvec3(0.0, 0.0, 1.0));
        _toPicture = glm::inverse(_toPlace);
    }

    osg::Vec2d place(const osg::Vec2d& uv) const { return apply(_toPlace, uv) + _origin; }
    /// Far outside of 0…1 beyond the map's horizon.
    osg::Vec2d picture(const osg::Vec2d& place) const { return apply(_toPicture, place - _origin); }

private:
    static osg::Vec2d apply(const glm::dmat3& m, const osg::Vec2d& p)
    {
        const glm::dvec3 r = m * glm::dvec3(p.x(), p.y(), 1.0);
        // One sign within the quadrilateral, which the middle has.
        if (!(r.z * (m * glm::dvec3(0.0, 0.0, 1.0)).z > 0.0)) return {-1e9, -1e9};
        return {r.x / r.z, r.y / r.z};
    }

    osg::Vec2d _origin;
    glm::dmat3 _toPlace, _toPicture;
};

} // namespace osgGeoFX
