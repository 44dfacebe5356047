// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/RegionFilter.h>

#include <osgGeoFX/effect/DeformationChain.h>

#include <osg/ValueObject>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

bool isTriangles(const osg::Drawable& drawable)
{
    const osg::Geometry* geometry = drawable.asGeometry();
    if (!geometry) return false;
    const auto& primitives = geometry->getPrimitiveSetList();
    return std::all_of(primitives.begin(), primitives.end(),
                       [](const osg::ref_ptr<osg::PrimitiveSet>& each)
                       { return each->getMode() >= GL_TRIANGLES && each->getMode() <= GL_POLYGON; });
}

/// A line that only keeps the triangles beside it visible from afar (PathRibbon::leastPixels); close-ups show these.
bool isThinLine(const osg::Drawable& drawable)
{
    bool thin = false;
    return !isTriangles(drawable) && drawable.getUserValue("geofx.thinLine", thin) && thin;
}

} // namespace

RegionFilter::RegionFilter(const std::vector<CloseUpItem>& items, std::vector<std::size_t> wanted, bool culls,
                           TriangleCopies& copies, bool patches, StatesOf statesOf)
    : _items(items), _wanted(std::move(wanted)), _culls(culls), _copies(copies), _patches(patches),
      _statesOf(std::move(statesOf))
{
    found.contents.resize(items.size());
}

bool RegionFilter::outside(const Ball& ball) const
{
    return _culls && std::all_of(_wanted.begin(), _wanted.end(),
                                 [&](std::size_t item) { return _items[item].outside(ball); });
}

const std::vector<osg::StateSet*>& RegionFilter::states(const osg::Drawable& drawable, const EyeBox& box,
                                                        const osg::Matrixd& modelView, bool ownProgram)
{
    _touched.clear();
    _beyond.clear();
    _places.clear();
    _states.clear();
    if (isThinLine(drawable)) return _states;
    for (const std::size_t item : _wanted)
    {
        if (_items[item].outside(box))
        {
            if (!_culls) _beyond.push_back(item);
            continue;
        }
        _touched.push_back(item);
        const RegionOfInterest* shape = _items[item].closeUp().getRegion();
        _places.push_back(
            {item, modelView * _items[item].toRegion(), _items[item].otherSide(), shape, shape->revision()});
        RegionContents& region = found.contents[item];
        _items[item].includeHeights(box, region.lowest, region.highest);
        const osg::Geometry* geometry = _items[item].stretched() ? drawable.asGeometry() : nullptr;
        if (geometry)
            region.longestEdge =
                std::max(region.longestEdge, largestScale(modelView) * _copies.longestEdge(*geometry));
        region.ground.push_back({&drawable, modelView * osg::Matrixd::inverse(_items[item].regionToEye())});
    }
    if (_touched.empty() && _beyond.empty()) return _states;
    found.touches += static_cast<unsigned int>(_touched.size() + _beyond.size());
    ++found.drawables;
    if (ownProgram || !isTriangles(drawable)) found.foreign = true;
    // Each kind has draws of its own: which triangles share a draw can change the last bit of a pixel (Mesa draws all of
    // them another way where one must be clipped), and culling must not.
    _statesOf(_touched, _states);
    _statesOf(_beyond, _states);
    found.count += static_cast<unsigned int>(_states.size());
    return _states;
}

osg::Drawable* RegionFilter::drawn(osg::Drawable& drawable)
{
    osg::Geometry* geometry = drawable.asGeometry();
    if (!geometry || !isTriangles(drawable)) return &drawable;
    return _copies.of(*geometry, _places, _patches,
                      _culls ? TriangleCopies::OVER_REGIONS : TriangleCopies::EVERYWHERE);
}

} // namespace osgGeoFX
