// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/print/detail/LayerDrawing.h>

#include <osgGeoFX/print/detail/LayerFile.h>

#include <algorithm>
#include <string>

namespace osgGeoFX
{

namespace
{

LayerDrawing::Kinds kindsOf(const EffectScene& scene)
{
    LayerDrawing::Kinds kinds;
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        const Effect& effect = *scene.getEffect(i);
        if (!effect.isActive()) continue;
        kinds.effects = true;
        const auto* map = dynamic_cast<const PanoramaMap*>(&effect);
        if (!map || !map->getPaint()) continue;
        kinds.painted = true;
        kinds.water = kinds.water || map->getWater();
        kinds.strokes = kinds.strokes || map->getStrokes();
    }
    return kinds;
}

bool sameBytes(const osg::Image& a, const osg::Image& b)
{
    return std::equal(a.data(), a.data() + a.getTotalSizeInBytes(), b.data());
}

} // namespace

int LayerDrawing::Kinds::count() const
{
    // Sky, flat and all; two for the opacity; land and woods; strokes on black and on white, and none.
    return 3 + (effects ? 2 : 0) + (painted ? 2 : 0) + (strokes ? 3 : 0);
}

LayerDrawing::LayerDrawing(const Scene& scene, const SceneRenderer::Options& options, const TilePlan& plan)
    : _scene(scene), _kinds(kindsOf(*scene.effects)), _mask(scene.effects->getNodeMask()),
      _pictureHeight(plan.height), _tileHeight(plan.tileHeight)
{
    _reader = _scene.readDepths();
    _top->addChild(_scene.node);
    _scene.node = _top;
    SceneRenderer::Options drawing = options;
    drawing.width = plan.tileWidth;
    drawing.height = plan.tileHeight;
    drawing.pictureWidth = plan.columns * plan.rows > 1 ? plan.width : 0;
    drawing.pictureHeight = plan.columns * plan.rows > 1 ? plan.height : 0;
    drawing.format = ImageCapture::Format::Rgb;
    drawing.countTriangles = drawing.leastTriangles = false;
    std::string error;
    _renderer = SceneRenderer::create(_scene, drawing, error);
    if (!_renderer) throw LayerFault(error);
}

LayerDrawing::~LayerDrawing()
{
    _scene.effects->setNodeMask(_mask);
    _renderer.reset();
    _top->removeChildren(0, _top->getNumChildren());
}

void LayerDrawing::look(Part part)
{
    osg::StateSet& state = *_top->getOrCreateStateSet();
    state.removeDefine("GEOFX_PART");
    state.removeMode(GL_LIGHTING);
    _scene.effects->setNodeMask(part == NOTHING && !_partly ? 0 : _mask);
    if (part != ALL) state.setDefine("GEOFX_PART", std::to_string(part));
    if (part == FLAT) state.setMode(GL_LIGHTING, osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
}

osg::ref_ptr<osg::Image> LayerDrawing::picture(Part part, const osg::Matrixd& view)
{
    look(part);
    std::string error;
    FrameStatistics unused;
    const osg::ref_ptr<osg::Image> image = _renderer->render(view, 0.0, unused, error);
    look(ALL);
    if (!image) throw LayerFault(error);
    return image;
}

void LayerDrawing::moveTo(const PictureTile& tile)
{
    _partly = _kinds.effects;
    _renderer->setTile(tile.left, _pictureHeight - tile.top - _tileHeight);
}

LayerDrawing::Colors LayerDrawing::colors(const PictureTile& tile, const osg::Matrixd& view,
                                          const std::function<void()>& drawn)
{
    moveTo(tile);
    const auto drawPart = [&](Part part)
    {
        const osg::ref_ptr<osg::Image> image = picture(part, view);
        drawn();
        return image;
    };
    Colors result;
    result.all = drawPart(ALL);
    result.depths = _reader->pictures();
    if (_kinds.strokes)
    {
        result.strokesBlack = drawPart(BLACK);
        result.strokesWhite = drawPart(WHITE);
    }
    const WithoutStrokes without(*_scene.effects);
    result.whole = _kinds.strokes ? drawPart(ALL) : result.all;
    if (_kinds.effects)
    {
        result.black = drawPart(BLACK);
        result.shares = drawPart(SHARES);
        // A deformation that moves nothing in this view leaves the ground to OpenGL's own shaders, as in a scene without effects.
        _partly = _kinds.painted || !sameBytes(*result.black, *result.shares);
        if (!_partly) result.black = result.shares = nullptr;
    }
    result.sky = drawPart(NOTHING);
    result.flat = drawPart(FLAT);
    result.land = _kinds.painted ? drawPart(LAND) : result.whole;
    result.woods = _kinds.painted ? drawPart(WOODS) : result.land;
    return result;
}

osg::ref_ptr<osg::Image> LayerDrawing::ground(const PictureTile& tile, const osg::Matrixd& view,
                                              std::vector<std::shared_ptr<const DepthPicture>>& depths)
{
    moveTo(tile);
    const WithoutStrokes without(*_scene.effects);
    osg::ref_ptr<osg::Image> classes = picture(CLASSES, view);
    depths = _reader->pictures();
    return classes;
}

} // namespace osgGeoFX
