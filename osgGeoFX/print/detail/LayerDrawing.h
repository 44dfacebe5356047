// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/print/PlacePicture.h>
#include <osgGeoFX/print/detail/TilePlan.h>
#include <osgGeoFX/scene/DepthReader.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Group>
#include <osg/Image>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// Draws the parts of a picture that its layers are made of.
class LayerDrawing
{
public:
    /// The numbers of shaders/stages/parts.glsl.
    enum Part
    {
        ALL = 0,
        NOTHING = 1,
        BLACK = 2,
        WHITE = 3,
        SHARES = 4,
        CLASSES = 5,
        FLAT = 6,
        LAND = 7,
        WOODS = 8
    };
    /// What there is in the scene.
    struct Kinds
    {
        bool effects = false; ///< whether any is switched on
        bool painted = false; ///< whether a panorama map paints it
        bool water = false;   ///< whether it paints water
        bool strokes = false; ///< and strokes
        int count() const;    ///< of the pictures of each tile's colors
    };
    /// The pictures of a tile's colors; those that its kinds do not need are null. RGB, rows upwards.
    struct Colors
    {
        osg::ref_ptr<osg::Image> sky, black, shares, flat, land, woods, whole, strokesBlack, strokesWhite,
            all;
        osg::ref_ptr<osg::Image> classes;
        std::vector<std::shared_ptr<const DepthPicture>>
            ground; ///< the depths of pixels' middles, without strokes
        std::vector<std::shared_ptr<const DepthPicture>> depths; ///< of all
    };

    LayerDrawing(const Scene& scene, const SceneRenderer::Options& options, const TilePlan& plan);
    ~LayerDrawing();

    const Kinds& kinds() const { return _kinds; }
    const osg::Camera& camera() const { return _renderer->camera(); } ///< of the whole picture
    /// Draws all parts of a tile. `drawn` is called after each one.
    Colors colors(const PictureTile& tile, const osg::Matrixd& view, const std::function<void()>& drawn);
    /// The classes of a tile's ground and its depths, without strokes.
    osg::ref_ptr<osg::Image> ground(const PictureTile& tile, const osg::Matrixd& view,
                                    std::vector<std::shared_ptr<const DepthPicture>>& depths);

private:
    osg::ref_ptr<osg::Image> picture(Part part, const osg::Matrixd& view);
    void look(Part part);
    void moveTo(const PictureTile& tile);

    Scene _scene;
    Kinds _kinds;
    osg::ref_ptr<osg::Group> _top = new osg::Group;
    osg::ref_ptr<DepthReader> _reader;
    osg::Node::NodeMask _mask;
    const int _pictureHeight, _tileHeight;
    bool _partly = false; ///< whether shaders of the kit draw the ground, and so its parts
    std::unique_ptr<SceneRenderer> _renderer;
};

} // namespace osgGeoFX
