// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/FrameBufferObject>
#include <osg/Geometry>
#include <osg/Program>
#include <osg/Texture2DArray>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <vector>

namespace osgGeoFX
{

/// A part of a picture, in pixels of its viewport, from the lower left corner.
struct PixelRectangle
{
    int x = 0, y = 0, width = 0, height = 0;

    bool overlaps(const PixelRectangle& other) const
    {
        return x < other.x + other.width && other.x < x + width && y < other.y + other.height &&
               other.y < y + height;
    }
};

/** The layers that one camera draws close-ups into: texture arrays with their depths, the stages that draw into them, and
    the rectangles that put them into the camera's picture. One belongs to one cull visitor, and so to one thread at a
    time. */
class CloseUpLayers
{
public:
    CloseUpLayers();

    /// Room for so many layers of a size, texels, in arrays of `perArray` layers at most. What is drawn is as large as
    /// the picture times `samples`.
    void resize(int layers, int width, int height, int perArray);
    int width() const { return _width; }
    int height() const { return _height; }

    /// Forgets the stages of the last frame; what they were used for has been drawn.
    void startFrame();
    /// A stage that draws into one layer, or, with −1, into those of the first array that a geometry stage says; before the
    /// layers have their size. It begins where `outer` is.
    osgUtil::RenderStage* newStage(osgUtil::CullVisitor& outer);
    /// Where the picture lies in a layer: `corner` is the pixel that is the layer's first, `samples` stand along a pixel's
    /// side. What is drawn needs it in its state, since the camera has its own there.
    static osg::ref_ptr<osg::Viewport> viewport(osgUtil::CullVisitor& outer, int layer,
                                                const osg::Vec2i& corner, int samples);
    /// Hands a stage to the camera, when all is culled.
    void draw(osgUtil::CullVisitor& outer, osgUtil::RenderStage& stage, int layer, osg::Viewport* viewport);

    /// A close-up that is put into the picture later and overlaps the one that is shown.
    struct Other
    {
        int layer = 0; ///< the next one is its anchor's
        PixelRectangle part;
        osg::Vec2i corner;
        double covers = 1.0; ///< the alpha above which it hides what is behind it
    };
    /// Which pixels of a layer are shown: those with one of the others behind them have to wait for it.
    enum class Turn
    {
        Any,
        First,
        Second
    };
    struct Show
    {
        int layer = 0;
        PixelRectangle part; ///< what of the picture is to be covered
        osg::Vec2i corner;   ///< the pixel that is the layer's first
        int samples = 1;
        double opacity = 1.0;
        bool depthTest = true, depthWrite = true;
        double above = 0.0, upTo = 1.0; ///< which of the layer's alphas
        Turn turn = Turn::Any;
        int anchorLayer = -1;      ///< of an edge, which stays over it
        std::vector<Other> others; ///< in the same texture array; those beyond mostOthers are left out
    };
    static constexpr std::size_t mostOthers = 16;
    /// Whether two layers are in one texture array.
    bool together(int layer, int other) const { return layer / _perArray == other / _perArray; }
    /// Puts a layer into the camera's picture.
    void show(osgUtil::CullVisitor& outer, osg::Program* program, const Show& what);
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
    std::vector<osg::ref_ptr<osgUtil::RenderStage>> _stages;
    std::size_t _stagesUsed = 0;
    std::vector<osg::ref_ptr<osg::StateSet>> _shows;
    std::size_t _showsUsed = 0;
};

} // namespace osgGeoFX
