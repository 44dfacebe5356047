// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DepthConvention.h>

#include <osg/FrameBufferObject>
#include <osg/Geometry>
#include <osg/Program>
#include <osg/Texture2DArray>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <vector>

namespace osgGeoFX
{

/// A part of a picture in pixels, from the lower left corner of its viewport.
struct PixelRectangle
{
    int x = 0, y = 0, width = 0, height = 0;

    bool overlaps(const PixelRectangle& other) const
    {
        return x < other.x + other.width && other.x < x + width && y < other.y + other.height &&
               other.y < y + height;
    }
};

/** The layers that one camera draws close-ups into. They consist of texture arrays with depths, the stages that draw
    into them, and the rectangles that put them into the camera's picture. An object belongs to one cull visitor, and
    so to one thread at a time. */
class CloseUpLayers
{
public:
    CloseUpLayers();

    /// Makes room for layers of a size, texels, in arrays of at most `perArray` layers. They are drawn `samples`
    /// times as wide and high as the picture.
    void resize(int layers, int width, int height, int perArray, const CameraDepth& depth,
                GLenum colorFormat);
    int width() const { return _width; }
    int height() const { return _height; }

    /// Frees the stages of the last frame, which has been drawn.
    void startFrame();
    /// A new stage with the view and the lights of `outer`. draw() says later which layers it draws into, so these
    /// need no size yet.
    osgUtil::RenderStage* newStage(osgUtil::CullVisitor& outer, const CameraDepth& depth);
    /// A stage that is not drawn, for traversals that look at the scene.
    osgUtil::RenderStage* surveyStage(osgUtil::CullVisitor& outer, const CameraDepth& depth);
    /// The viewport that places the picture in a layer; −1: in all layers. `corner` is the pixel at the layer's first
    /// texel, and a pixel's side has `samples` samples. The drawn state needs it, since the camera puts its own
    /// viewport there.
    static osg::ref_ptr<osg::Viewport> viewport(osgUtil::CullVisitor& outer, int layer,
                                                const osg::Vec2i& corner, int samples);
    /// Hands a stage to the camera, after all is culled. `layer` −1: for all layers of the first array.
    void draw(osgUtil::CullVisitor& outer, osgUtil::RenderStage& stage, int layer, osg::Viewport* viewport);

    /// A close-up that is put into the picture later and overlaps the one that is shown.
    struct Other
    {
        int layer = 0; ///< its anchor's is the next one
        PixelRectangle part;
        osg::Vec2i corner;
        double covers = 1.0; ///< the alpha above which it hides what is behind it
    };
    /// Which pixels of a layer are shown. Pixels with one of the others behind them wait for it.
    enum class Turn
    {
        Any,
        First,
        Second
    };
    struct Show
    {
        int layer = 0;
        PixelRectangle part; ///< the part of the picture that may be covered
        osg::Vec2i corner;   ///< the pixel at the layer's first texel
        int samples = 1;
        double opacity = 1.0;
        bool depthTest = true, depthWrite = true;
        double above = 0.0, upTo = 1.0; ///< the layer's alphas that are shown
        Turn turn = Turn::Any;
        int anchorLayer = -1;      ///< the anchor's layer that an edge covers; −1 for none
        std::vector<Other> others; ///< those in the same texture array; at most mostOthers count
    };
    static constexpr std::size_t mostOthers = 16;
    /// Whether two layers are in one texture array.
    bool together(int layer, int other) const { return layer / _perArray == other / _perArray; }
    /// Puts a layer into the camera's picture.
    void show(osgUtil::CullVisitor& outer, osg::Program* program, const CameraDepth& depth, const Show& what);
    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    struct Array
    {
        osg::ref_ptr<osg::Texture2DArray> colors, depths;
        osg::ref_ptr<osg::FrameBufferObject> all;
        std::vector<osg::ref_ptr<osg::FrameBufferObject>> single;
    };
    osg::ref_ptr<osg::Geometry> _square;
    std::vector<Array> _arrays;
    int _layers = 0, _width = 0, _height = 0, _perArray = 0;
    GLenum _depthFormat = 0, _colorFormat = 0;
    std::vector<osg::ref_ptr<osgUtil::RenderStage>> _stages;
    osg::ref_ptr<osgUtil::RenderStage> _surveyStage;
    std::size_t _stagesUsed = 0;
    std::vector<osg::ref_ptr<osg::StateSet>> _shows;
    std::size_t _showsUsed = 0;
};

} // namespace osgGeoFX
