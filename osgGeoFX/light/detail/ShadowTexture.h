// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/light/detail/ShadowCasters.h>

#include <osg/Drawable>
#include <osg/FrameBufferObject>
#include <osg/Texture2D>
#include <osg/Viewport>

#include <atomic>
#include <cstdint>
#include <deque>
#include <vector>

namespace osgGeoFX
{

/** The depths that the sun sees, of all cascades of one camera, side by side in one texture: in one row, or in two columns where
    the context has no texture that is wide enough. It remembers what stands in each map.

    All frames of the camera that are on their way share it, since they are drawn one after the other, each with its maps. For the
    thread that culls the camera; the clearing is drawn by another one. */
class ShadowTexture
{
public:
    ShadowTexture();
    ~ShadowTexture();
    ShadowTexture(const ShadowTexture&) = delete;
    ShadowTexture& operator=(const ShadowTexture&) = delete;

    /// Depths that shaders compare with.
    static osg::ref_ptr<osg::Texture2D> makeTexture(int width, int height);
    /// How many maps stand in a row. `widest`: texels along the side of the largest texture.
    static int columnsFor(int count, int texels, int widest) { return count * texels <= widest ? count : 2; }

    /// Makes room for maps of so many texels along their sides. What a texture of another size had is lost.
    void resize(int count, int texels, int columns);
    /// Which maps a frame of a pass must draw, with what throws shadows in it. It counts as drawn from now on.
    std::vector<bool> changes(const ScenePass& pass, std::vector<ShadowCasters>& casters);

    osg::Texture2D* texture() const { return _texture; }
    osg::FrameBufferObject* target() const { return _target; }
    osg::Viewport* viewport() const { return _viewport; }
    /// Clears the part of the target that its state's scissors leave. To be drawn once for each map that is drawn.
    osg::Drawable* clearing() const;

    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    class Clearing;
    bool holds(const ScenePass& pass);

    int _count = 0, _texels = 0, _columns = 0;
    osg::ref_ptr<osg::Texture2D> _texture;
    osg::ref_ptr<osg::FrameBufferObject> _target;
    osg::ref_ptr<osg::Viewport> _viewport;
    osg::ref_ptr<Clearing> _clearing;
    std::vector<ShadowCasters> _casters; ///< of each map, as it was drawn last; none if it is not known

    /// A frame that may not have been drawn yet: whose it is, and how many maps there are when it has been.
    struct Frame
    {
        const osgUtil::CullVisitor* visitor;
        unsigned int frame;
        std::uint64_t maps;
    };
    std::deque<Frame> _frames;
    std::uint64_t _certain = 0;  ///< maps that have been drawn, if any that were to be drawn are lost
    std::uint64_t _expected = 0; ///< maps that will have been drawn after all frames
    mutable std::atomic<bool> _lost{true};
    unsigned int _context = 0;
};

} // namespace osgGeoFX
