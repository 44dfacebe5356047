// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Mappings that fade with their size on the screen, whatever projects them.
#include <tools/MappingStage.h>

using namespace geofx::test;
using namespace osgGeoFX;

class MappingFades : public MappingStage
{
};

TEST_F(MappingFades, ByTheSizeThatACamerasRangeCovers)
{
    // Two metres a pixel; the camera looks straight down from 200 m, and reaches 500 m: 500 pixels.
    lookDown({0.0, 0.0}, 2.0);
    const osg::ref_ptr<osg::Image> nothing = draw();
    const osg::Vec3d color(0.9, 0.2, 0.1);
    const osg::ref_ptr<ProjectiveMapping> mapping = makeSolid({0.0, 0.0}, 100.0, color);
    ProjectiveMapping::Camera camera;
    camera.eye = {0.0, 0.0, 200.0};
    camera.pitch = -osg::PI_2;
    camera.range = 500.0;
    camera.fieldOfView = 0.8;
    ASSERT_TRUE(mapping->setCamera(camera));
    mapping->setProjector(ProjectiveMapping::PINHOLE);
    _mappings->addMapping(mapping);
    const osg::Vec2d middle = pixelOf(osg::Vec2d(0.0, 0.0));
    const auto shows = [&]
    {
        return difference(at(*draw(), middle), color) <= tolerance;
    };
    ASSERT_TRUE(shows()) << "without a fade";
    for (const auto& [none, full] : {std::pair(100.0, 200.0), {300.0, 450.0}})
    {
        mapping->setPixels(none, full);
        EXPECT_TRUE(shows()) << "whole from " << full << " pixels on";
    }
    mapping->setPixels(550.0, 700.0);
    EXPECT_LE(difference(at(*draw(), middle), at(*nothing, middle)), tolerance) << "not below 550 pixels";
}
