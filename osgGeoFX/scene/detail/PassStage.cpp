// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/PassStage.h>

#include <osg/ColorMask>

namespace osgGeoFX
{

namespace
{

class PassStage : public osgUtil::RenderStage
{
public:
    PassStage()
    {
        setCamera(_own);
        // It has none of its own.
        setCameraRequiresSetUp(false);
    }
    osg::Object* cloneType() const override { return new PassStage; }
    osg::Object* clone(const osg::CopyOp&) const override { return new PassStage; }
    const char* className() const override { return "PassStage"; }
    const char* libraryName() const override { return "osgGeoFX"; }

private:
    const osg::ref_ptr<osg::Camera> _own = new osg::Camera; ///< the base class only observes it
};

/// What engines ask a camera for.
void follow(osg::Camera& camera, const osg::Camera& outer)
{
    camera.setName(outer.getName());
    camera.setReferenceFrame(outer.getReferenceFrame());
    camera.setViewMatrix(outer.getViewMatrix());
    camera.setProjectionMatrix(outer.getProjectionMatrix());
    camera.setViewport(const_cast<osg::Viewport*>(outer.getViewport()));
    camera.setStateSet(const_cast<osg::StateSet*>(outer.getStateSet()));
    camera.setCullSettings(outer);
    camera.setView(const_cast<osg::View*>(outer.getView()));
}

} // namespace

osg::ref_ptr<osgUtil::RenderStage> createStage()
{
    return new PassStage;
}

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
    if (outer.getCurrentCamera()) follow(*stage.getCamera(), *outer.getCurrentCamera());
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
