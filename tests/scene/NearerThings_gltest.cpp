// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Things that a host draws nearer to the eye than they are, so that the ground at their place does not hide them: SimGear does so
// with lamps. The picture is the same, but their places are others; they are deformed where they are.
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/BentGround.h>
#include <tools/ImageComparison.h>

#include <osg/Depth>
#include <osg/Transform>
#include <osgUtil/CullVisitor>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// Takes what is below it to a share of its distance from the eye.
class Nearer : public osg::Transform
{
public:
    explicit Nearer(double share) : _share(share) {}
    bool computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override
    {
        if (!visitor || visitor->getVisitorType() != osg::NodeVisitor::CULL_VISITOR) return true;
        const osg::Vec3d eye = visitor->getEyePoint();
        matrix.preMult(osg::Matrixd::translate(-eye) * osg::Matrixd::scale(_share, _share, _share) *
                       osg::Matrixd::translate(eye));
        return true;
    }

private:
    const double _share;
};

class NearerThings : public BentGround
{
protected:
    /// A sheet on the ground.
    static osg::ref_ptr<osg::Geometry> makeSheet(double height)
    {
        const osg::ref_ptr<osg::Geometry> sheet = new osg::Geometry;
        const osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
        const osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
        const auto z = static_cast<float>(height);
        for (const auto& [x, y] : {std::pair(-20.0f, -30.0f), {20.0f, -30.0f}, {-20.0f, 0.0f}, {20.0f, 0.0f}})
            places->push_back({x, y, z});
        color->front().set(1.0f, 0.1f, 0.1f, 1.0f);
        sheet->setVertexArray(places);
        sheet->setColorArray(color);
        sheet->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 4));
        sheet->setUseDisplayList(false);
        sheet->getOrCreateStateSet()->setRenderBinDetails(1, "RenderBin");
        return sheet;
    }
    /// A sheet below two transforms, or drawn without regard to depths.
    osg::ref_ptr<osg::Image> picture(double factor, const osg::ref_ptr<osg::Group>& around, double height)
    {
        const osg::ref_ptr<osg::Geometry> sheet = makeSheet(height);
        if (!dynamic_cast<Nearer*>(around.get()))
            sheet->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
        osg::Group* inner = around;
        while (inner->getNumChildren() > 0)
            inner = inner->getChild(0)->asGroup();
        inner->addChild(sheet);
        // Ground at the sheet's own height hides it, but for what is drawn nearer.
        const osg::ref_ptr<osg::MatrixTransform> ground =
            new osg::MatrixTransform(osg::Matrixd::translate(0.0, 0.0, height + 1.5));
        ground->addChild(makeGround());
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
        high->setFactor(factor);
        scene->addEffect(high);
        scene->addChild(ground);
        scene->addChild(around);
        return render(scene);
    }
    static osg::ref_ptr<osg::Group> nearer(double first, double second)
    {
        const osg::ref_ptr<osg::Group> outer = new Nearer(first);
        outer->addChild(new Nearer(second));
        return outer;
    }
};

} // namespace

TEST_F(NearerThings, AreDeformedWhereTheyAre)
{
    for (const double factor : {1.0, 2.0})
    {
        SCOPED_TRACE(factor);
        const osg::ref_ptr<osg::Image> expected = picture(factor, new osg::Group, 6.0);
        EXPECT_TRUE(imagesMatch(*picture(factor, nearer(0.9, 0.8), 6.0), *expected, {0.02f, 0.01, 1.0f}));
        EXPECT_GT(differing(*expected, *picture(factor, new osg::Group, 12.0)), 100)
            << "the test sees heights";
    }
}

TEST_F(NearerThings, StayInFrontOfWhatHidesThem)
{
    // Without a share of the distance, the ground is in front.
    const osg::ref_ptr<osg::Image> hidden = picture(2.0, nearer(1.0, 1.0), 6.0);
    EXPECT_GT(differing(*hidden, *picture(2.0, nearer(0.9, 0.8), 6.0)), 500);
}

TEST_F(NearerThings, OtherScalesAreShapes)
{
    // About a place of its own and not about the eye: the thing is smaller.
    const auto scaled = [&](double share)
    {
        const osg::ref_ptr<osg::MatrixTransform> around =
            new osg::MatrixTransform(osg::Matrixd::scale(share, share, 1.0));
        return picture(2.0, around, 6.0);
    };
    EXPECT_GT(differing(*scaled(0.5), *scaled(1.0)), 300);
}
