// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/MultiPass.h>

#include <osgGeoFX/closeup/detail/LiftSnapshot.h>

namespace osgGeoFX
{

RegionSurvey MultiPass::survey()
{
    _regions.choosePrograms(false);
    // Without state sets nothing is drawn. The stage is for its camera alone.
    return _regions.survey([](const std::vector<std::size_t>&, std::vector<osg::StateSet*>&) {},
                           _regions.surveyStage());
}

void MultiPass::draw(VisibleCloseUp& visible, RegionContents& found)
{
    const CloseUpItem& item = _regions.items[visible.item];
    if (item.showsCloseUp())
    {
        visible.stages[0] = _regions.newStage();
        osg::ref_ptr<DeformationChain> lift = new DeformationChain;
        lift->add(new LiftSnapshot(item));
        _regions.draw(visible, 0, *lift, found);
    }
    visible.stages[1] = _regions.newStage();
    if (item.stretched()) _regions.draw(visible, 1, _regions.pass.chain, found);
    _regions.drawFence(visible, found);
}

} // namespace osgGeoFX
