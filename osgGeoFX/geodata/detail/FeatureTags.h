// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <ogr_feature.h>

#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** A value of OpenStreetMap's further tags as GDAL hands them out, in one text: `"key"=>"value","key"=>"value"`, or a JSON object.
    Empty if there is none. */
std::string tagOf(const std::string& tags, const std::string& key);

/** UTF-8 without control characters. Text that is not UTF-8 is taken for Windows-1252, as old shapefiles have it; a line break or a
    tabulator becomes a space. */
std::string cleanText(const std::string& text);

/** What the first of several fields tells of a feature: a column of the layer, or else a tag among OpenStreetMap's further tags
    (`other_tags`, `all_tags`). Columns' names count in any case. */
class FeatureTags
{
public:
    FeatureTags(const OGRFeatureDefn& layer, const std::vector<std::string>& keys);

    /// Whether any feature of the layer may have a value.
    bool any() const { return _tags >= 0 || _hasColumn; }
    /// The first one that is there and is no blank text, cleaned; empty if there is none.
    std::string of(const OGRFeature& feature) const;

private:
    std::vector<std::pair<std::string, int>> _keys; ///< with the number of the column; −1: none
    bool _hasColumn = false;
    int _tags = -1;
};

} // namespace osgGeoFX
