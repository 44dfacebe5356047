// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "OffscreenView.h"
#include "Suite.h"

#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/panorama/TerrainRelief.h>
#include <osgGeoFX/viewer/Scene.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <osg/Matrixd>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace geofx::bench
{

/// A view of Oahu that names and lines are put onto.
struct MapView
{
    const char* name;
    const char* what; ///< in words
    osgGeoFX::ViewPoint place;
    osg::ref_ptr<osgGeoFX::Effect> effect; ///< null for none
};

/// A plain, a bent and a painted view.
std::vector<MapView> mapViews();

/// The terrain of such a view, with its effect. Throws BenchError.
struct MapStage
{
    MapStage(const MapView& view, const std::filesystem::path& terrain);

    const osg::EllipsoidModel* ellipsoid() const { return scene.effects->ground().ellipsoid.get(); }
    /// A drawing of the scene in this view, whose tiles are there. A smoke test's is small and coarse.
    std::unique_ptr<OffscreenView> draw(osg::Node& root, const Settings& settings) const;
    /// Writes the picture, if pictures are wanted.
    static void save(OffscreenView& drawing, const Settings& settings, const std::string& name);

    static constexpr double fieldOfView = 0.5235987755982988; ///< 30 degrees, in radians

    /// The terrain's relief. Throws BenchError.
    osgGeoFX::TerrainRelief relief(const Settings& settings) const;

    osgGeoFX::Scene scene;
    osg::Matrixd matrix; ///< from world to eye coordinates
};

} // namespace geofx::bench
