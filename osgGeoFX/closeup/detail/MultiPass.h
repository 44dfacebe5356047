// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpPipeline.h>

namespace osgGeoFX
{

/// Draws each close-up in a traversal of its own, as detailed as its size in the picture asks for, and each anchor in
/// another one.
class MultiPass final : public CloseUpPipeline
{
public:
    using CloseUpPipeline::CloseUpPipeline;

    CloseUps::Pipeline kind() const override { return CloseUps::MULTI_PASS; }
    RegionSurvey survey() override;
    bool takes(const RegionSurvey&) const override { return true; }
    void draw(VisibleCloseUp& visible, RegionContents& found) override;
    void handOver(osg::Viewport*) override {}
    void finish(VisibleCloseUp&, const RegionContents&) override {}
};

} // namespace osgGeoFX
