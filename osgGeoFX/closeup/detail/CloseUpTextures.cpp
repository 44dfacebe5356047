// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/CloseUpTextures.h>

#include <osgGeoFX/closeup/detail/ArrayStorage.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace osgGeoFX
{

namespace
{

template<typename TextureType>
void setUp(TextureType& texture, GLint internalFormat, osg::Texture::FilterMode minFilter,
           osg::Texture::FilterMode magFilter)
{
    texture.setInternalFormat(internalFormat);
    texture.setFilter(osg::Texture::MIN_FILTER, minFilter);
    texture.setFilter(osg::Texture::MAG_FILTER, magFilter);
    texture.setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture.setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture.setResizeNonPowerOfTwoHint(false);
}

/// OSG loads an image into an array only if both have the same format.
constexpr GLint maskFormat = GL_RG32F;
constexpr GLint surfaceFormat = GL_RGBA16F_ARB;

osg::ref_ptr<osg::Image> emptyImage(int side, GLenum format, std::size_t channels)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, format, GL_FLOAT);
    image->setInternalTextureFormat(format == GL_RG ? maskFormat : surfaceFormat);
    std::memset(image->data(), 0,
                static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * channels * sizeof(float));
    return image;
}

/// A mask in the corner of a larger picture.
osg::ref_ptr<osg::Image> padded(const osg::Image& mask, int side)
{
    osg::ref_ptr<osg::Image> image = emptyImage(side, GL_RG, 2);
    for (int row = 0; row < mask.t(); ++row)
        std::memcpy(image->data(0, row), mask.data(0, row),
                    static_cast<std::size_t>(mask.s()) * 2 * sizeof(float));
    return image;
}

/// Values times their weights, so that averages leave holes out.
osg::ref_ptr<osg::Image> weighted(const osg::Image& layer)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(layer.s(), layer.t(), 1, GL_RGBA, GL_FLOAT);
    image->setInternalTextureFormat(surfaceFormat);
    for (int row = 0; row < layer.t(); ++row)
    {
        const auto* from = reinterpret_cast<const float*>(layer.data(0, row));
        auto* to = reinterpret_cast<float*>(image->data(0, row));
        for (int i = 0; i < 4 * layer.s(); i += 4)
        {
            const float weight = from[i + 3];
            for (int channel = 0; channel < 3; ++channel)
                to[i + channel] = weight > 0.0f ? from[i + channel] * weight : 0.0f;
            to[i + 3] = weight;
        }
    }
    return image;
}

std::pair<double, double> rangeOf(const osg::Image& layer)
{
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
    for (int row = 0; row < layer.t(); ++row)
    {
        const auto* texel = reinterpret_cast<const float*>(layer.data(0, row));
        for (int i = 0; i < 4 * layer.s(); i += 4)
        {
            if (!(texel[i + 3] > 0.0f)) continue;
            low = std::min(low, texel[i]);
            high = std::max(high, texel[i]);
        }
    }
    if (low > high) return {0.0, 1.0};
    return {static_cast<double>(low), static_cast<double>(high)};
}

/// The colors of a kind of data for a close-up without a table.
osg::ref_ptr<ColorTable> readyTable(SurfaceData::Kind kind, const std::pair<double, double>& range)
{
    switch (kind)
    {
    case SurfaceData::HEIGHT:
        return ColorTable::named("terrain", range.first, range.second);
    case SurfaceData::SLOPE:
        return ColorTable::named("magma", 0.0, osg::PI / 3.0);
    case SurfaceData::ASPECT:
        return ColorTable::named("viridis", 0.0, 2.0 * osg::PI);
    case SurfaceData::OCCLUSION:
        return ColorTable::named("greys", 0.0, 1.0);
    default:
        return ColorTable::named("viridis", range.first, range.second);
    }
}

} // namespace

void CloseUpTextures::updateMasks(const CloseUpList& closeUps)
{
    std::vector<osg::ref_ptr<const osg::Image>> images;
    int side = 1;
    for (std::size_t i = 0; i < closeUps.size(); ++i)
    {
        const osg::ref_ptr<const osg::Image> image = closeUps[i]->getRegion()->mask();
        // Several close-ups may share a region, and so its mask.
        const auto found = std::find(images.begin(), images.end(), image);
        _state.places[i].mask = static_cast<int>(found - images.begin());
        _state.places[i].maskSide = image->s();
        if (found == images.end()) images.push_back(image);
        side = std::max(side, image->s());
    }
    if (_state.masks && images == _maskImages) return;
    _maskImages = images;
    _state.masks = new osg::Texture2DArray;
    _state.masks->setSubloadCallback(new ArrayStorage(GL_RG, GL_FLOAT));
    setUp(*_state.masks, maskFormat, osg::Texture::LINEAR, osg::Texture::LINEAR);
    const unsigned int layers = std::max(1u, static_cast<unsigned int>(images.size()));
    _state.masks->setTextureSize(side, side, static_cast<int>(layers));
    if (images.empty()) _state.masks->setImage(0, emptyImage(side, GL_RG, 2));
    for (unsigned int i = 0; i < images.size(); ++i)
        _state.masks->setImage(i, padded(*images[i], side));
}

void CloseUpTextures::updateSurfaces(const SurfaceData* data)
{
    std::vector<unsigned int> counts;
    for (int i = 0; data && i < data->getNumLayers(); ++i)
        counts.push_back(data->getLayerImage(i)->getModifiedCount());
    const unsigned int revision = data ? data->revision() : 0;
    if (_state.surfaces && data == _data && revision == _dataRevision && counts == _imageCounts) return;
    _data = data;
    _dataRevision = revision;
    _imageCounts = counts;
    _ranges.clear();
    _state.normalLayer = -1;
    _state.surfaces = new osg::Texture2DArray;
    _state.surfaces->setSubloadCallback(new ArrayStorage(GL_RGBA, GL_FLOAT));
    if (counts.empty())
    {
        setUp(*_state.surfaces, surfaceFormat, osg::Texture::NEAREST, osg::Texture::NEAREST);
        _state.surfaces->setTextureSize(1, 1, 1);
        _state.surfaces->setImage(0, emptyImage(1, GL_RGBA, 4));
        return;
    }
    setUp(*_state.surfaces, surfaceFormat, osg::Texture::LINEAR_MIPMAP_LINEAR, osg::Texture::LINEAR);
    const osg::Image& first = *data->getLayerImage(0);
    _state.surfaces->setTextureSize(first.s(), first.t(), data->getNumLayers());
    for (int i = 0; i < data->getNumLayers(); ++i)
    {
        _state.surfaces->setImage(static_cast<unsigned int>(i), weighted(*data->getLayerImage(i)));
        _ranges.push_back(rangeOf(*data->getLayerImage(i)));
        if (data->getLayerKind(i) == SurfaceData::NORMAL && _state.normalLayer < 0) _state.normalLayer = i;
    }
}

void CloseUpTextures::updateTables(const CloseUpList& closeUps, const SurfaceData* data)
{
    std::vector<osg::Vec4ub> texels;
    const auto addRow = [&]
    {
        texels.resize(texels.size() + tableWidth);
        return static_cast<int>(texels.size()) / tableWidth - 1;
    };
    for (std::size_t i = 0; i < closeUps.size(); ++i)
    {
        const CloseUp& closeUp = *closeUps[i];
        CloseUpItem::Places& places = _state.places[i];
        places.anchorRow = addRow();
        osg::Vec4ub* row = texels.data() + texels.size() - tableWidth;
        for (int s = 0; s < tableWidth; ++s)
        {
            const double opacity = closeUp.getAnchor()->opacityAt(s / (tableWidth - 1.0));
            const auto byte = static_cast<unsigned char>(std::lround(255.0 * opacity));
            row[s].set(byte, byte, byte, byte);
        }
        places.surfaceLayer = data ? data->findLayer(closeUp.getSurface()) : -1;
        if (places.surfaceLayer < 0) continue;
        const SurfaceData::Kind kind = data->getLayerKind(places.surfaceLayer);
        places.surfaceKind = kind == SurfaceData::NORMAL ? 3 : 0;
        if (kind == SurfaceData::COLOR || kind == SurfaceData::NORMAL) continue;
        osg::ref_ptr<const ColorTable> table = closeUp.getTable();
        if (!table) table = readyTable(kind, _ranges[static_cast<std::size_t>(places.surfaceLayer)]);
        places.surfaceKind = table->getMode() == ColorTable::LINEAR ? 1 : 2;
        // The layer also has the sine and cosine of an aspect, which can be averaged. Classes cannot.
        if (kind == SurfaceData::ASPECT) places.surfaceKind = 4;
        if (kind == SurfaceData::CLASS) places.surfaceKind = 5;
        std::tie(places.low, places.high) = table->range();
        places.tableRow = addRow();
        table->row(places.low, places.high, texels.data() + texels.size() - tableWidth, tableWidth);
    }
    if (texels.empty()) addRow();
    if (_state.tables && texels == _tableTexels) return;
    _tableTexels = texels;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(tableWidth, static_cast<int>(texels.size()) / tableWidth, 1, GL_RGBA,
                         GL_UNSIGNED_BYTE);
    std::memcpy(image->data(), texels.data(), texels.size() * sizeof(osg::Vec4ub));
    _state.tables = new osg::Texture2D(image);
    setUp(*_state.tables, GL_RGBA8, osg::Texture::NEAREST, osg::Texture::NEAREST);
}

CloseUpTextures::State CloseUpTextures::update(const CloseUpList& closeUps, const SurfaceData* data)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _state.places.assign(closeUps.size(), {});
    updateMasks(closeUps);
    updateSurfaces(data);
    updateTables(closeUps, data);
    return _state;
}

void CloseUpTextures::resizeGLObjectBuffers(unsigned int size)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    osg::resizeGLObjectBuffers(_state.masks, size);
    osg::resizeGLObjectBuffers(_state.tables, size);
    osg::resizeGLObjectBuffers(_state.surfaces, size);
}

void CloseUpTextures::releaseGLObjects(osg::State* state) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_state.masks) _state.masks->releaseGLObjects(state);
    if (_state.tables) _state.tables->releaseGLObjects(state);
    if (_state.surfaces) _state.surfaces->releaseGLObjects(state);
}

} // namespace osgGeoFX
