// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "PanoramasLoader.h"

#include <osgGeoFX/panorama/PanoramaPalette.h>

namespace osgGeoFX
{

namespace
{

osg::ref_ptr<osg::Image> paletteOf(const ScenePath& file)
{
    const osg::ref_ptr<osg::Image> picture = pictureOf(file);
    std::string reason;
    osg::ref_ptr<osg::Image> palette = paletteFromImage(*picture, reason);
    if (!palette) fail(file.place, "the palette \"" + file.path + "\" cannot be used: " + reason);
    return palette;
}

} // namespace

void loadPanoramas(const SceneFile& scene)
{
    for (const ScenePanorama& panorama : scene.panoramas)
    {
        if (panorama.palette) panorama.effect->setPalette(paletteOf(*panorama.palette));
        if (panorama.skyImage) panorama.effect->setSkyImage(pictureOf(*panorama.skyImage));
    }
}

} // namespace osgGeoFX
