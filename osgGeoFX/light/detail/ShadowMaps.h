// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/light/detail/ShadowCascades.h>
#include <osgGeoFX/light/detail/ShadowTexture.h>

#include <osg/StateSet>
#include <osgUtil/RenderStage>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** Draws the depths that the sun sees, of all cascades of one view, into a ShadowTexture. One traversal of the scene finds what
    stands in all of them; those where nothing has changed since they were drawn stay as they are. For one traversal of one camera,
    until it has been drawn. */
class ShadowMaps
{
public:
    /// Draws the scene of a pass into the maps. `texels`: along the side of one. Returns how many of them are drawn.
    int draw(const ScenePass& pass, const ShadowCascades& cascades, int texels, ShadowTexture& texture);

    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    void leaveOut(const std::vector<bool>& changed);
    void makeStates(int count, int texels, int columns, bool reversed);
    void makeProgram(const std::string& prefix);

    int _texels = 0, _columns = 0;
    bool _reversed = false;
    std::string _prefix;
    osg::ref_ptr<osg::Program> _program;
    osg::ref_ptr<osgUtil::RenderStage> _stage;
    std::vector<osg::ref_ptr<osg::StateSet>> _states; ///< one for each cascade
    std::vector<osg::ref_ptr<osg::StateSet>> _clears; ///< and one that clears it
};

} // namespace osgGeoFX
