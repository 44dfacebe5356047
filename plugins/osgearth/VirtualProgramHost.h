// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/ShaderHost.h>

namespace osgGeoFX
{

/** Gives the texts of a scene's effects to osgEarth, as one VirtualProgram for the scene and one for each pass.

    It has a function for vertices in view space, behind all of osgEarth's own (terrain heights, clamping), and before its
    logarithmic depth. It has one for fragments before they are lit, which turns their normals as the effects do, and one behind
    all light, which gives the color to the effects.

    Thread-safe. */
class VirtualProgramHost : public ShaderHost
{
public:
    osg::ref_ptr<osg::StateSet> addition(const ShaderTexts& texts) override;
    bool leavesTilesCoarse() const override { return true; }
    bool draws(const osg::StateAttribute& program) const override;

protected:
    ~VirtualProgramHost() override = default;
};

} // namespace osgGeoFX
