// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/GeometrySwap.h>

#include <osg/Notify>

namespace osgGeoFX
{

namespace
{

constexpr const char* define = "GEOFX_MAPPING_CHANNELS";
constexpr const char* channelsOf[] = {"1", "2", "252"};
constexpr int topmost = 1000;
constexpr double everywhere = 1e6; ///< metres around the mask in which the inner geometry is taken away

void makeDiscarding(ProjectiveMapping& mapping, int channels, ColorTransfer::Alpha alpha, double low,
                    double high)
{
    mapping.setOrder(topmost);
    mapping.setChannels(channels);
    mapping.setSoftEdges(false);
    mapping.setImportance(1.0);
    ColorTransfer& transfer = *mapping.getTransfer();
    transfer.setEquation(ColorTransfer::DISCARD);
    transfer.setSource(ColorTransfer::SCENE);
    transfer.setAlpha(alpha);
    transfer.setRamp(low, high);
}

} // namespace

GeometrySwap::GeometrySwap(osg::Node& inside, osg::Node& outside, osg::Node& rest,
                           ProjectiveMappings& mappings, DataLayer* mask, const osg::Vec2d& center,
                           double halfWidth, double halfHeight)
    : _nodes{&inside, &outside, &rest}, _masked(mappings, [](ProjectiveMapping&) {}),
      _around(mappings,
              [](ProjectiveMapping& mapping) { makeDiscarding(mapping, 1, ColorTransfer::OPAQUE, 0.0, 1.0); })
{
    for (int i = 0; i < 3; ++i)
        _nodes[i]->getOrCreateStateSet()->setDefine(define, channelsOf[i]);
    makeDiscarding(_masked.next(), 1, ColorTransfer::FROM_MASK, 1.0, 0.0);
    makeDiscarding(_masked.next(), 2, ColorTransfer::FROM_MASK, 0.0, 1.0);
    setMask(mask);
    setPlace(center, halfWidth, halfHeight);
}

GeometrySwap::~GeometrySwap()
{
    for (int i = 0; i < 3; ++i)
    {
        osg::StateSet* state = _nodes[i]->getStateSet();
        const osg::StateSet::DefinePair* found = state ? state->getDefinePair(define) : nullptr;
        if (found && found->first == channelsOf[i]) state->removeDefine(define);
    }
}

bool GeometrySwap::setMask(DataLayer* mask)
{
    if (!mask)
    {
        OSG_WARN << "osgGeoFX: GeometrySwap needs a mask; the former one stays." << std::endl;
        return false;
    }
    for (std::size_t i = 0; i < _masked.size(); ++i)
        _masked.at(i).setMask(mask);
    return true;
}

bool GeometrySwap::setPlace(const osg::Vec2d& center, double halfWidth, double halfHeight)
{
    for (std::size_t i = 0; i < _masked.size(); ++i)
    {
        if (!_masked.at(i).setRectangle(center, halfWidth, halfHeight)) return false;
    }
    const osg::Vec2d half(halfWidth, halfHeight);
    surround(_around, center - half, center + half, everywhere);
    return true;
}

void GeometrySwap::setEnabled(bool enabled)
{
    for (const MappingPool* pool : {&_masked, &_around})
    {
        for (std::size_t i = 0; i < pool->size(); ++i)
            pool->at(i).setEnabled(enabled);
    }
}

osg::ref_ptr<GeometrySwap> swapGeometries(osg::Node& inside, osg::Node& outside, osg::Node& rest,
                                          ProjectiveMappings& mappings, DataLayer* mask,
                                          const osg::Vec2d& center, double halfWidth, double halfHeight)
{
    return new GeometrySwap(inside, outside, rest, mappings, mask, center, halfWidth, halfHeight);
}

} // namespace osgGeoFX
