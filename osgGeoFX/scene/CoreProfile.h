// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/GraphicsThread>

namespace osgGeoFX
{

/** Prepares OSG's state of a context that has the core profile, for an application that runs an OSG with fixed functions, such as
    that of Debian, in it:

        traits->glContextVersion = "3.3";
        traits->glContextProfileMask = 1;                                  // core
        viewer.setRealizeOperation(new osgGeoFX::CoreProfileOperation);

    Matrices become uniforms, and arrays generic vertex attributes (osg::State), with a vertex array object for each
    geometry. The latter holds for all contexts of the process that are realized from then on. Mipmaps come from glGenerateMipmap(). Modes that a core profile lacks are left out, and the errors of calls
    that OSG makes all the same, such as glMatrixMode(), are no longer looked for: OpenGL ignores these calls.
    Engines that run in core profiles, osgEarth for one, do much of this themselves.

    Effects draw there with the application's programs (EffectScene::addFunctions(), adapt(), ShaderHost), and so do
    their passes, strokes, skies, fences and layers. What stands in for OpenGL's fixed functions, for geometry without a
    program, needs the compatibility profile: in a core profile it draws nothing, and says so once. There, too,
    PanoramaMap::setSceneLight() has no effect, OpenGL's clip planes cut nothing, CloseUps draw by MULTI_PASS, and the
    normals are those of vertices, not of the kit's textures of normals.

    Threads: called by the graphics thread of each context, once, when it is realized.
    @ingroup scene */
class OSGGEOFX_EXPORT CoreProfileOperation : public osg::GraphicsOperation
{
public:
    CoreProfileOperation();
    void operator()(osg::GraphicsContext* context) override;

protected:
    ~CoreProfileOperation() override;
};

} // namespace osgGeoFX
