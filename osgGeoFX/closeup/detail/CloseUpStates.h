// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpItems.h>
#include <osgGeoFX/closeup/detail/CloseUpTask.h>

#include <map>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The state sets that one traversal draws its layers with, and the uniform blocks that they bind. They stay from
    frame to frame. Their uniforms and defines change. */
class CloseUpStates
{
public:
    /// Drops all state whose prefix, units or binding point differ from these.
    void use(const std::string& prefix, const CloseUpTask& task);
    /// Sets all state for this cull.
    void setUp(const ScenePass& pass, const CloseUpTask& task, const std::vector<CloseUpItem>& items,
               bool tessellated);

    /// The state of everything.
    osg::StateSet& base() const { return *_base; }
    /// The state for several items that a single pass draws at once. They must be in one block.
    osg::StateSet* group(const std::vector<std::size_t>& items);
    /// The state of an item's layer (0) or of its anchor's (1).
    osg::StateSet& layer(std::size_t item, std::size_t which) const { return *_layers[2 * item + which]; }
    /// The state of an item's wall (0) or line (1).
    osg::StateSet& fence(std::size_t item, std::size_t which) const { return *_fences[2 * item + which]; }

    CloseUpItems values;

private:
    void setTextures(const CloseUpTask& task);
    void setTessellation(const ScenePass& pass, const CloseUpTask& task,
                         const std::vector<CloseUpItem>& items);
    void setDefines(const ScenePass& pass, const CloseUpTask& task, const std::vector<CloseUpItem>& items);
    void setSurface(const ScenePass& pass, const SurfaceData* data);
    void setLayers(const std::vector<CloseUpItem>& items);
    void define(osg::StateSet& state, const char* name, bool needed) const;

    std::string _prefix;
    std::vector<int> _units;
    unsigned int _binding = 0;
    osg::ref_ptr<osg::StateSet> _base = new osg::StateSet;
    std::map<std::vector<std::size_t>, osg::ref_ptr<osg::StateSet>> _groups;
    std::vector<osg::ref_ptr<osg::StateSet>> _layers; ///< item 0, its anchor, item 1…
    std::vector<osg::ref_ptr<osg::StateSet>> _fences; ///< wall and line of each item
};

} // namespace osgGeoFX
