// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Mappings that are composed beforehand, into pages: the picture is that of the mappings themselves.
#include <tools/MappingStage.h>

#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/scene/DeformedView.h>

#include <osg/AlphaFunc>
#include <osg/ColorMask>
#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

constexpr std::uint64_t pageTexels = 256 * 256;

double distanceToLine(const osg::Vec2d& point, const osg::Vec2d& a, const osg::Vec2d& b)
{
    const osg::Vec2d along = b - a;
    const double t = std::clamp((point - a) * along / std::max(along.length2(), 1e-9), 0.0, 1.0);
    return (a + along * t - point).length();
}

} // namespace

class MappingPages : public MappingStage
{
protected:
    MappingPages() : MappingStage(320, 240) {}
    void SetUp() override
    {
        MappingStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _mappings->setCaching(ProjectiveMappings::AUTOMATIC);
        _exactScene->addEffect(_exact);
        _exactScene->addChild(_scene->getChild(0));
        look({0.0, -700.0, 500.0}, {0.0, 0.0, 0.0});
    }

    void add(ProjectiveMapping* mapping)
    {
        _mappings->addMapping(mapping);
        _exact->addMapping(mapping);
    }
    void remove(ProjectiveMapping* mapping)
    {
        _mappings->removeMapping(mapping);
        _exact->removeMapping(mapping);
    }
    /// Smooth pictures that let what is below show through, one over the other.
    void addSome(double size = 1.0)
    {
        for (int i = 0; i < 9; ++i)
        {
            const osg::ref_ptr<osg::Image> image = makeImage(40 + i, 30,
                                                             [i](double u, double v)
                                                             {
                                                                 osg::Vec4d color =
                                                                     waves(u + 0.3 * i, v - 0.2 * i);
                                                                 color.a() = 0.4 + 0.6 * u;
                                                                 return color;
                                                             });
            const osg::ref_ptr<ProjectiveMapping> mapping = makePicture({0.0, 0.0}, 1.0, image);
            mapping->setOpacity(0.8);
            mapping->setSoftEdges(true);
            mapping->setRectangle(osg::Vec2d(60.0 * i - 250.0, 70.0 * (i % 4) - 120.0) * size, 140.0 * size,
                                  100.0 * size, 0.3 * i);
            add(mapping);
        }
    }
    osg::ref_ptr<osg::Image> drawExactly() { return render(_exactScene); }
    /// The picture when all pages are there.
    osg::ref_ptr<osg::Image> drawSettled(int most = 300)
    {
        osg::ref_ptr<osg::Image> image;
        for (int i = 0; i < most; ++i)
        {
            image = draw();
            const ProjectiveMappings::CacheStatistics pages = _mappings->cacheStatistics();
            if (pages.settled && pages.reason.empty()) return image;
        }
        ADD_FAILURE() << "never settled: " << _mappings->cacheStatistics().reason;
        return image;
    }
    /// Whether a picture by pages is right: within the tolerance but at edges of layers, and these within a pixel.
    ::testing::AssertionResult right(const osg::Image& paged, const osg::Image& exact,
                                     const std::function<osg::Vec2d(const osg::Vec2d&)>& where)
    {
        int off = 0, beside = 0;
        for (int y = 3; y + 3 < _height; ++y)
        {
            for (int x = 3; x + 3 < _width; ++x)
            {
                if (difference(at(paged, x, y), at(exact, x, y)) < 2.5 / 255.0) continue;
                if (!atEdge({x + 0.5, y + 0.5}, where)) ++off;
                if (_solid && !amongNeighbours(at(paged, x, y), exact, x, y)) ++beside;
            }
        }
        if (off == 0 && beside == 0) return ::testing::AssertionSuccess();
        return ::testing::AssertionFailure()
               << off << " pixels are off, and " << beside << " edges are more than a pixel away";
    }
    ::testing::AssertionResult right(const osg::Image& paged, const osg::Image& exact)
    {
        return right(paged, exact, [this](const osg::Vec2d& place) { return pixelOf(place); });
    }
    std::uint64_t exactFrames() { return _mappings->cacheStatistics().exactFrames; }
    std::uint64_t texels() { return _mappings->cacheStatistics().texelsDrawn; }

    bool _solid =
        false; ///< whether the layers have one color each, so that their edges can be told from what is within
    osg::ref_ptr<ProjectiveMappings> _exact = new ProjectiveMappings;
    osg::ref_ptr<EffectScene> _exactScene = new EffectScene;

private:
    bool atEdge(const osg::Vec2d& pixel, const std::function<osg::Vec2d(const osg::Vec2d&)>& where)
    {
        for (unsigned int i = 0; i < _exact->getNumMappings(); ++i)
        {
            const std::optional<PlaneFootprint> outline = _exact->getMapping(i)->outline();
            for (std::size_t k = 0; outline && k < 4; ++k)
            {
                // An edge that is bent is followed in parts.
                const osg::Vec2d a = outline->corners[k], b = outline->corners[(k + 1) % 4];
                for (int part = 0; part < 16; ++part)
                {
                    const osg::Vec2d from = where(a + (b - a) * (part / 16.0));
                    const osg::Vec2d to = where(a + (b - a) * ((part + 1) / 16.0));
                    if (distanceToLine(pixel, from, to) < 3.0) return true;
                }
            }
        }
        return false;
    }
    bool amongNeighbours(const osg::Vec3d& color, const osg::Image& image, int x, int y)
    {
        for (int c = 0; c < 3; ++c)
        {
            double low = 9.0, high = -9.0;
            for (int j = -2; j <= 2; ++j)
            {
                for (int i = -2; i <= 2; ++i)
                {
                    low = std::min(low, at(image, x + i, y + j)[c]);
                    high = std::max(high, at(image, x + i, y + j)[c]);
                }
            }
            if (color[c] < low - tolerance || color[c] > high + tolerance) return false;
        }
        return true;
    }
};

TEST_F(MappingPages, ShowWhatMappingsShow)
{
    addSome();
    const osg::ref_ptr<osg::Image> exact = drawExactly();
    // Before all pages are there, the mappings themselves show.
    EXPECT_TRUE(same(*draw(), *exact));
    EXPECT_GT(exactFrames(), 0u);
    EXPECT_TRUE(right(*drawSettled(), *exact));
    EXPECT_GT(_mappings->cacheStatistics().pagesUsed, 3);
    EXPECT_GT(_mappings->cacheStatistics().pagedFrames, 0u);
    // Pages, not the mappings again.
    const std::uint64_t before = texels();
    EXPECT_TRUE(right(*draw(), *exact));
    EXPECT_EQ(texels(), before);
    lookDown({30.0, -20.0}, 2.0, 0.7);
    EXPECT_TRUE(right(*drawSettled(), *drawExactly()));
}

TEST_F(MappingPages, HaveEdgesWithinAPixelOfTheMappings)
{
    _solid = true;
    for (int i = 0; i < 12; ++i)
    {
        const osg::ref_ptr<ProjectiveMapping> mapping = makeSolid({0.0, 0.0}, 1.0, colorOf(i));
        mapping->setSoftEdges(i % 2 == 0);
        mapping->setRectangle({55.0 * i - 300.0, 80.0 * (i % 5) - 160.0}, 90.0, 60.0, 0.4 * i);
        add(mapping);
    }
    for (const double height : {900.0, 500.0, 250.0})
    {
        look({0.0, -700.0, height}, {0.0, 0.0, 0.0});
        EXPECT_TRUE(right(*drawSettled(), *drawExactly())) << height;
    }
}

TEST_F(MappingPages, ShowValuesMasksAndTheChangedScene)
{
    // Below all others, and larger than the ground.
    const osg::ref_ptr<ProjectiveMapping> context = new ProjectiveMapping;
    context->setRectangle({0.0, 0.0}, 3000.0, 3000.0);
    context->getTransfer()->setSource(ColorTransfer::SCENE);
    context->getTransfer()->setSaturation(0.2);
    context->getTransfer()->setBrightness(2.5);
    context->setOpacity(0.7);
    context->setOrder(-1);
    addSome();
    add(context);
    osg::ref_ptr<osg::Image> heights = new osg::Image;
    heights->allocateImage(24, 24, 1, GL_LUMINANCE, GL_FLOAT);
    for (int i = 0; i < 24 * 24; ++i)
        reinterpret_cast<float*>(heights->data())[i] = static_cast<float>(100.0 * i / (24 * 24));
    ProjectiveMapping& values = *_mappings->getMapping(3);
    values.setLayer(new DataLayer(heights));
    values.getLayer()->setKind(DataLayer::VALUE);
    values.setTable(ColorTable::named("viridis", 0.0, 100.0));
    values.getTransfer()->setSource(ColorTransfer::TABLE);
    values.getTransfer()->setValueRange(0.0, 100.0);
    ProjectiveMapping& masked = *_mappings->getMapping(5);
    masked.setMask(new DataLayer(makeImage(16, 16, waves)));
    masked.getTransfer()->setAlpha(ColorTransfer::FROM_MASK);
    EXPECT_TRUE(right(*drawSettled(), *drawExactly()));
    // Where the context ends within the picture, its edge is no one's color.
    context->setRectangle({0.0, 0.0}, 300.0, 300.0);
    EXPECT_TRUE(same(*draw(), *drawExactly()));
    EXPECT_NE(_mappings->cacheStatistics().reason.find("does not cover"), std::string::npos);
}

TEST_F(MappingPages, LeaveGroundBeyondAllMappingsAsItIs)
{
    const osg::ref_ptr<ProjectiveMapping> context = new ProjectiveMapping;
    context->setRectangle({4000.0, 0.0}, 300.0, 300.0);
    context->getTransfer()->setSource(ColorTransfer::SCENE);
    context->getTransfer()->setSaturation(0.0);
    context->getTransfer()->setBrightness(0.2);
    add(context);
    const osg::ref_ptr<osg::Image> exact = drawExactly();
    for (int i = 0; i < 10; ++i)
        EXPECT_TRUE(same(*draw(), *exact)) << i;
}

TEST_F(MappingPages, KeepOffTheStatesAboveTheScene)
{
    for (EffectScene* scene : {_scene.get(), _exactScene.get()})
    {
        osg::StateSet& state = *scene->getOrCreateStateSet();
        state.setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GREATER, 0.5f));
        state.setAttributeAndModes(new osg::ColorMask(true, true, true, false));
    }
    addSome();
    drawSettled();
    // A place where nothing is left must be blank again.
    const osg::ref_ptr<ProjectiveMapping> one = _mappings->getMapping(4);
    remove(one);
    const osg::ref_ptr<osg::Image> exact = drawExactly();
    EXPECT_TRUE(right(*draw(), *exact));
    EXPECT_TRUE(right(*drawSettled(), *exact));
}

TEST_F(MappingPages, AreTheSameWhicheverWayTheCameraCame)
{
    addSome();
    const osg::ref_ptr<osg::Image> expected = drawSettled();
    for (int i = 0; i < 12; ++i)
    {
        look({100.0 * i - 600.0, -900.0 + 60.0 * i, 80.0 + 90.0 * i}, {50.0 * i, 0.0, 0.0});
        draw();
    }
    look({0.0, -700.0, 500.0}, {0.0, 0.0, 0.0});
    EXPECT_EQ(std::memcmp(drawSettled()->data(), expected->data(), expected->getTotalSizeInBytes()), 0);
}

TEST_F(MappingPages, ChangesAreInTheNextFrame)
{
    addSome();
    drawSettled();
    const std::uint64_t frames = exactFrames();
    ProjectiveMapping& one = *_mappings->getMapping(4);
    const std::function<void()> changes[] = {[&] { one.setCenter(one.getCenter() + osg::Vec2d(15.0, -9.0)); },
                                             [&] { one.setOrder(3); },
                                             [&] { one.setOrder(-3); },
                                             [&] { one.setOpacity(0.3); },
                                             [&] { one.getTransfer()->setHue(1.0); },
                                             [&] { one.getLayer()->setImage(makeImage(16, 16, waves)); },
                                             [&]
                                             {
                                                 osg::Image& image = *one.getLayer()->getImage();
                                                 std::fill_n(image.data(), image.getTotalSizeInBytes(), 200);
                                                 image.dirty();
                                             },
                                             [&] { one.setEnabled(false); },
                                             [&] { one.setEnabled(true); },
                                             [&]
                                             {
                                                 remove(&one);
                                             }};
    int number = 0;
    for (const auto& change : changes)
    {
        const osg::ref_ptr<ProjectiveMapping> kept = &one;
        const osg::ref_ptr<osg::Image> former = drawExactly();
        const std::uint64_t before = texels();
        change();
        const osg::ref_ptr<osg::Image> exact = drawExactly();
        EXPECT_GT(differing(*exact, *former), 50) << number;
        EXPECT_TRUE(right(*draw(), *exact)) << number;
        // No more than what lies below it, on pages of several levels.
        EXPECT_GT(texels(), before) << number;
        EXPECT_LT(texels() - before, 4 * pageTexels) << number;
        ++number;
    }
    EXPECT_EQ(exactFrames(), frames);
}

TEST_F(MappingPages, OfAMappingThatMovesKeepItsOrder)
{
    addSome();
    drawSettled();
    const std::uint64_t frames = exactFrames();
    ProjectiveMapping& below = *_mappings->getMapping(1);
    for (int i = 0; i < 12; ++i)
    {
        below.setCenter(below.getCenter() + osg::Vec2d(21.0, 6.0));
        EXPECT_TRUE(right(*draw(), *drawExactly())) << i;
    }
    EXPECT_EQ(exactFrames(), frames);
}

TEST_F(MappingPages, AreShownThoughSomethingMovesFromTheFirstFrameOn)
{
    addSome(6.0);
    const osg::ref_ptr<ProjectiveMapping> mover =
        makePicture({0.0, 0.0}, 120.0, makeImage(40, 40, [](double u, double v) { return waves(u, v); }));
    add(mover);
    look({0.0, -300.0, 200.0}, {0.0, 0.0, 0.0});
    std::uint64_t paged = 0;
    for (int i = 0; i < 200 && paged < 5; ++i)
    {
        mover->setCenter({1.0 * i - 60.0, 0.5 * i});
        const osg::ref_ptr<osg::Image> image = draw();
        const std::uint64_t now = _mappings->cacheStatistics().pagedFrames;
        if (now > paged)
        {
            EXPECT_TRUE(right(*image, *drawExactly())) << i;
        }
        paged = now;
    }
    EXPECT_EQ(paged, 5u) << _mappings->cacheStatistics().reason;
}

TEST_F(MappingPages, AreDoneWithoutWhereNoTextureUnitsAreLeft)
{
    addSome();
    ASSERT_TRUE(_scene->setFirstTextureUnit(28)) << "four are left, and mappings need three";
    EXPECT_TRUE(same(*draw(), *drawExactly()));
    EXPECT_NE(_mappings->cacheStatistics().reason.find("texture units"), std::string::npos)
        << _mappings->cacheStatistics().reason;
    ASSERT_TRUE(_scene->setFirstTextureUnit(27));
    EXPECT_TRUE(right(*drawSettled(), *drawExactly()));
}

TEST_F(MappingPages, LeaveLargeChangesToTheMappings)
{
    addSome(6.0);
    look({0.0, -300.0, 60.0}, {0.0, 0.0, 0.0});
    drawSettled();
    ProjectiveMapping& large = *_mappings->getMapping(3);
    for (int i = 0; i < 5; ++i)
    {
        const std::uint64_t before = texels();
        large.setCenter(large.getCenter() + osg::Vec2d(9.0, 4.0));
        EXPECT_TRUE(same(*draw(), *drawExactly())) << i;
        EXPECT_FALSE(_mappings->cacheStatistics().reason.empty());
        // What goes on changing is not drawn in vain.
        if (i > 0)
        {
            EXPECT_EQ(texels(), before) << i;
        }
    }
    EXPECT_TRUE(right(*drawSettled(), *drawExactly()));
}

TEST_F(MappingPages, AreLetGoWhereThereIsNoRoom)
{
    addSome();
    _mappings->setCacheSize(1);
    for (int i = 0; i < 4; ++i)
        EXPECT_TRUE(same(*draw(), *drawExactly()));
    EXPECT_NE(_mappings->cacheStatistics().reason.find("memory"), std::string::npos);
    // Room for one picture, not for all that the camera meets on its way.
    _mappings->setCacheSize(20);
    const int pages = 20 * 4 - 1;
    std::uint64_t drawn = 0;
    for (int i = 0; i < 8; ++i)
    {
        look({75.0 * i - 260.0, -150.0, 60.0}, {75.0 * i - 260.0, 0.0, 0.0});
        EXPECT_TRUE(right(*drawSettled(), *drawExactly())) << i;
        EXPECT_LE(_mappings->cacheStatistics().pagesUsed, pages);
        drawn = _mappings->cacheStatistics().pagesDrawn;
    }
    EXPECT_GT(drawn, static_cast<std::uint64_t>(pages));
}

TEST_F(MappingPages, LeaveWhatCannotBeComposedToTheMappings)
{
    addSome();
    drawSettled();
    const osg::ref_ptr<ProjectiveMapping> one = _mappings->getMapping(4);
    const std::pair<std::function<void()>, std::function<void()>> cases[] = {
        {[&] { one->setDistances(0.0, 700.0); },
         [&]
         {
             one->setDistances(0.0, 5e7);
         }},
        {[&] { one->setSizeInPixels(40.0); },
         [&]
         {
             one->setSizeInPixels(0.0);
         }},
        {[&] { one->setSlopes(0.1, 0.2); },
         [&]
         {
             one->setSlopes(osg::PI_2, osg::PI_2);
         }},
        {[&] { one->setHeights(-5.0, 5.0); },
         [&]
         {
             one->setHeights(-1e6, 1e6);
         }},
        {[&] { one->getTransfer()->setEquation(ColorTransfer::OVERLAY); },
         [&]
         {
             one->getTransfer()->setEquation(ColorTransfer::ADD);
         }},
        {[&] { _mappings->setWholeList(true); },
         [&]
         {
             _mappings->setWholeList(false);
         }}};
    int number = 0;
    for (const auto& [begin, end] : cases)
    {
        begin();
        EXPECT_TRUE(same(*draw(), *drawExactly())) << number;
        EXPECT_FALSE(_mappings->cacheStatistics().reason.empty()) << number;
        end();
        EXPECT_TRUE(right(*drawSettled(), *drawExactly())) << number;
        ++number;
    }
}

TEST_F(MappingPages, FollowBends)
{
    addSome(2.0);
    for (const auto& scene : {_scene, _exactScene})
    {
        const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        scene->insertEffect(0, bend);
    }
    look({0.0, -900.0, 300.0}, {0.0, -200.0, 0.0});
    const osg::ref_ptr<osg::Image> exact = drawExactly();
    const osg::ref_ptr<osg::Image> paged = drawSettled();
    const DeformedView view(*_exactScene, *viewer().getCamera());
    EXPECT_TRUE(right(*paged, *exact,
                      [&](const osg::Vec2d& place)
                      {
                          osg::Vec2d pixel(-1e3, -1e3);
                          view.project(osg::Vec3d(place, 0.0), pixel);
                          return pixel;
                      }));
    EXPECT_GT(differing(*paged, *render(_exactScene->getChild(0))), _width * _height / 8);
}

TEST_F(MappingPages, LieOnAGlobe)
{
    const osg::ref_ptr<osg::EllipsoidModel> earth = new osg::EllipsoidModel;
    osg::Matrixd place;
    earth->computeLocalToWorldTransformFromLatLongHeight(0.8, 0.2, 0.0, place);
    const osg::ref_ptr<osg::Node> ground = _scene->getChild(0);
    for (const auto& [scene, mappings] : {std::pair(_scene, _mappings), std::pair(_exactScene, _exact)})
    {
        scene->removeChildren(0, scene->getNumChildren());
        const osg::ref_ptr<osg::MatrixTransform> stand = new osg::MatrixTransform(place);
        stand->addChild(ground);
        const osg::ref_ptr<osg::CoordinateSystemNode> globe = new osg::CoordinateSystemNode;
        globe->setEllipsoidModel(earth);
        globe->addChild(stand);
        scene->addChild(globe);
        mappings->setGeodeticOrigin(0.2, 0.8);
    }
    addSome();
    const osg::Matrixd view = viewer().getCamera()->getViewMatrix();
    viewer().getCamera()->setViewMatrix(osg::Matrixd::inverse(place) * view);
    const auto where = [&](const osg::Vec2d& at)
    {
        return pixelOf(osg::Vec3d(at, 0.0) * place);
    };
    EXPECT_TRUE(right(*drawSettled(), *drawExactly(), where));
}

TEST_F(MappingPages, ComeAgainInAnotherContext)
{
    addSome();
    const osg::ref_ptr<osg::Image> expected = drawSettled();
    withContext([&](osg::State& state) { _scene->releaseGLObjects(&state); });
    EXPECT_TRUE(same(*draw(), *drawExactly()));
    EXPECT_TRUE(same(*drawSettled(), *expected));
}
