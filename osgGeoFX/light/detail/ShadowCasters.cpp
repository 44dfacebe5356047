// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/detail/ShadowCasters.h>

#include <osg/Geometry>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

/// Directions that were turned to eye space and back differ by less.
constexpr double sameDirection = 1e-6;
/// Of a texel, so that no edge of a shadow shows it.
constexpr double slackOfTexel = 0.01;

void mix(std::uint64_t& stamp, std::uint64_t number)
{
    stamp = (stamp ^ number) * 1099511628211u;
}

void mix(std::uint64_t& stamp, const osg::BufferData* data)
{
    mix(stamp, reinterpret_cast<std::uintptr_t>(data));
    if (!data) return;
    mix(stamp, data->getModifiedCount());
    mix(stamp, data->getTotalDataSize());
}

/// Another number after any change of what is drawn, but for color.
std::uint64_t contentsOf(const osg::Geometry& geometry)
{
    std::uint64_t stamp = 14695981039346656037u;
    mix(stamp, geometry.getVertexArray());
    for (const osg::ref_ptr<osg::PrimitiveSet>& each : geometry.getPrimitiveSetList())
    {
        mix(stamp, each.get());
        mix(stamp, each->getMode());
        mix(stamp, each->getNumIndices());
        mix(stamp, static_cast<std::uint64_t>(each->getNumInstances()));
    }
    mix(stamp, reinterpret_cast<std::uintptr_t>(geometry.getStateSet()));
    return stamp;
}

bool near(const std::array<osg::Vec3d, 4>& a, const std::array<osg::Vec3d, 4>& b, double slack)
{
    return std::equal(a.begin(), a.end(), b.begin(),
                      [&](const osg::Vec3d& one, const osg::Vec3d& other)
                      { return (one - other).length2() <= slack * slack; });
}

} // namespace

void ShadowCasters::begin(const ShadowCascade& cascade, const osg::Matrixd& toWorld)
{
    _toWorld = toWorld;
    _slack = slackOfTexel * cascade.texel;
    _radius = cascade.radius;
    _depth = cascade.depth;
    _changing = false;
    _casters.clear();
    _frame[0] = cascade.center * toWorld;
    // The map's axes, which are also scaled as it is.
    for (int axis = 0; axis < 3; ++axis)
    {
        osg::Vec3d row(cascade.toMap(0, axis), cascade.toMap(1, axis), cascade.toMap(2, axis));
        row.normalize();
        _frame[static_cast<std::size_t>(axis) + 1] = osg::Matrixd::transform3x3(row, toWorld);
    }
}

void ShadowCasters::add(const osg::Drawable& drawable, const EyeBox& box)
{
    const osg::Geometry* const geometry = drawable.asGeometry();
    // What draws by code of its own may draw anything.
    _changing = _changing || !geometry || drawable.getDrawCallback();
    if (_changing) return;
    Caster caster;
    caster.who = drawable.getOrCreateObserverSet();
    caster.contents = contentsOf(*geometry);
    caster.place[0] = box.center * _toWorld;
    for (std::size_t i = 0; i < 3; ++i)
        caster.place[i + 1] = osg::Matrixd::transform3x3(box.half[i], _toWorld);
    _casters.push_back(caster);
}

bool ShadowCasters::same(const ShadowCasters& other) const
{
    if (_changing || other._changing || _radius != other._radius || _depth != other._depth ||
        _casters.size() != other._casters.size() || (_frame[0] - other._frame[0]).length() > _slack)
        return false;
    for (std::size_t i = 1; i < 4; ++i)
        if ((_frame[i] - other._frame[i]).length() > sameDirection) return false;
    return std::equal(_casters.begin(), _casters.end(), other._casters.begin(),
                      [&](const Caster& a, const Caster& b) {
                          return a.who == b.who && a.contents == b.contents && near(a.place, b.place, _slack);
                      });
}

} // namespace osgGeoFX
