// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The oracle of Compensation_gltest.cpp notices compensation that is broken: effects that deform as they should and lie to
// the culling, each in one way, over the same terrain and cameras as their honest twins.
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>

#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/NormalTurner.h>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

enum class Lie
{
    None,
    Growth, ///< distances within a ball do not grow
    Reach,  ///< nothing happens to any ball
    Detail  ///< no ball deserves more detail than without the deformation
};

/// A snapshot that tells the truth but for one lie.
class LyingSnapshot : public DeformationSnapshot
{
public:
    LyingSnapshot(const DeformationSnapshot* honest, Lie lie) : _honest(honest), _lie(lie) {}

    osg::Vec3d deform(const osg::Vec3d& position) const override { return _honest->deform(position); }
    osg::Vec3d roughly(const osg::Vec3d& position) const override { return _honest->roughly(position); }
    double roughness(const Ball& ball) const override { return _honest->roughness(ball); }
    osg::Vec3d undeform(const osg::Vec3d& position) const override { return _honest->undeform(position); }
    osg::Vec3d deformNormal(const osg::Vec3d& position, const osg::Vec3d& normal) const override
    {
        return _honest->deformNormal(position, normal);
    }
    double style(const osg::Vec3d& position) const override { return _honest->style(position); }
    Reach reach(const Ball& ball) const override
    {
        return _lie == Lie::Reach ? Reach::Identity : _honest->reach(ball);
    }
    double lipschitz(const Ball& ball) const override
    {
        return _lie == Lie::Growth ? 1.0 : _honest->lipschitz(ball);
    }
    Sag sag(const Ball& ball, const osg::Vec3d& edge) const override { return _honest->sag(ball, edge); }
    double detail(const Ball& ball) const override
    {
        return _lie == Lie::Detail ? 1.0 : _honest->detail(ball);
    }
    double longestEdge(const Ball& ball, double tolerance) const override
    {
        return _lie == Lie::Detail ? HUGE_VAL : _honest->longestEdge(ball, tolerance);
    }
    Uniforms uniforms() const override { return _honest->uniforms(); }

private:
    const osg::ref_ptr<const DeformationSnapshot> _honest;
    const Lie _lie;
};

/// An effect whose snapshots lie.
class LyingEffect : public Deformation, public NormalTurner
{
public:
    LyingEffect() = default;
    LyingEffect(Deformation* honest, Lie lie) : _honest(honest), _lie(lie) {}
    LyingEffect(const LyingEffect& other, const osg::CopyOp& copy)
        : Deformation(other, copy), _honest(other._honest), _lie(other._lie)
    {
    }
    META_Object(osgGeoFX, LyingEffect);

    const Properties& properties() const override
    {
        static const Properties all = {enabledProperty()};
        return all;
    }
    osg::ref_ptr<const DeformationSnapshot> snapshot(const ViewGeometry& view) const override
    {
        osg::ref_ptr<const DeformationSnapshot> honest = _honest->snapshot(view);
        return honest ? new LyingSnapshot(honest, _lie) : nullptr;
    }
    void changeGround(Ground& ground) const override { _honest->changeGround(ground); }
    std::string vertexFile() const override { return _honest->vertexFile(); }
    std::string fragmentFile() const override { return _honest->fragmentFile(); }
    std::string constants() const override { return _honest->constants(); }
    std::string normalFile() const override
    {
        const auto* turner = dynamic_cast<const NormalTurner*>(_honest.get());
        return turner ? turner->normalFile() : std::string();
    }

protected:
    ~LyingEffect() override = default;

private:
    osg::ref_ptr<Deformation> _honest;
    Lie _lie = Lie::None;
};

class BrokenCompensation : public GlFixture
{
protected:
    static constexpr int WIDTH = 120;
    static constexpr int HEIGHT = 90;

    BrokenCompensation() : GlFixture(WIDTH, HEIGHT) {}

    /// In how many pictures there are mistakes, by their kind.
    struct Noticed
    {
        int pictures = 0;
        int culled = 0;
        int unasked = 0;
    };

    Noticed notice(Deformation& honest, Lie lie)
    {
        Noticed noticed;
        const std::optional<Scene> oahu = loadOahu("oahu_projected");
        if (!oahu) return noticed;
        oahu->effects->addEffect(&honest);
        const osg::ref_ptr<EffectScene> lying = new EffectScene;
        lying->addEffect(new LyingEffect(&honest, lie));
        for (unsigned int i = 0; i < oahu->effects->getNumChildren(); ++i)
            lying->addChild(oahu->effects->getChild(i));
        CullHarness truth(context(), oahu->effects, WIDTH, HEIGHT);
        CullHarness lies(context(), lying, WIDTH, HEIGHT);
        for (std::uint64_t i = 0; i < (fullTest() ? 10 : 6); ++i)
        {
            Random random(i);
            const osg::Matrixd view = randomOahuView(random, *oahu->reference);
            const osg::Matrixd projection = randomProjection(random);
            truth.setCamera(view, projection);
            lies.setCamera(view, projection);
            for (int step = 0; step < 2; ++step)
                CullHarness::load(truth.frame(true, false).requests, random, 0.7);
            const osg::ref_ptr<const DeformationChain> chain = oahu->effects->deformation(view, projection);
            const Oracle::Mistakes mistakes = Oracle(truth.frame(false), *chain).mistakesOf(lies.frame(true));
            noticed.pictures += mistakes.picture ? 1 : 0;
            noticed.culled += mistakes.culled > 0 ? 1 : 0;
            noticed.unasked += mistakes.unasked > 0 ? 1 : 0;
        }
        RecordProperty("pictures", noticed.pictures);
        RecordProperty("culled", noticed.culled);
        RecordProperty("unasked", noticed.unasked);
        return noticed;
    }

    static osg::ref_ptr<BirdsEyeView> birdsEye()
    {
        osg::ref_ptr<BirdsEyeView> view = new BirdsEyeView;
        view->setFocusLine(0.3);
        view->setTransitionDetail(8.0);
        view->setContextDetail(4.0);
        return view;
    }

    static osg::ref_ptr<VerticalExaggeration> exaggeration()
    {
        osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
        high->setFactor(20.0);
        return high;
    }
};

} // namespace

TEST_F(BrokenCompensation, DoesNotAccuseTheHonest)
{
    for (const osg::ref_ptr<Deformation>& effect :
         {osg::ref_ptr<Deformation>(birdsEye()), osg::ref_ptr<Deformation>(exaggeration())})
    {
        const Noticed noticed = notice(*effect, Lie::None);
        EXPECT_EQ(noticed.pictures, 0);
        EXPECT_EQ(noticed.culled, 0);
        EXPECT_EQ(noticed.unasked, 0);
    }
}

TEST_F(BrokenCompensation, IsNoticedWhereBallsAreTooSmall)
{
    const Noticed noticed = notice(*exaggeration(), Lie::Growth);
    EXPECT_GT(noticed.pictures, 0);
    EXPECT_GT(noticed.culled, 0);
}

TEST_F(BrokenCompensation, IsNoticedWhereBoundsStayInTheirPlaces)
{
    const Noticed noticed = notice(*birdsEye(), Lie::Reach);
    EXPECT_GT(noticed.pictures, 0);
    EXPECT_GT(noticed.culled, 0);
    EXPECT_GT(noticed.unasked, 0);
}

TEST_F(BrokenCompensation, IsNoticedWhereDetailIsThatOfTheUndeformed)
{
    const Noticed noticed = notice(*birdsEye(), Lie::Detail);
    EXPECT_GT(noticed.unasked, 0);
}
