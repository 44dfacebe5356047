// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/NormalSampler.h>

#include <osgGeoFX/scene/TileNormals.h>

#include <osg/TexMat>
#include <osg/Texture2D>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

NormalSampler::NormalSampler(const osg::Geometry& geometry)
{
    const osg::StateSet* state = geometry.getStateSet();
    if (!state) return;
    const auto* texture = dynamic_cast<const osg::Texture2D*>(
        state->getTextureAttribute(TileNormals::unit, osg::StateAttribute::TEXTURE));
    const osg::Image* image = texture ? texture->getImage() : nullptr;
    if (!image || texture->getName() != TileNormals::texture || !image->data() || image->s() <= 0 ||
        image->t() <= 0 || image->getDataType() != GL_UNSIGNED_BYTE ||
        (image->getPixelFormat() != GL_RG && image->getPixelFormat() != GL_RGB))
        return;
    _image = image;
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
    const int channels = _image->getPixelFormat() == GL_RG ? 2 : 3;
    osg::Vec3d normal;
    for (int corner = 0; corner < 4; ++corner)
    {
        const int column = std::min(left + corner % 2, _image->s() - 1);
        const int row = std::min(bottom + corner / 2, _image->t() - 1);
        const double weight =
            (corner % 2 ? x - left : 1.0 - x + left) * (corner / 2 ? y - bottom : 1.0 - y + bottom);
        const unsigned char* bytes =
            _image->data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
        for (int channel = 0; channel < channels; ++channel)
            normal[channel] += weight * (bytes[channel] - 128.0) / 127.0;
    }
    if (channels == 2)
        normal.z() = std::sqrt(std::max(1.0 - normal.x() * normal.x() - normal.y() * normal.y(), 0.0));
    if (!(normal.length2() > 0.0)) return {};
    normal.normalize();
    return normal;
}

} // namespace osgGeoFX
