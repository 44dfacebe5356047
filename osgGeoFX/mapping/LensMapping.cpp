// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/LensMapping.h>

#include <osgGeoFX/mapping/MarkImages.h>
#include <osgGeoFX/mapping/detail/LensCut.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr int markSide = 512;

bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

/// How far a place is inside of the outline: 1 in the middle, 0 on it.
double inwards(double x, double y, bool round)
{
    return 1.0 - (round ? std::hypot(x, y) : std::max(std::abs(x), std::abs(y)));
}

} // namespace

LensMapping::LensMapping(ProjectiveMappings& mappings, int order)
    : _host(&mappings), _inside(new ProjectiveMapping), _rim(new ProjectiveMapping), _mask(new DataLayer),
      _rimLayer(new DataLayer), _cut(new DataLayer), _transfer(new ColorTransfer)
{
    _inside->setTransfer(_transfer);
    _inside->setMask(_mask);
    _rim->setLayer(_rimLayer);
    setOrder(order);
    draw();
    place(_center, _halfWidth, _halfHeight);
    _host->addMapping(_rim);
}

LensMapping::~LensMapping()
{
    _host->removeMapping(_inside);
    _host->removeMapping(_rim);
}

void LensMapping::setContent(ProjectiveMapping* content)
{
    if (_content) _host->removeMapping(_inside);
    _content = content;
    if (!_content) return;
    refresh();
    // The rim stays above it, as it is added last.
    _host->removeMapping(_rim);
    _host->addMapping(_inside);
    _host->addMapping(_rim);
}

void LensMapping::refresh()
{
    if (!_content) return;
    const ColorTransfer& wanted = *_content->getTransfer();
    std::map<std::string, double> all;
    for (const Property& property : wanted.properties())
        all[property.name] = property.get(wanted);
    std::string error;
    _transfer->setProperties(all, error);
    const DataLayer* layer = _content->getLayer();
    _pixels.reset();
    if (layer && layer->getImage())
    {
        LayerPixels::Options options;
        options.kind = static_cast<LayerPixels::Kind>(layer->getKind());
        options.sRGB = layer->getSRgb();
        if (layer->getHasNoData()) options.noData = layer->getNoData();
        options.maxSide = 8192;
        _pixels = LayerPixels::make(*layer->getImage(), options, error);
        if (!_pixels) OSG_WARN << "osgGeoFX: LensMapping cannot show its layer: " << error << std::endl;
        _cut->setKind(layer->getKind());
        _cut->setSmooth(layer->getSmooth());
        _cut->setSRgb(layer->getSRgb());
    }
    // Colors have the lens' outline in their own alpha, beside what alpha they have.
    const bool colors = layer && layer->getKind() == DataLayer::COLOR;
    const bool ownAlpha = colors && wanted.getSource() != ColorTransfer::SCENE;
    _transfer->setAlpha(ownAlpha ? ColorTransfer::FROM_SOURCE : ColorTransfer::FROM_MASK);
    if (!ownAlpha) _transfer->setRamp(0.0, 1.0);
    _inside->setLayer(_pixels ? _cut.get() : nullptr);
    _inside->setTable(_content->getTable());
    _inside->setOpacity(_style.opacity * _content->getOpacity());
    cutOut();
}

void LensMapping::cutOut()
{
    if (_content && _pixels)
        _cut->setImage(cutOutLens(*_inside, *_content, *_pixels, _style.side, *_mask->getImage()));
}

bool LensMapping::setCenter(const osg::Vec2d& place)
{
    return this->place(place, _halfWidth, _halfHeight, _heading);
}

bool LensMapping::setSize(double halfWidth, double halfHeight, double heading)
{
    return place(_center, halfWidth, halfHeight, heading);
}

bool LensMapping::place(const osg::Vec2d& center, double halfWidth, double halfHeight, double heading)
{
    if (!within(center.x(), -5e7, 5e7) || !within(center.y(), -5e7, 5e7) || !within(halfWidth, 1e-3, 1e7) ||
        !within(halfHeight, 1e-3, 1e7) || !std::isfinite(heading))
    {
        OSG_WARN << "osgGeoFX: LensMapping got a place or size out of range; it stays." << std::endl;
        return false;
    }
    _center = center;
    _halfWidth = halfWidth;
    _halfHeight = halfHeight;
    _heading = heading;
    // The marks end within their pictures, the rim's shade outside of the lens.
    const double outer = (1.0 + _style.shade) / markReach;
    _inside->setRectangle(center, halfWidth / markReach, halfHeight / markReach, heading);
    _rim->setRectangle(center, halfWidth * outer, halfHeight * outer, heading);
    cutOut();
    return true;
}

bool LensMapping::setStyle(const Style& style)
{
    bool good = within(style.softness, 0.0, 1.0) && within(style.rim, 0.0, 0.5) &&
                within(style.shade, 0.0, 0.5) && within(style.opacity, 0.0, 1.0) && style.side >= 16 &&
                style.side <= 2048;
    for (int i = 0; i < 4; ++i)
        good = good && within(static_cast<double>(style.rimColor[i]), 0.0, 1.0);
    if (!good)
    {
        OSG_WARN << "osgGeoFX: LensMapping got a style out of range; the former one stays." << std::endl;
        return false;
    }
    _style = style;
    draw();
    place(_center, _halfWidth, _halfHeight, _heading);
    refresh();
    return true;
}

void LensMapping::draw()
{
    const bool round = _style.round;
    _mask->setImage(makeMark(markSide,
                             [&](double x, double y, double texel)
                             {
                                 const double inside = inwards(x, y, round);
                                 const double cover = _style.softness > 0.0
                                                          ? std::clamp(inside / _style.softness, 0.0, 1.0)
                                                          : markCover(inside, texel);
                                 // Without a corner where it begins.
                                 const double smooth =
                                     _style.softness > 0.0 ? cover * cover * (3.0 - 2.0 * cover) : cover;
                                 return osg::Vec4(1, 1, 1, static_cast<float>(smooth));
                             }));
    const double outer = 1.0 + _style.shade;
    _rimLayer->setImage(
        makeMark(markSide,
                 [&](double x, double y, double texel)
                 {
                     const double inside = inwards(x * outer, y * outer, round); // in radii
                     const double line = std::min(markCover(inside, texel * outer),
                                                  markCover(_style.rim - inside, texel * outer));
                     if (inside > 0.0 || _style.shade <= 0.0)
                         return osg::Vec4(_style.rimColor.x(), _style.rimColor.y(), _style.rimColor.z(),
                                          _style.rimColor.w() * static_cast<float>(line));
                     const double share = std::clamp(1.0 + inside / _style.shade, 0.0, 1.0);
                     const auto dark = static_cast<float>(0.45 * share * share);
                     const auto bright = _style.rimColor.w() * static_cast<float>(line);
                     const float alpha = bright + dark * (1.0f - bright);
                     osg::Vec4 color = _style.rimColor * (alpha > 0.0f ? bright / alpha : 0.0f);
                     color.w() = alpha;
                     return color;
                 }));
}

bool LensMapping::setOrder(int order)
{
    return _inside->setOrder(order) && _rim->setOrder(order);
}

bool LensMapping::setEnabled(bool enabled)
{
    return _inside->setEnabled(enabled) && _rim->setEnabled(enabled);
}

} // namespace osgGeoFX
