// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Close-ups on a whole globe: the ground on the planet's other side lies over no region, whether it is in tiles or part of one
// large mesh.
#include <tools/CloseUpStage.h>

#include <osg/Geometry>
#include <osg/Math>
#include <osg/MatrixTransform>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr CloseUps::Pipeline pipelines[] = {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS};
constexpr double longitude = 30.0, latitude = 40.0; ///< of the region, degrees

const osg::EllipsoidModel& earth()
{
    static const osg::ref_ptr<osg::EllipsoidModel> model = new osg::EllipsoidModel;
    return *model;
}

osg::Vec3d placeOf(double east, double north)
{
    osg::Vec3d place;
    earth().convertLatLongHeightToXYZ(osg::DegreesToRadians(north), osg::DegreesToRadians(east), 0.0,
                                      place.x(), place.y(), place.z());
    return place;
}

/// Ground between two meridians and two parallels, degrees, in a checkerboard of two colors, about its own middle.
osg::ref_ptr<osg::MatrixTransform> makeGround(double west, double south, double east, double north, int cells)
{
    const osg::Vec3d middle = placeOf((west + east) / 2.0, (south + north) / 2.0);
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    for (int j = 0; j < cells; ++j)
    {
        for (int i = 0; i < cells; ++i)
        {
            const auto corner = [&](int x, int y)
            {
                return placeOf(west + (east - west) * (i + x) / cells,
                               south + (north - south) * (j + y) / cells) -
                       middle;
            };
            for (const osg::Vec3d& each :
                 {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 0), corner(1, 1), corner(0, 1)})
            {
                vertices->push_back(each);
                const float shade = (i + j) % 2 ? 0.9f : 0.5f;
                colors->push_back({shade, 0.8f, 1.0f - shade, 1.0f});
            }
        }
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->setVertexArray(vertices);
    geometry->setColorArray(colors);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(vertices->size())));
    osg::ref_ptr<osg::MatrixTransform> placed = new osg::MatrixTransform(osg::Matrixd::translate(middle));
    placed->addChild(geometry);
    return placed;
}

class CloseUpGlobe : public CloseUpStage
{
protected:
    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->setTerrainFrame(EffectScene::GEOCENTRIC);
        osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 2000.0, 1500.0);
        closeUp->getRegion()->setGeodeticCenter(osg::DegreesToRadians(longitude),
                                                osg::DegreesToRadians(latitude));
        _closeUps->addCloseUp(closeUp);
    }

    /// From some kilometres away, near the ground.
    void lookAtRegion()
    {
        osg::Matrixd frame;
        earth().computeLocalToWorldTransformFromLatLongHeight(osg::DegreesToRadians(latitude),
                                                              osg::DegreesToRadians(longitude), 0.0, frame);
        osg::Camera& camera = *viewer().getCamera();
        const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), frame);
        camera.setViewMatrixAsLookAt(osg::Vec3d(500.0, -6000.0, 3000.0) * frame,
                                     osg::Vec3d(0.0, 0.0, 800.0) * frame, up);
        camera.setProjectionMatrixAsPerspective(45.0, static_cast<double>(_width) / _height, 1.0, 1e8);
        camera.setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    }
};

} // namespace

TEST_F(CloseUpGlobe, TilesOfTheOtherSideLieOverNoRegion)
{
    // Fine tiles around the region and around its antipode, so that what lies there is small.
    const osg::ref_ptr<osg::Group> here = new osg::Group, beyond = new osg::Group;
    for (int i = -2; i < 2; ++i)
    {
        for (int j = -2; j < 2; ++j)
        {
            const double west = longitude + 0.5 * i, south = latitude + 0.5 * j;
            here->addChild(makeGround(west, south, west + 0.5, south + 0.5, 32));
            beyond->addChild(makeGround(west + 180.0, -south - 0.5, west + 180.5, -south, 32));
        }
    }
    _scene->addChild(here);
    _scene->addChild(beyond);
    lookAtRegion();
    osg::Camera& camera = *viewer().getCamera();
    const osg::Matrixd projection = camera.getProjectionMatrix();
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        beyond->setNodeMask(0);
        camera.setProjectionMatrix(projection);
        const osg::ref_ptr<osg::Image> alone = draw();
        EXPECT_EQ(_closeUps->statistics().closeUps, 1);
        const int drawables = _closeUps->statistics().drawables;
        const osg::Matrixd planes = camera.getProjectionMatrix();
        beyond->setNodeMask(~0u);
        camera.setProjectionMatrix(projection);
        const osg::ref_ptr<osg::Image> whole = draw();
        EXPECT_EQ(_closeUps->statistics().drawables, drawables);
        for (int i = 0; i < 16; ++i)
            EXPECT_NEAR(camera.getProjectionMatrix().ptr()[i], planes.ptr()[i],
                        1e-6 * std::abs(planes.ptr()[i]))
                << "near and far planes are others";
        EXPECT_EQ(differing(*alone, *whole), 0.0);
        camera.setProjectionMatrix(projection);
        _closeUps->setEnabled(false);
        EXPECT_GT(differing(*whole, *draw()), 0.05) << "the close-up is not seen";
        _closeUps->setEnabled(true);
    }
}

TEST_F(CloseUpGlobe, TheOtherSideOfOneMeshIsNotLiftedWithIt)
{
    // From far out; without the depth test what is lifted would show through the planet.
    const osg::ref_ptr<osg::MatrixTransform> globe =
        makeGround(longitude - 180.0, -90.0, longitude + 180.0, 90.0, 120);
    _scene->addChild(globe);
    osg::Camera& camera = *viewer().getCamera();
    const osg::Vec3d at = placeOf(longitude, latitude);
    const osg::Vec3d aside = osg::Vec3d(0.0, 0.0, 1.0) ^ at;
    camera.setViewMatrixAsLookAt(at * 2.0 + aside * 5.0, osg::Vec3d(), at);
    camera.setProjectionMatrixAsPerspective(40.0, static_cast<double>(_width) / _height, 1e6, 1e8);
    CloseUp& closeUp = *_closeUps->getCloseUp(0);
    closeUp.getRegion()->setSize(1.6e6, 1.6e6);
    closeUp.setOffset({0.0, 0.0, 2e6});
    closeUp.setScale(1.0, 1.0, 1.0);
    closeUp.getAnchor()->setKind(Anchor::NONE);
    closeUp.getAnchor()->setLineWidth(0.0);
    _closeUps->setDepthTest(false);
    for (const int tessellation : {1, 16})
    {
        for (const CloseUps::Pipeline pipeline : pipelines)
        {
            SCOPED_TRACE(::testing::Message()
                         << "tessellation " << tessellation << ", pipeline " << pipeline);
            _closeUps->setTessellation(tessellation);
            _closeUps->setPipeline(pipeline);
            const osg::ref_ptr<osg::Image> with = draw();
            _closeUps->setEnabled(false);
            const osg::ref_ptr<osg::Image> without = draw();
            _closeUps->setEnabled(true);
            // Seen from the side, "up" in the picture is where the region is: nothing changes in the lower half.
            int upper = 0, lower = 0;
            for (int y = 0; y < _height; ++y)
            {
                for (int x = 0; x < _width; ++x)
                {
                    const unsigned char* a =
                        with->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
                    const unsigned char* b =
                        without->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
                    if (a[0] != b[0] || a[1] != b[1] || a[2] != b[2]) ++(2 * y < _height ? lower : upper);
                }
            }
            EXPECT_EQ(_closeUps->statistics().closeUps, 1);
            EXPECT_GT(_closeUps->statistics().drawables, 0);
            EXPECT_GT(upper, 15);
            EXPECT_EQ(lower, 0);
        }
    }
}
