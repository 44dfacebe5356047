// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Ways in the air (PathRibbon) over regions that close-ups lift.
#include <osgGeoFX/mapping/PathRibbon.h>
#include <tools/CloseUpStage.h>

#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class CloseUpWays : public CloseUpStage
{
protected:
    /// A way from west to east through the middle, at a height over the plane of the stage.
    static osg::ref_ptr<osg::Node> way(double height, double leastPixels)
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> globe = new osg::CoordinateSystemNode;
        globe->setEllipsoidModel(new osg::EllipsoidModel);
        std::string error;
        const osg::ref_ptr<Georeference> reference = Georeference::create(globe, error);
        EXPECT_TRUE(reference) << error;
        RoutePath path;
        path.altitude = RoutePath::ABSOLUTE;
        path.places = {{-0.006, 0.0, height}, {0.006, 0.0, height}};
        path.color = osg::Vec4(1, 0, 1, 1);
        PathRibbon look;
        look.shape = PathRibbon::TUBE;
        look.width = 30.0;
        look.leastPixels = leastPixels;
        look.step = 10.0;
        const osg::ref_ptr<osg::MatrixTransform> node = look.make(path, *reference, error);
        EXPECT_TRUE(node) << error;
        osg::Matrixd frame;
        globe->getEllipsoidModel()->computeLocalToWorldTransformFromLatLongHeight(0.0, 0.0, 0.0, frame);
        node->setMatrix(node->getMatrix() * osg::Matrixd::inverse(frame));
        return node;
    }
};

} // namespace

TEST_F(CloseUpWays, AreLiftedWithTheirRegion)
{
    const double height = 150.0, rise = 300.0;
    // The size that close-ups have at first.
    const double scale = 1.5;
    const osg::ref_ptr<osg::Node> ribbon = way(height, 2.0);
    _scene->addChild(ribbon);
    _closeUps->addCloseUp(makeCloseUp({0.0, 0.0}, 400.0, rise));
    look({0.0, -1500.0, 900.0}, {0.0, 0.0, 200.0});
    for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        _closeUps->setPipeline(pipeline);
        draw();
        const osg::ref_ptr<osg::Image> image = draw();
        const osg::Camera& camera = *viewer().getCamera();
        const osg::Matrixd toPixels = camera.getViewMatrix() * camera.getProjectionMatrix() *
                                      camera.getViewport()->computeWindowMatrix();
        int lifted = 0, all = 0;
        for (int x = -150; x <= 150; x += 10)
        {
            const osg::Vec3d pixel = osg::Vec3d(scale * x, 0.0, scale * height + rise) * toPixels;
            ++all;
            const unsigned char* const rgb =
                image->data(static_cast<unsigned int>(pixel.x()), static_cast<unsigned int>(pixel.y()));
            lifted += rgb[0] > 200 && rgb[1] < 60 && rgb[2] > 200 ? 1 : 0;
        }
        EXPECT_EQ(lifted, all) << pipeline;
    }
}
