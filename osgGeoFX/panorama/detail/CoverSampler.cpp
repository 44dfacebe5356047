// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/CoverSampler.h>

#include <osgGeoFX/effect/detail/FirstParent.h>

#include <osg/Texture2D>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

const osg::Image* imageOf(const osg::StateSet* state, unsigned int unit)
{
    const osg::StateAttribute* attribute =
        state ? state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE) : nullptr;
    const auto* texture = dynamic_cast<const osg::Texture2D*>(attribute);
    const osg::Image* image = texture ? texture->getImage() : nullptr;
    const bool readable = image && image->data() && image->s() > 0 && image->t() > 0 &&
                          image->getPixelFormat() == GL_RGBA && image->getDataType() == GL_UNSIGNED_BYTE;
    return readable ? image : nullptr;
}

} // namespace

CoverSampler::CoverSampler(const osg::Geometry& geometry, unsigned int unit)
{
    const osg::Node* node = &geometry;
    while (node && !_image)
    {
        _image = imageOf(node->getStateSet(), unit);
        node = firstParent(*node);
    }
    if (_image) _rowStep = _image->getRowStepInBytes();
}

glsl::Rgba CoverSampler::at(double s, double t) const
{
    if (!_image || !std::isfinite(s) || !std::isfinite(t)) return {0.0, 0.0, 0.0, 1.0};
    const auto texel = [](double coordinate, int count)
    {
        return std::clamp(coordinate * count - 0.5, 0.0, count - 1.0);
    };
    const double x = texel(s, _image->s()), y = texel(t, _image->t());
    const int left = static_cast<int>(x), bottom = static_cast<int>(y);
    const int right = std::min(left + 1, _image->s() - 1), top = std::min(bottom + 1, _image->t() - 1);
    const auto read = [&](int column, int row)
    {
        const unsigned char* bytes =
            _image->data() + static_cast<std::size_t>(row) * _rowStep + 4 * static_cast<std::size_t>(column);
        return glsl::Rgba(bytes[0], bytes[1], bytes[2], bytes[3]) / 255.0;
    };
    return glm::mix(glm::mix(read(left, bottom), read(right, bottom), x - left),
                    glm::mix(read(left, top), read(right, top), x - left), y - bottom);
}

} // namespace osgGeoFX
