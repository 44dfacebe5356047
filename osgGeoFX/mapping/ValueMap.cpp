// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/ValueMap.h>

#include <osgGeoFX/mapping/detail/ValueLines.h>
#include <osgGeoFX/raster/LayerPixels.h>

#include <osg/Notify>

#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr double mostLines = 1000.0; ///< more are no lines any more

osg::Vec2d sizeOf(const ProjectiveMapping& mapping)
{
    return {2.0 * mapping.getU().length(), 2.0 * mapping.getV().length()};
}

} // namespace

ValueMap::ValueMap(ProjectiveMappings& mappings, DataLayer* values, ColorTable* colors, int order)
    : _host(&mappings), _mapping(new ProjectiveMapping), _colors(colors ? colors : new ColorTable),
      _low(_colors->range().first), _high(_colors->range().second)
{
    if (!(_high > _low)) _high = _low + 1.0;
    _mapping->setLayer(values);
    _mapping->setOrder(order);
    _mapping->getTransfer()->setSource(ColorTransfer::TABLE);
    refresh();
    _host->addMapping(_mapping);
    _mapping->addListener(*this);
}

ValueMap::~ValueMap()
{
    _mapping->removeListener(*this);
    if (_lines) _host->removeMapping(_lines);
    _host->removeMapping(_mapping);
}

bool ValueMap::setColors(ColorTable* colors)
{
    if (!colors)
    {
        OSG_WARN << "osgGeoFX: A ValueMap needs a color table; the former one stays." << std::endl;
        return false;
    }
    _colors = colors;
    refresh();
    return true;
}

bool ValueMap::setRange(double low, double high)
{
    if (!(low < high) || !_mapping->getTransfer()->setValueRange(low, high))
    {
        OSG_WARN << "osgGeoFX: ValueMap got a range from " << low << " to " << high
                 << "; the former one stays." << std::endl;
        return false;
    }
    _low = low;
    _high = high;
    refresh();
    return true;
}

bool ValueMap::setLines(double step, double width, const osg::Vec4& color)
{
    const bool colorGood = color.w() >= 0.0f && color.w() <= 1.0f;
    if (!(step >= 0.0) || !std::isfinite(step) || !(width > 0.0 && width <= 1e6) || !colorGood)
    {
        OSG_WARN << "osgGeoFX: ValueMap got lines with the step " << step << " and the width " << width
                 << "; they stay as they are." << std::endl;
        return false;
    }
    _step = step;
    _lineWidth = width;
    _lineColor = color;
    makeLines();
    return true;
}

void ValueMap::refresh()
{
    _mapping->setTable(_colors);
    _mapping->getTransfer()->setValueRange(_low, _high);
    makeLines();
}

void ValueMap::makeLines()
{
    const DataLayer* values = _mapping->getLayer();
    const bool wanted = _step > 0.0 && (_high - _low) / _step <= mostLines && values && values->getImage() &&
                        values->getKind() == DataLayer::VALUE;
    if (_lines) _host->removeMapping(_lines);
    _lines = nullptr;
    if (!wanted) return;
    LayerPixels::Options options;
    options.kind = LayerPixels::Kind::Value;
    if (values->getHasNoData()) options.noData = values->getNoData();
    options.levels = 1;
    std::string error;
    const auto pixels = LayerPixels::make(*values->getImage(), options, error);
    if (!pixels)
    {
        OSG_WARN << "osgGeoFX: ValueMap cannot draw lines: " << error << std::endl;
        return;
    }
    _lineScale = sizeOf(*_mapping);
    osg::ref_ptr<DataLayer> layer = new DataLayer(distancesToLines(
        *pixels, _lineScale, _step, _low, _high, 4.0 * _lineWidth + _lineScale.length() / 500.0));
    layer->setKind(DataLayer::VALUE);
    _lines = new ProjectiveMapping;
    _lines->setLayer(layer);
    ColorTransfer& transfer = *_lines->getTransfer();
    transfer.setSource(ColorTransfer::CONSTANT);
    transfer.setConstant(_lineColor);
    transfer.setAlpha(ColorTransfer::FROM_RAMP);
    transfer.setRamp(_lineWidth * 0.65, _lineWidth * 0.35);
    placeLines();
    _host->addMapping(_lines);
}

void ValueMap::placeLines()
{
    std::map<std::string, double> all;
    for (const Property& property : _mapping->properties())
        all[property.name] = property.get(*_mapping);
    all["opacity"] *= static_cast<double>(_lineColor.w());
    std::string error;
    _lines->setProperties(all, error);
}

void ValueMap::propertyChanged(PropertyHolder&)
{
    if (!_lines) return;
    if (sizeOf(*_mapping) != _lineScale)
        makeLines();
    else
        placeLines();
}

osg::ref_ptr<osg::Group> ValueMap::legend(const LegendStyle& style) const
{
    return makeLegend(*_colors, _low, _high, style);
}

} // namespace osgGeoFX
