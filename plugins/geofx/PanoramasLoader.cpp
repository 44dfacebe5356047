// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "PanoramasLoader.h"

#include <osgGeoFX/panorama/PanoramaPalette.h>

#include <algorithm>
#include <iterator>

namespace osgGeoFX
{

namespace
{

osg::ref_ptr<osg::Image> paletteOf(const ScenePath& file, SceneTerrain& terrain)
{
    const osg::ref_ptr<osg::Image> picture = terrain.pictureOf(file);
    std::string reason;
    osg::ref_ptr<osg::Image> palette = paletteFromImage(*picture, reason);
    if (!palette) fail(file.place, "the palette \"" + file.path + "\" cannot be used: " + reason);
    return palette;
}

osg::ref_ptr<StrokeLines> linesOf(const std::vector<ScenePanorama::Lines>& files, const SceneTerrain& terrain)
{
    std::vector<StrokeLines::Line> all;
    for (const ScenePanorama::Lines& each : files)
    {
        StrokeVectorsRequest request;
        request.file = each.file.path;
        request.layer = each.layer;
        request.kind = each.kind;
        request.frame = terrain.frame();
        const std::string fault =
            SceneTerrain::ask(each.file.place, "strokeVectors", &request, "leave the <lines> out");
        if (!request.done) fail(each.file.place, fault);
        std::move(request.lines.begin(), request.lines.end(), std::back_inserter(all));
    }
    osg::ref_ptr<StrokeLines> lines = new StrokeLines;
    if (!lines->set(terrain.ellipsoid() ? StrokeLines::DEGREES : StrokeLines::METRES, std::move(all)))
        fail(files.front().file.place, "the lines have points that are no places; check them with ogrinfo.");
    return lines;
}

} // namespace

void loadPanoramas(const SceneFile& scene, SceneTerrain& terrain)
{
    for (const ScenePanorama& panorama : scene.panoramas)
    {
        if (panorama.palette) panorama.effect->setPalette(paletteOf(*panorama.palette, terrain));
        if (panorama.skyImage) panorama.effect->setSkyImage(terrain.pictureOf(*panorama.skyImage));
        if (!panorama.lines.empty()) panorama.effect->setLines(linesOf(panorama.lines, terrain));
    }
}

} // namespace osgGeoFX
