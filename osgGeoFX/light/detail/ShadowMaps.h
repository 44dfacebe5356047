// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/light/detail/ShadowCascades.h>
#include <osgGeoFX/light/detail/ShadowCasters.h>

#include <osg/FrameBufferObject>
#include <osg/StateSet>
#include <osg/Texture2D>
#include <osg/Viewport>
#include <osgUtil/RenderStage>

#include <atomic>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The depths that the sun sees, of all cascades of one view, side by side in one texture: two in a row. One traversal of the
    scene finds what stands in all of them; those where nothing has changed since they were drawn stay as they are. For one
    traversal of one camera, until it has been drawn. */
class ShadowMaps
{
public:
    ShadowMaps();
    ~ShadowMaps();
    ShadowMaps(const ShadowMaps&) = delete;
    ShadowMaps& operator=(const ShadowMaps&) = delete;

    static constexpr int columns = 2;
    static int rows(int count) { return (count + columns - 1) / columns; }

    /// Depths that shaders compare with.
    static osg::ref_ptr<osg::Texture2D> makeTexture(int width, int height);
    /// Draws the scene of a pass into the maps. `texels`: along the side of one. Returns how many of them are drawn.
    int draw(const ScenePass& pass, const ShadowCascades& cascades, int texels);
    osg::Texture2D* texture() const { return _texture; }

    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    class Clearing;
    bool holds(const ScenePass& pass) const;
    std::vector<bool> changes(const ScenePass& pass, std::vector<ShadowCasters>& casters);
    void leaveOut(const std::vector<bool>& changed);
    void resize(int count, int texels);
    void makeProgram(const std::string& prefix);
    osg::ref_ptr<osg::StateSet> makeState(int cascade, int texels, bool reversed) const;

    int _count = 0, _texels = 0;
    bool _reversed = false;
    std::string _prefix;
    osg::ref_ptr<osg::Texture2D> _texture;
    osg::ref_ptr<osg::FrameBufferObject> _target;
    osg::ref_ptr<osg::Viewport> _viewport;
    osg::ref_ptr<osg::Program> _program;
    osg::ref_ptr<osgUtil::RenderStage> _stage;
    std::vector<osg::ref_ptr<osg::StateSet>> _states; ///< one for each cascade
    std::vector<osg::ref_ptr<osg::StateSet>> _clears; ///< and one that clears it
    osg::ref_ptr<Clearing> _clearing;
    std::vector<ShadowCasters> _casters; ///< of each map, as it was drawn last; none if it is not known
    mutable std::atomic<unsigned int> _expected{
        0}; ///< how often `_clearing` has been drawn when all is drawn that was told to be
    unsigned int _context = 0;
};

} // namespace osgGeoFX
