// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "names/SceneLines.h"

#include "names/StyleFile.h"

#include <osgGeoFX/lines/LineFile.h>
#include <osgGeoFX/lines/LinePlacement.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <iterator>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace geofx::names
{

namespace
{

/// Cells of the relief, along the longer side: as long as the steps of lines on the ground.
constexpr int reliefCells = 2048;

} // namespace

SceneLines SceneLines::read(const Options& options, const osgGeoFX::Scene& scene, std::string& notice)
{
    const Styles styles = readStyles(options.style);
    const osg::ref_ptr<const osg::EllipsoidModel> ellipsoid = scene.effects->ground().ellipsoid;
    SceneLines result;
    result.styles = styles.lines;
    std::string error;
    for (const std::string& each : options.lines)
    {
        osgGeoFX::LineFile file;
        std::tie(file.file, file.layer) = fileAndLayer(each);
        file.style = styles.lineField;
        file.globe = ellipsoid.valid();
        if (!file.globe) file.wkt = wktOf(*scene.node);
        if (!file.read(error)) throw std::runtime_error(error);
        std::move(file.lines.begin(), file.lines.end(), std::back_inserter(result.lines));
    }
    const auto relief = osgGeoFX::TerrainRelief::read(*scene.node, ellipsoid.get(), reliefCells, error);
    if (!relief) throw std::runtime_error("--lines: " + error);
    const std::size_t all = result.lines.size();
    const osgGeoFX::LinePlacement placement;
    const osgGeoFX::LinePlacement::Result placed =
        placement.place(result.lines, result.styles, *scene.effects->getTerrain(), ellipsoid.get(), *relief);
    notice.clear();
    if (result.lines.empty() && placed.outside > 0)
        throw std::runtime_error(
            "--lines: all " + std::to_string(placed.outside) +
            " lines lie beside the terrain; check the file's coordinate reference system.");
    if (placed.outside > 0)
        notice = std::to_string(placed.outside) + " of " + std::to_string(all) +
                 " lines lie beside the terrain and are left out.";
    return result;
}

void SceneLines::addTo(osgGeoFX::Scene& scene, double height) const
{
    const osg::ref_ptr<osgGeoFX::MapLines> node = new osgGeoFX::MapLines(lines, styles);
    node->setScale(height / usualHeight);
    scene.effects->addChild(node);
}

} // namespace geofx::names
