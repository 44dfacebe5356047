// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/TileBytes.h>

#include <osg/Geometry>
#include <osg/Image>
#include <osg/Texture>

namespace osgGeoFX
{

namespace
{

// A node with its lists and its place in those of others, bytes.
constexpr std::uint64_t NODE = 700, STATE = 900, ARRAY = 250;

bool hasMipmaps(const osg::Texture& texture)
{
    const osg::Texture::FilterMode filter = texture.getFilter(osg::Texture::MIN_FILTER);
    return filter != osg::Texture::LINEAR && filter != osg::Texture::NEAREST;
}

} // namespace

void TileBytes::apply(osg::Node& node)
{
    if (!meet(&node)) return;
    _size.processBytes += NODE;
    add(node.getStateSet());
    traverse(node);
}

void TileBytes::apply(osg::Drawable& drawable)
{
    if (!meet(&drawable)) return;
    _size.processBytes += NODE;
    add(drawable.getStateSet());
    const osg::Geometry* geometry = drawable.asGeometry();
    if (!geometry) return;
    osg::Geometry::ArrayList arrays;
    geometry->getArrayList(arrays);
    for (const auto& each : arrays)
        add(each.get());
    for (const auto& each : geometry->getPrimitiveSetList())
        add(each.get());
}

void TileBytes::add(const osg::StateSet* state)
{
    if (!state || !meet(state)) return;
    _size.processBytes += STATE;
    for (unsigned int unit = 0; unit < state->getTextureAttributeList().size(); ++unit)
    {
        const osg::StateAttribute* attribute = state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE);
        const osg::Texture* texture = attribute ? attribute->asTexture() : nullptr;
        if (texture && meet(texture)) add(*texture);
    }
}

void TileBytes::add(const osg::BufferData* data)
{
    if (!data || !meet(data)) return;
    const std::uint64_t bytes = data->getTotalDataSize();
    _size.processBytes += ARRAY + bytes;
    _size.gpuBytes += bytes;
}

void TileBytes::add(const osg::Texture& texture)
{
    for (unsigned int i = 0; i < texture.getNumImages(); ++i)
    {
        const osg::Image* image = texture.getImage(i);
        if (!image || !meet(image)) continue;
        const std::uint64_t bytes = image->getTotalSizeInBytesIncludingMipmaps();
        _size.processBytes += ARRAY + bytes;
        // A quarter for each further level, which OpenGL makes by itself.
        _size.gpuBytes += !image->isMipmap() && hasMipmaps(texture) ? bytes * 4 / 3 : bytes;
    }
}

} // namespace osgGeoFX
