// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Camera>
#include <osg/Image>
#include <osgGeoFX/scene/CameraEffects.h>

#include <cstring>
#include <functional>

namespace geofx::test
{

/// The picture of a camera, put together of `tiles` × `tiles` pictures, each drawn by the camera in the role LIKE. Width and
/// height of the viewport must be multiples of `tiles`.
inline osg::ref_ptr<osg::Image> drawTiles(osg::Camera& camera, int tiles,
                                          const std::function<osg::ref_ptr<osg::Image>()>& draw)
{
    const osg::Matrixd projection = camera.getProjectionMatrix();
    const osg::ref_ptr<osg::Viewport> viewport = camera.getViewport();
    const int columns = static_cast<int>(viewport->width()) / tiles;
    const int rows = static_cast<int>(viewport->height()) / tiles;
    osgGeoFX::CameraEffects& effects = osgGeoFX::CameraEffects::of(camera);
    effects.setRole(osgGeoFX::CameraRole::like(camera.getViewMatrix(), projection));
    osg::ref_ptr<osg::Image> all = new osg::Image;
    all->allocateImage(columns * tiles, rows * tiles, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    camera.setViewport(new osg::Viewport(0, 0, columns, rows));
    for (int y = 0; y < tiles; ++y)
    {
        for (int x = 0; x < tiles; ++x)
        {
            camera.setProjectionMatrix(projection * osg::Matrixd::scale(tiles, tiles, 1.0) *
                                       osg::Matrixd::translate(tiles - 1 - 2 * x, tiles - 1 - 2 * y, 0.0));
            const osg::ref_ptr<osg::Image> tile = draw();
            for (int row = 0; row < rows; ++row)
                std::memcpy(all->data(static_cast<unsigned int>(x * columns),
                                      static_cast<unsigned int>(y * rows + row)),
                            tile->data(0, static_cast<unsigned int>(row)),
                            4 * static_cast<std::size_t>(columns));
        }
    }
    effects.clearRole();
    camera.setProjectionMatrix(projection);
    camera.setViewport(viewport);
    return all;
}

} // namespace geofx::test
