// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "HeightWatch.h"

#include <osg/Notify>
#include <osgEarth/TerrainTileModel>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

HeightWatch::HeightWatch(const std::string& file, double minHeight, double maxHeight)
    : _file(file), _minHeight(minHeight), _maxHeight(maxHeight)
{
}

void HeightWatch::onCreateTileModel(osgEarth::TerrainEngineNode*, osgEarth::TerrainTileModel* model)
{
    // Tiles without heights have none but their neutral values.
    const double low = static_cast<double>(model->elevation.minHeight);
    const double high = static_cast<double>(model->elevation.maxHeight);
    if (_said || !(low <= high)) return;
    const double slack = std::max(1.0, 0.01 * (_maxHeight - _minHeight));
    if (low >= _minHeight - slack && high <= _maxHeight + slack) return;
    if (_said.exchange(true)) return;
    OSG_WARN << "osgGeoFX: " << (_file.empty() ? "" : _file + ": ") << "a tile of the map's ground is from "
             << std::floor(low) << " to " << std::ceil(high) << " m high, but <engine> states " << _minHeight
             << " to " << _maxHeight
             << " m, so what is in sight may be missing; write the heights of all ground into minHeight and "
                "maxHeight of <engine>."
             << std::endl;
}

} // namespace osgGeoFX
