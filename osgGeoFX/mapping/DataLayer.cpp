// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/DataLayer.h>

namespace osgGeoFX
{

DataLayer::DataLayer(const DataLayer& other, const osg::CopyOp& copy)
    : PropertyHolder(other, copy), _image(copy(other._image.get())), _texture(other._texture),
      _kind(other._kind), _smooth(other._smooth), _sRgb(other._sRgb), _hasNoData(other._hasNoData),
      _noData(other._noData), _importance(other._importance)
{
}

DataLayer::~DataLayer() = default;

void DataLayer::setImage(osg::Image* image)
{
    if (_image == image) return;
    _image = image;
    touch();
}

void DataLayer::setTexture(osg::Texture2D* texture)
{
    if (_texture == texture) return;
    _texture = texture;
    touch();
}

const Properties& DataLayer::properties() const
{
    using Self = DataLayer;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            Property::choice("kind", "what the numbers are",
                             {{"color", ""},
                              {"value", "the first channel's numbers"},
                              {"class", "numbers that name something"}})
                .of<&Self::_kind>(),
            Property::flag("smooth", "whether texels are interpolated; classes never are")
                .of<&Self::_smooth>(),
            Property::flag("sRgb", "whether colors are coded as sRGB").of<&Self::_sRgb>(),
            Property::flag("hasNoData", "whether there is a value that means no data")
                .of<&Self::_hasNoData>(),
            Property::number("noData", "the value that means no data", -3.5e38, 3.5e38).of<&Self::_noData>(),
            Property::number("importance",
                             "which layers stay where there is no room for all; the highest stay longest",
                             0.0, 1.0)
                .of<&Self::_importance>(),
        });
    return all;
}

} // namespace osgGeoFX
