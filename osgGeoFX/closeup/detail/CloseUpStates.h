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

/** The state sets that one traversal draws into its layers with, and the uniform blocks that they bind. They stay from frame to
    frame; uniforms and defines in them change. */
class CloseUpStates
{
public:
    /// Forgets all state where the names in it, or the units and the binding point that it takes, are no longer these.
    void use(const std::string& prefix, const CloseUpTask& task);
    /// Makes all of it that of this cull.
    void setUp(const ScenePass& pass, const CloseUpTask& task, const std::vector<CloseUpItem>& items,
               bool tessellated);

    /// Of everything.
    osg::StateSet& base() const { return *_base; }
    /// Of what a single pass draws for several items at once; all are in one block.
    osg::StateSet* group(const std::vector<std::size_t>& items);
    /// Of an item's layer (0) or that of its anchor (1).
    osg::StateSet& layer(std::size_t item, std::size_t which) const { return *_layers[2 * item + which]; }
    /// Of an item's wall (0) or line (1).
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
