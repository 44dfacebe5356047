// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpPipeline.h>

namespace osgGeoFX
{

/// The survey of the overview draws all close-ups. A geometry stage copies each triangle into the layers of the
/// close-ups that it touches.
class SinglePass final : public CloseUpPipeline
{
public:
    using CloseUpPipeline::CloseUpPipeline;

    CloseUps::Pipeline kind() const override { return CloseUps::SINGLE_PASS; }
    RegionSurvey survey() override;
    bool takes(const RegionSurvey& found) const override { return !found.foreign; }
    void draw(VisibleCloseUp&, RegionContents&) override {}
    void handOver(osg::Viewport* picture) override;
    void finish(VisibleCloseUp& visible, const RegionContents& found) override;

private:
    void collectGroups(const std::vector<std::size_t>& touched, std::vector<osg::StateSet*>& states) const;

    osgUtil::RenderStage* _stage = nullptr; ///< of all layers
    unsigned int _drawn = 0;                ///< drawables in it
};

} // namespace osgGeoFX
