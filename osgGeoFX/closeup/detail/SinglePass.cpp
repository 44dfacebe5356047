// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/SinglePass.h>

namespace osgGeoFX
{

namespace
{

/// The items that the geometry stage takes at once. More would need more vertices than some GPUs can emit.
constexpr std::size_t groupSize = 3;

} // namespace

void SinglePass::collectGroups(const std::vector<std::size_t>& touched,
                               std::vector<osg::StateSet*>& states) const
{
    CloseUpStates& all = _regions.traversal.states;
    std::vector<std::size_t> group;
    for (const std::size_t item : touched)
    {
        const bool full =
            group.size() == groupSize ||
            (!group.empty() && CloseUpItems::blockOf(group.front()) != CloseUpItems::blockOf(item));
        if (full)
        {
            states.push_back(all.group(group));
            group.clear();
        }
        group.push_back(item);
    }
    if (!group.empty()) states.push_back(all.group(group));
}

RegionSurvey SinglePass::survey()
{
    _stage = _regions.newStage();
    _regions.choosePrograms(true);
    RegionSurvey found =
        _regions.survey([this](const std::vector<std::size_t>& touched, std::vector<osg::StateSet*>& states)
                        { collectGroups(touched, states); },
                        _stage);
    _drawn = found.count;
    return found;
}

void SinglePass::handOver(osg::Viewport* picture)
{
    _regions.traversal.layers.draw(_regions.pass.outer, *_stage, -1, picture);
    _regions.drawables += static_cast<int>(_drawn);
}

void SinglePass::finish(VisibleCloseUp& visible, const RegionContents& found)
{
    // The layered stage has cleared all layers already. The anchor's own geometry is drawn on top of its picture.
    visible.stages[1] = _regions.newStage();
    visible.stages[1]->setClearMask(0);
    _regions.drawFence(visible, found);
}

} // namespace osgGeoFX
