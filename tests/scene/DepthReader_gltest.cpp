// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Whether a place is hidden, by the depths of a frame: drawn ones, with and without samples, and those of other conventions.
#include <osgGeoFX/scene/DepthReader.h>
#include <tools/GlFixture.h>

#include <osg/Geometry>
#include <osg/Group>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// A wall 100 m before the eye, in the left half of the picture.
osg::ref_ptr<osg::Geometry> makeWall()
{
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (const auto& [x, y] :
         {std::pair{-200.0f, -200.0f}, {0.0f, -200.0f}, {0.0f, 200.0f}, {-200.0f, 200.0f}})
        corners->push_back({x, y, -100.0f});
    osg::ref_ptr<osg::Geometry> wall = new osg::Geometry;
    wall->setUseVertexBufferObjects(true);
    wall->setVertexArray(corners);
    wall->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    return wall;
}

void expectTheWall(const DepthPicture& picture)
{
    EXPECT_FALSE(picture.shows({-20.0, 0.0, -120.0})) << "behind it";
    EXPECT_TRUE(picture.shows({-20.0, 0.0, -80.0})) << "before it";
    EXPECT_TRUE(picture.shows({-20.0, 0.0, -100.1})) << "on it";
    EXPECT_TRUE(picture.shows({20.0, 0.0, -120.0})) << "beside it";
    EXPECT_FALSE(picture.shows({-20.0, 0.0, 120.0})) << "behind the eye";
    EXPECT_FALSE(picture.shows({-500.0, 0.0, -100.0})) << "outside of the picture";
}

class DepthReaderTest : public GlFixture
{
protected:
    explicit DepthReaderTest(unsigned int samples = 0) : GlFixture(64, 64, samples) {}

    void expectDepths()
    {
        osg::Camera& camera = *viewer().getCamera();
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setViewMatrix(osg::Matrixd());
        camera.setProjectionMatrixAsPerspective(60.0, 1.0, 1.0, 1000.0);
        for (const bool immediate : {true, false})
        {
            SCOPED_TRACE(immediate ? "at once" : "buffered");
            const osg::ref_ptr<osg::Group> root = new osg::Group;
            root->addChild(makeWall());
            const osg::ref_ptr<DepthReader> reader = new DepthReader;
            reader->setImmediate(immediate);
            root->addChild(reader);
            EXPECT_FALSE(reader->picture(camera));
            render(root);
            EXPECT_EQ(reader->picture(camera) != nullptr, immediate);
            render(root);
            const auto picture = reader->picture(camera);
            ASSERT_TRUE(picture);
            EXPECT_EQ(reader->pictures().size(), 1u);
            EXPECT_EQ(picture->width, 64);
            EXPECT_EQ(picture->projection, camera.getProjectionMatrix());
            expectTheWall(*picture);
            // Frames between those that count are not read.
            reader->setInterval(1000);
            const unsigned int frame = picture->frame;
            for (int i = 0; i < 3; ++i)
                render(root);
            EXPECT_LE(reader->picture(camera)->frame, frame + 1);
        }
    }
};

class DepthReaderOfSamples : public DepthReaderTest
{
protected:
    DepthReaderOfSamples() : DepthReaderTest(4) {}
};

/// A picture of the wall with the depths that `depthOf` gives to a distance; the farthest beside it.
template<class Function>
DepthPicture pictureOf(const osg::Matrixd& projection, float farthest, const Function& depthOf)
{
    DepthPicture picture;
    picture.width = picture.height = 64;
    picture.projection = projection;
    for (int i = 0; i < 64 * 64; ++i)
        picture.depths.push_back(i % 64 < 32 ? static_cast<float>(depthOf(100.0)) : farthest);
    return picture;
}

} // namespace

TEST_F(DepthReaderTest, TellsWhatAWallHides)
{
    expectDepths();
}

// Close-ups are drawn by a bin of the stage itself, and renderers put the scene into a bin of their own.
TEST_F(DepthReaderTest, ReadsAfterBinsThatAreNotNested)
{
    osg::Camera& camera = *viewer().getCamera();
    camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera.setViewMatrix(osg::Matrixd());
    camera.setProjectionMatrixAsPerspective(60.0, 1.0, 1.0, 1000.0);
    for (const unsigned int mode :
         {osg::StateSet::USE_RENDERBIN_DETAILS, osg::StateSet::OVERRIDE_RENDERBIN_DETAILS})
    {
        SCOPED_TRACE(mode);
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin",
                                                         static_cast<osg::StateSet::RenderBinMode>(mode));
        const osg::ref_ptr<osg::Geometry> wall = makeWall();
        wall->getOrCreateStateSet()->setRenderBinDetails(9, "RenderBin",
                                                         osg::StateSet::OVERRIDE_PROTECTED_RENDERBIN_DETAILS);
        wall->getStateSet()->setNestRenderBins(false);
        const osg::ref_ptr<DepthReader> reader = new DepthReader;
        reader->setImmediate(true);
        root->addChild(reader);
        root->addChild(wall);
        render(root);
        const auto picture = reader->picture(camera);
        ASSERT_TRUE(picture);
        expectTheWall(*picture);
    }
}

TEST_F(DepthReaderOfSamples, TellsWhatAWallHides)
{
    expectDepths();
}

TEST(DepthPicture, OfReversedDepthsWithClipControl)
{
    // Depths of 0…1 that fall with the distance: n (f − d) / (d (f − n)), written as columns of clip coordinates.
    constexpr double n = 1.0, f = 1000.0, wide = 1.7320508;
    const osg::Matrixd projection(wide, 0, 0, 0, 0, wide, 0, 0, 0, 0, n / (f - n), -1, 0, 0, n * f / (f - n),
                                  0);
    DepthPicture picture = pictureOf(projection, 0.0f, [&](double d) { return n * (f - d) / (d * (f - n)); });
    picture.zeroToOne = true;
    expectTheWall(picture);
}

TEST(DepthPicture, OfLogarithmicDepths)
{
    const osg::Matrixd projection = osg::Matrixd::perspective(60.0, 1.0, 1.0, 1000.0);
    DepthPicture picture =
        pictureOf(projection, 1.0f, [](double d) { return std::log2(1.0 + d) / std::log2(1001.0); });
    picture.convention.kind = DepthConvention::LOGARITHMIC;
    picture.convention.farDistance = 1000.0;
    expectTheWall(picture);
}

// Of a target that cannot be read nothing is known, and nothing counts as hidden.
TEST(DepthPicture, WithoutDepthsNothingIsHidden)
{
    DepthPicture picture =
        pictureOf(osg::Matrixd::perspective(60.0, 1.0, 1.0, 1000.0), 1.0f, [](double) { return 0.0; });
    EXPECT_FALSE(picture.shows({-20.0, 0.0, -120.0}));
    picture.depths.clear();
    EXPECT_TRUE(picture.shows({-20.0, 0.0, -120.0}));
    EXPECT_FALSE(picture.shows({-500.0, 0.0, -100.0}));
}
