// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/PassStage.h>

#include <osg/ColorMask>

namespace osgGeoFX
{

osg::ref_ptr<osg::Geometry> createSquare(float low)
{
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (const float y : {low, 1.0f})
    {
        for (const float x : {low, 1.0f})
            corners->push_back(osg::Vec3(x, y, 0.0f));
    }
    osg::ref_ptr<osg::Geometry> square = new osg::Geometry;
    square->setVertexArray(corners);
    square->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 4));
    square->setCullingActive(false);
    square->setUseDisplayList(false);
    square->setUseVertexBufferObjects(true);
    return square;
}

void startStage(osgUtil::RenderStage& stage, osgUtil::CullVisitor& outer, const CameraDepth& depth,
                const osg::Vec4& clearColor)
{
    stage.reset();
    osgUtil::RenderStage& camera = *outer.getCurrentRenderBin()->getStage();
    stage.setInheritedPositionalStateContainerMatrix(osg::Matrixd());
    stage.setInheritedPositionalStateContainer(camera.getPositionalStateContainer());
    stage.setInitialViewMatrix(camera.getInitialViewMatrix());
    stage.setDrawBuffer(GL_NONE, false);
    stage.setReadBuffer(GL_NONE, false);
    stage.setColorMask(new osg::ColorMask);
    stage.setClearMask(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    stage.setClearColor(clearColor);
    stage.setClearDepth(depth.farthest());
}

} // namespace osgGeoFX
