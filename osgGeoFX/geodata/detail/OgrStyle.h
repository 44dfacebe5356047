// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/detail/FeatureStyle.h>

#include <vector>

namespace osgGeoFX
{

/// What a feature's own style (OGR's feature style specification) draws. Nothing of a feature without one.
struct OgrStyle
{
    std::vector<ShapePaint> shapes; ///< brushes fill areas, pens draw lines and borders
    std::vector<SymbolPaint> symbols;

    /// `table`: the file's named styles; may be null.
    static OgrStyle of(OGRFeature& feature, OGRStyleTable* table);
};

} // namespace osgGeoFX
