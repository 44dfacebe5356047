// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "VirtualProgramHost.h"

#include <osgEarth/VirtualProgram>

#include <cfloat>

namespace osgGeoFX
{

namespace
{

const char* const vertexCall = R"(
void geofx_osgearth_vertex(inout vec4 vertex)
{
    vertex = geofx_vertex(vertex);
}
)";

/// osgEarth's own normal of a fragment, which terrain has from a texture. Each function's source is a shader of its own, and
/// shares what stands outside of functions.
const char* const normalOfHost = R"(
vec3 geofx_hostNormal;
#define GEOFX_HOST_NORMAL geofx_hostNormal
)";

const char* const normalCall = R"(
vec3 vp_Normal;
vec3 geofx_hostNormal;
vec3 geofx_turnedNormal();
void geofx_osgearth_normal(inout vec4 color)
{
    geofx_hostNormal = vp_Normal;
    vp_Normal = geofx_turnedNormal();
}
)";

/// A panorama map paints ground anew, and so over the color that osgEarth has draped already.
const char* const colorCall = R"(
#pragma import_defines(GEOFX_PAINTED, GEOFX_OSGEARTH_DRAPED)
#if defined(GEOFX_PAINTED) && defined(GEOFX_OSGEARTH_DRAPED)
void oe_overlay_fragment(inout vec4 color);
#endif
void geofx_osgearth_color(inout vec4 color)
{
    color = geofx_fragment(color, vec4(0.0));
#if defined(GEOFX_PAINTED) && defined(GEOFX_OSGEARTH_DRAPED)
    oe_overlay_fragment(color);
#endif
}
)";

} // namespace

osg::ref_ptr<osg::StateSet> VirtualProgramHost::addition(const ShaderTexts& texts)
{
    using osgEarth::VirtualProgram;
    osg::ref_ptr<VirtualProgram> program = new VirtualProgram;
    program->setName("osgGeoFX");
    program->setInheritShaders(true);
    // Before osgEarth's lines and points, at FLT_MAX, which widen what they draw about the place that they get here.
    constexpr float beforeLast = 1e30f;
    program->setFunction("geofx_osgearth_vertex",
                         "#define GEOFX_HOST_NORMAL\n#define GEOFX_HOST_COARSE_TILES\n" + texts.vertex +
                             vertexCall,
                         VirtualProgram::LOCATION_VERTEX_VIEW, beforeLast);
    program->setFunction("geofx_osgearth_normal", normalCall, VirtualProgram::LOCATION_FRAGMENT_LIGHTING,
                         -FLT_MAX);
    program->setFunction("geofx_osgearth_color", normalOfHost + texts.fragment + colorCall,
                         VirtualProgram::LOCATION_FRAGMENT_LIGHTING, FLT_MAX);
    for (const auto& [name, binding] : texts.blocks)
        program->getTemplate()->addBindUniformBlock(name, binding);
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttribute(program, osg::StateAttribute::ON | osg::StateAttribute::PROTECTED);
    return state;
}

bool VirtualProgramHost::draws(const osg::StateAttribute& program) const
{
    return dynamic_cast<const osgEarth::VirtualProgram*>(&program) != nullptr;
}

} // namespace osgGeoFX
