// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/CoreProfile.h>

#include <osg/DisplaySettings>
#include <osg/GLExtensions>
#include <osg/GraphicsContext>
#include <osg/State>

namespace osgGeoFX
{

CoreProfileOperation::CoreProfileOperation()
    : osg::Referenced(true), osg::GraphicsOperation("osgGeoFX core profile", false)
{
    // OSG's states read it as their contexts are realized.
    osg::DisplaySettings::instance()->setVertexBufferHint(osg::DisplaySettings::VERTEX_ARRAY_OBJECT);
}

CoreProfileOperation::~CoreProfileOperation() = default;

void CoreProfileOperation::operator()(osg::GraphicsContext* context)
{
    osg::State& state = *context->getState();
    state.setUseModelViewAndProjectionUniforms(true);
    state.setUseVertexAttributeAliasing(true);
    state.setCheckForGLErrors(osg::State::NEVER_CHECK_GL_ERRORS);
    state.get<osg::GLExtensions>()->preferGenerateMipmapSGISForPowerOfTwo = false;
    for (const GLenum mode : {GL_ALPHA_TEST, GL_COLOR_MATERIAL, GL_FOG, GL_LIGHTING, GL_NORMALIZE,
                              GL_RESCALE_NORMAL, GL_POINT_SPRITE_ARB})
        state.setModeValidity(mode, false);
    for (GLenum light = GL_LIGHT0; light <= GL_LIGHT7; ++light)
        state.setModeValidity(light, false);
}

} // namespace osgGeoFX
