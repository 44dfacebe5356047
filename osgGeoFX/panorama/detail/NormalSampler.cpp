// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/NormalSampler.h>

#include <osgGeoFX/effect/detail/TileNormals.h>

#include <osg/TexMat>
#include <osg/Texture2D>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace osgGeoFX
{

namespace
{

bool compressed(const osg::Image& image)
{
    return image.getPixelFormat() == GL_COMPRESSED_RED_GREEN_RGTC2_EXT;
}

/// The value of a channel, 0 to 255, in a block of RGTC: two ends, then three bits for each of 4 × 4 texels.
double valueInBlock(const unsigned char* block, int texel)
{
    std::uint64_t bits = 0;
    for (int byte = 5; byte >= 0; --byte)
        bits = bits << 8 | block[2 + byte];
    const int code = static_cast<int>(bits >> (3 * texel) & 7);
    const double first = block[0], second = block[1];
    if (code < 2) return code == 0 ? first : second;
    if (block[0] > block[1]) return ((8 - code) * first + (code - 1) * second) / 7.0;
    if (code >= 6) return code == 6 ? 0.0 : 255.0;
    return ((6 - code) * first + (code - 1) * second) / 5.0;
}

/// The value of a channel of a compressed image, 0 to 255.
double valueAt(const osg::Image& image, int column, int row, int channel)
{
    const int blocks = (image.s() + 3) / 4;
    const std::size_t block = static_cast<std::size_t>(row / 4 * blocks + column / 4);
    return valueInBlock(image.data() + 16 * block + 8 * channel, row % 4 * 4 + column % 4);
}

} // namespace

NormalSampler::NormalSampler(const osg::Geometry& geometry)
{
    const osg::StateSet* state = geometry.getStateSet();
    if (!state) return;
    const auto* texture = dynamic_cast<const osg::Texture2D*>(
        state->getTextureAttribute(TileNormals::unit, osg::StateAttribute::TEXTURE));
    const osg::Image* image = texture ? texture->getImage() : nullptr;
    if (!image || texture->getName() != TileNormals::texture || !image->data() || image->s() <= 0 ||
        image->t() <= 0 || image->getDataType() != GL_UNSIGNED_BYTE ||
        (image->getPixelFormat() != GL_RG && image->getPixelFormat() != GL_RGB && !compressed(*image)))
        return;
    _image = image;
    _rowStep = image->getRowStepInBytes();
    const auto* places = dynamic_cast<const osg::TexMat*>(
        state->getTextureAttribute(TileNormals::unit, osg::StateAttribute::TEXMAT));
    if (places) _places = places->getMatrix();
}

std::optional<osg::Vec3d> NormalSampler::at(double s, double t) const
{
    if (!_image || !std::isfinite(s) || !std::isfinite(t)) return {};
    const osg::Vec3d place = osg::Vec3d(s, t, 0.0) * _places;
    const double x = std::clamp(place.x() * _image->s() - 0.5, 0.0, _image->s() - 1.0);
    const double y = std::clamp(place.y() * _image->t() - 0.5, 0.0, _image->t() - 1.0);
    const int left = static_cast<int>(x), bottom = static_cast<int>(y);
    const bool blocks = compressed(*_image);
    const int channels = _image->getPixelFormat() == GL_RGB ? 3 : 2;
    osg::Vec3d normal;
    for (int corner = 0; corner < 4; ++corner)
    {
        const int column = std::min(left + corner % 2, _image->s() - 1);
        const int row = std::min(bottom + corner / 2, _image->t() - 1);
        const double weight =
            (corner % 2 ? x - left : 1.0 - x + left) * (corner / 2 ? y - bottom : 1.0 - y + bottom);
        const unsigned char* const texel = blocks
                                               ? nullptr
                                               : _image->data() + static_cast<std::size_t>(row) * _rowStep +
                                                     static_cast<std::size_t>(channels * column);
        for (int channel = 0; channel < channels; ++channel)
        {
            const double value = texel ? texel[channel] : valueAt(*_image, column, row, channel);
            normal[channel] += weight * (value - 128.0) / 127.0;
        }
    }
    if (channels == 2)
        normal.z() = std::sqrt(std::max(1.0 - normal.x() * normal.x() - normal.y() * normal.y(), 0.0));
    if (!(normal.length2() > 0.0)) return {};
    normal.normalize();
    return normal;
}

} // namespace osgGeoFX
