// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/GroundOverlay.h>

#include <osgGeoFX/mapping/LayerWords.h>

#include <algorithm>
#include <tuple>

namespace osgGeoFX
{

osg::ref_ptr<ProjectiveMapping> GroundOverlay::makeMapping() const
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    const osg::Vec2d quad[4] = {corners[0], corners[1], corners[2], corners[3]};
    if (!mapping->setQuad(quad)) return nullptr;
    mapping->setLayer(layer);
    setLook(*mapping);
    return mapping;
}

void GroundOverlay::setLook(ProjectiveMapping& mapping) const
{
    mapping.setName(name);
    mapping.setOpacity(opacity);
    mapping.setEnabled(visible);
    mapping.setPixels(pixelsNone, pixelsFull);
    if (symbol)
    {
        mapping.setSizeInPixels(symbol->pixels);
        mapping.setTurned(symbol->pixels > 0.0);
        mapping.setHeight(symbol->height.value_or(0.0));
    }
    if (!layer || layer->getKind() == DataLayer::COLOR) return;
    if (mapping.getLayer() && mapping.getLayer() != layer) LayerWords::copy(*layer, *mapping.getLayer());
    const osg::ref_ptr<ColorTransfer> transfer = new ColorTransfer;
    double low = lowest;
    double high = highest;
    if (table)
    {
        mapping.setTable(table);
        transfer->setSource(ColorTransfer::TABLE);
        std::tie(low, high) = table->range();
    }
    constexpr double most = 9e7; // ColorTransfer's
    low = std::clamp(low, -most, most);
    high = std::clamp(high, -most, most);
    if (low < high) transfer->setValueRange(low, high);
    mapping.setTransfer(transfer);
}

} // namespace osgGeoFX
