// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgEarth/TerrainEngineNode>

#include <atomic>
#include <string>

namespace osgGeoFX
{

/** Warns once where the ground of osgEarth's tiles lies outside of the heights that the scene states. What is higher or lower may be
    culled though it is in sight.

    It looks at tiles as they come. Threads: those of osgEarth that make tiles. */
class HeightWatch : public osgEarth::TerrainEngine::CreateTileModelCallback
{
public:
    /// `file`: of the map; empty where it has none. Heights in metres.
    HeightWatch(const std::string& file, double minHeight, double maxHeight);
    void onCreateTileModel(osgEarth::TerrainEngineNode* engine, osgEarth::TerrainTileModel* model) override;

private:
    const std::string _file;
    const double _minHeight, _maxHeight;
    std::atomic<bool> _said{false};
};

} // namespace osgGeoFX
