// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/PageKind.h>

#include <osg/Math>

namespace osgGeoFX
{

namespace
{

/// Whether it shows what another pass draws, in each frame anew.
bool isLive(const DataLayer* layer)
{
    return layer && layer->getTexture();
}

/// Whether it is the same from wherever it is seen, at any height and slope.
bool dependsOnPlaceAlone(const ProjectiveMapping& mapping)
{
    const bool fades = mapping.getNearest() > 0.0 || mapping.getFarthest() < 5e7 ||
                       mapping.getPixelsFull() > 0.0 || mapping.getSlopeNone() < osg::PI_2;
    const bool symbol = mapping.getSizeInPixels() > 0.0 || mapping.getTurned();
    const bool bounded = mapping.getLowest() > -1e6 || mapping.getHighest() < 1e6;
    return mapping.getProjector() == ProjectiveMapping::PLANE && !fades && !symbol && !bounded;
}

} // namespace

PageKind pageKindOf(const ProjectiveMapping& mapping)
{
    const ColorTransfer& transfer = *mapping.getTransfer();
    const bool mixes = transfer.getSourceFactor() == ColorTransfer::SOURCE_ALPHA &&
                       transfer.getDestinationFactor() == ColorTransfer::ONE_MINUS_SOURCE_ALPHA &&
                       transfer.getEquation() == ColorTransfer::ADD;
    // Lines are as wide as the view has them.
    if (transfer.getPattern() != ColorTransfer::NONE) return PageKind::Exact;
    if (isLive(mapping.getLayer()) || isLive(mapping.getMask())) return PageKind::Exact;
    if (!mixes || !dependsOnPlaceAlone(mapping)) return PageKind::Exact;
    if (transfer.getSource() != ColorTransfer::SCENE) return PageKind::Page;
    const bool alike = !mapping.getLayer() && (transfer.getAlpha() == ColorTransfer::OPAQUE ||
                                               transfer.getAlpha() == ColorTransfer::FROM_SOURCE);
    return alike ? PageKind::Base : PageKind::Exact;
}

} // namespace osgGeoFX
