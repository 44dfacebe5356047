// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "MapStage.h"

#include "BenchError.h"

#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/panorama/PanoramaMap.h>

#include <osg/Math>
#include <osgDB/WriteFile>

#include <optional>
#include <utility>

namespace geofx::bench
{

std::vector<MapView> mapViews()
{
    const auto place = [](double longitude, double latitude, double height, double heading, double pitch)
    {
        return osgGeoFX::ViewPoint{osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude), height,
                                   osg::DegreesToRadians(heading),   osg::DegreesToRadians(pitch),    0.0};
    };
    osg::ref_ptr<osgGeoFX::BirdsEyeView> bird = new osgGeoFX::BirdsEyeView;
    bird->setFocusLine(0.35);
    bird->setHorizonLine(0.85);
    osg::ref_ptr<osgGeoFX::PanoramaMap> map = new osgGeoFX::PanoramaMap;
    map->setViewRadius(24000.0);
    return {{"plain", "a plain view", place(-157.9, 21.2, 12000.0, 0.0, -25.0), nullptr},
            {"bent", "a bird's-eye view", place(-157.9, 21.25, 9000.0, 0.0, -45.0), bird},
            {"map", "a panorama map", place(-157.753, 21.22, 8000.0, 0.0, -40.0), map}};
}

MapStage::MapStage(const MapView& view, const std::filesystem::path& terrain)
{
    std::string error;
    std::optional<osgGeoFX::Scene> loaded = osgGeoFX::Scene::load(terrain.string(), error);
    if (!loaded) throw BenchError(error);
    scene = *loaded;
    if (!scene.reference || !view.place.viewMatrix(*scene.reference, matrix))
        throw BenchError(terrain.string() +
                         ": it has no place for the views; name a database of Oahu with --terrain FILE.");
    if (view.effect) scene.effects->addEffect(view.effect);
}

osgGeoFX::TerrainRelief MapStage::relief(const Settings& settings) const
{
    std::string error;
    std::optional<osgGeoFX::TerrainRelief> read =
        osgGeoFX::TerrainRelief::read(*scene.node, ellipsoid(), settings.smoke ? 64 : 1024, error);
    if (!read) throw BenchError(error);
    return std::move(*read);
}

std::unique_ptr<OffscreenView> MapStage::draw(osg::Node& root, const Settings& settings) const
{
    const OffscreenView::Size size =
        settings.smoke ? OffscreenView::Size{160, 90} : OffscreenView::Size{1600, 900};
    auto drawing = std::make_unique<OffscreenView>(size, fieldOfView, &root);
    drawing->camera().setLODScale((settings.smoke ? 16.0f : 1.0f) * scene.lodScale(size.height, fieldOfView));
    drawing->look(matrix);
    drawing->settle();
    return drawing;
}

void MapStage::save(OffscreenView& drawing, const Settings& settings, const std::string& name)
{
    if (settings.pictures.empty()) return;
    const std::filesystem::path file = settings.pictures / (name + ".png");
    if (!osgDB::writeImageFile(*drawing.capture(), file.string()))
        throw BenchError(file.string() +
                         ": the picture cannot be written; name another folder with --pictures.");
}

} // namespace geofx::bench
