// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What the makers of mappings put where, what they change when they are changed, and that they leave nothing behind.
#include <osgGeoFX/mapping/GeometrySwap.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/mapping/SymbolMapping.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>
#include <tools/Town.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace osgGeoFX;
using geofx::test::Random;
using osg::Vec2d;

namespace
{

osg::ref_ptr<DataLayer> someLayer()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::fill(image->data(), image->data() + image->getTotalSizeInBytes(), static_cast<unsigned char>(200));
    return new DataLayer(image);
}

double floatAt(const osg::Image& image, int column, int row)
{
    return static_cast<double>(*reinterpret_cast<const float*>(image.data(column, row)));
}

bool covers(const ProjectiveMapping& mapping, const Vec2d& place)
{
    const glm::dvec3 raster = mapping.placeToRaster() * glm::dvec3(place.x(), place.y(), 1.0);
    return raster.x >= 0.0 && raster.x <= 1.0 && raster.y >= 0.0 && raster.y <= 1.0;
}

int covering(const MappingPool& pool, const Vec2d& place)
{
    int count = 0;
    for (std::size_t i = 0; i < pool.size(); ++i)
        count += covers(pool.at(i), place);
    return count;
}

const std::vector<Vec2d> zigzag = {{0, 0}, {1000, 0}, {1000, 800}, {200, 1500}};

double distanceTo(const std::vector<Vec2d>& line, const Vec2d& place)
{
    double least = 1e30;
    for (std::size_t i = 1; i < line.size(); ++i)
    {
        for (int step = 0; step <= 2000; ++step)
            least =
                std::min(least, (line[i - 1] + (line[i] - line[i - 1]) * (step / 2000.0) - place).length());
    }
    return least;
}

class Makers : public ::testing::Test
{
protected:
    osg::ref_ptr<ProjectiveMappings> _mappings = new ProjectiveMappings;

    osg::ref_ptr<RouteMapping> add()
    {
        const osg::ref_ptr<RouteMapping> route = new RouteMapping;
        _mappings->addRoute(route);
        return route;
    }
};

using Route = Makers;
using Symbols = Makers;
using Swap = Makers;

/// Whether a setter refuses, with one warning.
bool refused(const std::function<bool()>& set)
{
    geofx::test::NotifyWatch watch;
    bool taken = true;
    const std::vector<std::string> messages = watch.messagesOf([&] { taken = set(); });
    return !taken && messages.size() == 1;
}

} // namespace

TEST_F(Route, hasAStripForEachLegAndADiscForEachPoint)
{
    {
        osg::ref_ptr<RouteMapping> route = add();
        route->setOrder(10);
        EXPECT_EQ(route->getNumMappings(), 0u);
        ASSERT_TRUE(route->setWayPoints(zigzag));
        EXPECT_EQ(route->legs(), 3u);
        EXPECT_NEAR(route->length(), 1000 + 800 + std::hypot(800, 700), 1e-9);
        EXPECT_EQ(route->mappings(RouteMapping::CONTEXT_MASKED).size(), 1u);
        EXPECT_EQ(route->mappings(RouteMapping::CONTEXT_BEYOND).size(), 4u);
        EXPECT_EQ(route->mappings(RouteMapping::POINTS).size(), 4u);
        // Strips, joins at two corners and caps at two ends; the casing's joins are at all four points.
        EXPECT_EQ(route->mappings(RouteMapping::LINE).size(), 3u + 2u + 2u);
        EXPECT_EQ(route->mappings(RouteMapping::CASING).size(), 3u + 4u);
        EXPECT_EQ(route->getNumMappings(), 1u + 4u + 4u + 7u + 7u);
        EXPECT_EQ(_mappings->getNumMappings(), 0u) << "these are the route's own";
        // From below: the context, the casing, the line, the points.
        EXPECT_EQ(route->mappings(RouteMapping::CONTEXT_MASKED).at(0).getOrder(), 10);
        EXPECT_EQ(_mappings->mappingsAt({0, 0}).front(), &route->mappings(RouteMapping::POINTS).at(0));
        const auto found = _mappings->mappingsAt({500, 0});
        ASSERT_EQ(found.size(), 3u);
        EXPECT_EQ(found[0]->getTransfer(), route->mappings(RouteMapping::LINE).at(0).getTransfer());
        EXPECT_EQ(found[1]->getTransfer(), route->mappings(RouteMapping::CASING).at(0).getTransfer());
        EXPECT_EQ(found[2], &route->mappings(RouteMapping::CONTEXT_MASKED).at(0));
        for (const ProjectiveMapping* mapping : found)
            EXPECT_EQ(_mappings->routeOf(*mapping), route);
        EXPECT_TRUE(_mappings->removeRoute(route));
        EXPECT_EQ(route->getNumMappings(), 0u);
    }
    EXPECT_TRUE(_mappings->mappingsAt({500, 0}).empty());
}

TEST_F(Route, linesAreAsWideAsTheyShould)
{
    const osg::ref_ptr<RouteMapping> route = add();
    RouteMapping::Style style;
    style.halfWidth = 10.0;
    style.casing = 4.0;
    route->setStyle(style);
    route->setWayPoints(zigzag);
    Random random(5);
    const MappingPool& line = route->mappings(RouteMapping::LINE);
    const MappingPool& casing = route->mappings(RouteMapping::CASING);
    int on = 0;
    for (int i = 0; i < 2000; ++i)
    {
        const Vec2d start = zigzag[static_cast<std::size_t>(random.integer(0, 3))];
        const Vec2d place = start + Vec2d(random.uniform(-25, 25), random.uniform(-25, 25));
        const double distance = distanceTo(zigzag, place);
        // Discs are the squares that their pictures fill, so only the strips and what lies inside are asked about.
        if (distance < 10.0 - 0.5)
        {
            ASSERT_GT(covering(line, place), 0) << place.x() << ", " << place.y();
        }
        if (distance < 14.0 - 0.5)
        {
            ASSERT_GT(covering(casing, place), 0);
        }
        if (distance > 15.0 * std::sqrt(2.0))
        {
            ASSERT_EQ(covering(casing, place), 0);
        }
        on += distance < 10.0;
    }
    EXPECT_GT(on, 300);
    EXPECT_EQ(route->legAt({500, 13}), 0u);
    EXPECT_EQ(route->legAt({988, 400}), 1u);
    EXPECT_FALSE(route->legAt({500, 15}));
}

TEST_F(Route, contextIsMaskedByTheDistanceAndHasNoGapsBeyond)
{
    const osg::ref_ptr<RouteMapping> route = add();
    RouteMapping::Style style;
    style.surroundings = 120.0;
    style.softness = 60.0;
    style.contextReach = 5000.0;
    route->setStyle(style);
    route->setWayPoints(zigzag);
    const ProjectiveMapping& context = route->mappings(RouteMapping::CONTEXT_MASKED).at(0);
    EXPECT_EQ(context.getTransfer()->getRampLow(), 120.0);
    EXPECT_EQ(context.getTransfer()->getRampHigh(), 180.0);
    const osg::Image& image = *context.getMask()->getImage();
    const glm::dmat3 back = glm::inverse(context.placeToRaster());
    for (int row = 0; row < image.t(); row += 7)
    {
        for (int column = 0; column < image.s(); column += 7)
        {
            const glm::dvec3 place =
                back * glm::dvec3((column + 0.5) / image.s(), (row + 0.5) / image.t(), 1.0);
            const double distance = distanceTo(zigzag, {place.x, place.y});
            const double held = floatAt(image, column, row);
            if (distance < 180.0)
            {
                ASSERT_NEAR(held, distance, 0.5) << column << ", " << row;
            }
            else
            {
                ASSERT_GE(held, 179.5) << column << ", " << row;
            }
        }
    }
    // The outermost texels are all beyond, so that nothing shows where the mask ends.
    for (int i = 0; i < image.s(); ++i)
        ASSERT_GE(floatAt(image, i, 0), 180.0);
    Random random(6);
    for (int i = 0; i < 5000; ++i)
    {
        const Vec2d place(random.uniform(-4500, 5500), random.uniform(-4500, 6000));
        ASSERT_EQ(covering(route->mappings(RouteMapping::CONTEXT_MASKED), place) +
                      covering(route->mappings(RouteMapping::CONTEXT_BEYOND), place),
                  1);
    }
}

TEST_F(Route, dashesGoOnRoundCorners)
{
    const osg::ref_ptr<RouteMapping> route = add();
    RouteMapping::Style style;
    style.halfWidth = 1.0;
    style.casing = 0.0;
    style.dash = 70.0;
    style.gap = 30.0;
    style.pointRadius = 0.0;
    style.context = false;
    route->setStyle(style);
    // The corner is in the middle of a dash at 535, and the end in a gap.
    route->setWayPoints({{0, 0}, {535, 0}, {535, 450}});
    const MappingPool& line = route->mappings(RouteMapping::LINE);
    for (double at = 2.0; at < 984.0; at += 1.7)
    {
        const double phase = std::fmod(at, 100.0);
        if (std::abs(phase - 70.0) < 3.0 || phase < 3.0 || phase > 97.0) continue;
        const Vec2d place = at < 535.0 ? Vec2d(at, 0) : Vec2d(535, at - 535.0);
        ASSERT_EQ(covering(line, place) > 0, phase < 70.0) << at;
    }
    // Ten dashes, one of which is in two parts with a join, and a cap at the beginning.
    EXPECT_EQ(line.size(), 10u + 1u + 1u + 1u);
    EXPECT_EQ(route->getNumMappings(), line.size());
}

TEST_F(Route, changesAreSmall)
{
    const osg::ref_ptr<RouteMapping> route = add();
    route->setWayPoints(zigzag);
    const std::size_t all = route->getNumMappings();
    ProjectiveMapping* first = &route->mappings(RouteMapping::CASING).at(0);
    const unsigned int before = first->revision();
    route->highlight(1);
    EXPECT_EQ(route->getNumMappings(), all);
    EXPECT_EQ(route->mappings(RouteMapping::LINE_HIGHLIGHTED).size(), 2u); // the strip and the join behind it
    EXPECT_TRUE(covers(route->mappings(RouteMapping::LINE_HIGHLIGHTED).at(0), {1000, 400}));
    EXPECT_EQ(first->revision(), before);
    route->highlight(std::nullopt);
    EXPECT_EQ(route->mappings(RouteMapping::LINE_HIGHLIGHTED).size(), 0u);

    // The last way point moves: the first leg stays as it is.
    route->setWayPoints({{0, 0}, {1000, 0}, {1000, 800}, {300, 1500}});
    EXPECT_EQ(&route->mappings(RouteMapping::CASING).at(0), first);
    EXPECT_EQ(first->revision(), before);
    EXPECT_EQ(route->getNumMappings(), all);
    route->setWayPoints({{0, 0}});
    EXPECT_EQ(route->getNumMappings(), 1u + 4u + 1u);
    route->setWayPoints({});
    EXPECT_EQ(route->getNumMappings(), 0u);
}

TEST_F(Route, refusesWhatMakesNoSense)
{
    const osg::ref_ptr<RouteMapping> route = add();
    ASSERT_TRUE(route->setWayPoints({{0, 0}, {0, 0}, {100, 0}}));
    EXPECT_EQ(route->legs(), 1u);
    EXPECT_TRUE(refused([&] { return route->setWayPoints({{0, 0}, {std::nan(""), 0}}); }));
    EXPECT_EQ(route->legs(), 1u);
    RouteMapping::Style style;
    style.softness = -1.0;
    EXPECT_TRUE(refused([&] { return route->setStyle(style); }));
    style.softness = 10.0;
    style.color.x() = 1.5f;
    EXPECT_TRUE(refused([&] { return route->setStyle(style); }));
    EXPECT_EQ(route->getStyle().softness, RouteMapping::Style().softness);
}

TEST_F(Route, isInOneEffectAtATime)
{
    const osg::ref_ptr<RouteMapping> route = add();
    route->setWayPoints(zigzag);
    const osg::ref_ptr<ProjectiveMappings> other = new ProjectiveMappings;
    EXPECT_TRUE(refused([&] { return other->addRoute(route); }));
    EXPECT_TRUE(refused([&] { return _mappings->addRoute(route); }));
    EXPECT_TRUE(refused([&] { return _mappings->addRoute(nullptr); }));
    EXPECT_TRUE(refused([&] { return _mappings->addMapping(&route->mappings(RouteMapping::LINE).at(0)); }));
    EXPECT_FALSE(_mappings->removeMapping(&route->mappings(RouteMapping::LINE).at(0)));
    EXPECT_FALSE(other->removeRoute(route));
    EXPECT_EQ(_mappings->getNumRoutes(), 1u);
    const std::size_t count = route->getNumMappings();
    _mappings->removeMappings();
    EXPECT_EQ(_mappings->getNumRoutes(), 0u);
    EXPECT_EQ(route->getNumMappings(), 0u);
    EXPECT_TRUE(other->addRoute(route));
    EXPECT_EQ(route->getNumMappings(), count);
    EXPECT_TRUE(other->removeRoute(route));
    // The effect goes, the route stays, and another one may have it.
    osg::ref_ptr<ProjectiveMappings> brief = new ProjectiveMappings;
    EXPECT_TRUE(brief->addRoute(route));
    brief = nullptr;
    EXPECT_EQ(route->getNumMappings(), 0u);
    EXPECT_EQ(route->getWayPoints(), zigzag);
    EXPECT_TRUE(_mappings->addRoute(route));
    EXPECT_EQ(route->getNumMappings(), count);
}

TEST_F(Route, liesAboveMappingsOfItsOrderAndBelowLaterRoutes)
{
    const osg::ref_ptr<RouteMapping> lower = add();
    const osg::ref_ptr<RouteMapping> upper = add();
    const osg::ref_ptr<ProjectiveMapping> plain = new ProjectiveMapping;
    plain->setRectangle({500, 0}, 2000.0, 2000.0);
    plain->setOrder(2); // the order of lines
    _mappings->addMapping(plain);
    RouteMapping::Style style;
    style.context = false;
    style.casing = style.pointRadius = 0.0;
    upper->setStyle(style);
    lower->setStyle(style);
    upper->setWayPoints({{0, 0}, {1000, 0}});
    // Made after all others.
    lower->setWayPoints(zigzag);
    const auto found = _mappings->mappingsAt({500, 0});
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(_mappings->routeOf(*found[0]), upper);
    EXPECT_EQ(_mappings->routeOf(*found[1]), lower);
    EXPECT_EQ(found[2], plain);
    EXPECT_FALSE(_mappings->routeOf(*plain));
}

TEST_F(Route, isCopiedWithItsEffect)
{
    const osg::ref_ptr<RouteMapping> route = add();
    route->setName("hike");
    route->setWayPoints(zigzag);
    route->setPointLayer(someLayer());
    route->highlight(1);
    for (const osg::CopyOp::CopyFlags flags : {osg::CopyOp::CopyFlags(osg::CopyOp::SHALLOW_COPY),
                                               osg::CopyOp::CopyFlags(osg::CopyOp::DEEP_COPY_ALL)})
    {
        const osg::ref_ptr<ProjectiveMappings> copy = osg::clone(_mappings.get(), osg::CopyOp(flags));
        ASSERT_EQ(copy->getNumRoutes(), 1u);
        RouteMapping& other = *copy->getRoute(0);
        EXPECT_NE(&other, route);
        EXPECT_EQ(other.getName(), "hike");
        EXPECT_EQ(other.getWayPoints(), zigzag);
        EXPECT_EQ(other.highlighted(), 1u);
        EXPECT_EQ(other.getNumMappings(), route->getNumMappings());
        EXPECT_EQ(other.getPointLayer() == route->getPointLayer(), flags == osg::CopyOp::SHALLOW_COPY);
        other.setWayPoints({});
        EXPECT_EQ(route->getWayPoints(), zigzag) << "each has its own";
    }
}

TEST_F(Route, takesNoLineThatMakesNoSense)
{
    using Way = RouteMapping::Way;
    const osg::ref_ptr<RouteMapping> route = add();
    // A leg of two strips.
    ASSERT_TRUE(route->setWay({{{0, 0}, {500, 100}, {1000, 0}, {1000, 800}}, {0, 2, 3}, {}}));
    EXPECT_EQ(route->legs(), 2u);
    EXPECT_EQ(route->mappings(RouteMapping::POINTS).size(), 3u) << "no mark within a leg";
    EXPECT_EQ(route->legAt({500, 100}), 0u);
    EXPECT_EQ(route->legAt({900, 20}), 0u);
    EXPECT_EQ(route->legAt({1000, 400}), 1u);
    route->highlight(0);
    EXPECT_EQ(route->mappings(RouteMapping::LINE_HIGHLIGHTED).size(), 2u + 2u + 1u)
        << "strips, joins and a cap";
    const Way good = route->getWay();
    for (const Way& bad : {Way{{{0, 0}, {1, 0}}, {0}, {}}, Way{{{0, 0}, {1, 0}}, {1, 1}, {}},
                           Way{{{0, 0}, {1, 0}}, {0, 2}, {}}, Way{{}, {0}, {}}, Way{{{0, 0}}, {}, {}},
                           Way{{{0, 0}, {0, 0}}, {0, 1}, {}}, Way{{{0, 0}, {1, 0}}, {0, 1}, {{7, 45}}},
                           Way{{{0, 0}, {6e7, 0}}, {0, 1}, {}}})
    {
        EXPECT_TRUE(refused([&] { return route->setWay(bad); }));
        EXPECT_EQ(route->getWay().line, good.line);
    }
}

TEST_F(Symbols, imagesFadeIntoEachOther)
{
    osg::ref_ptr<SymbolMapping> symbols = new SymbolMapping(*_mappings);
    SymbolMapping::Look look;
    look.levels = {{someLayer(), 1000.0}, {someLayer(), 3000.0}, {someLayer(), 9000.0}};
    look.softness = 0.3;
    const auto number = symbols->addLook(look);
    ASSERT_TRUE(number);
    const auto symbol = symbols->add(*number, {10, 20, 30});
    ASSERT_TRUE(symbol);
    EXPECT_EQ(_mappings->getNumMappings(), 3u);
    const auto levels = symbols->mappings(*symbol);
    const auto ramp = [](double value, double none, double full)
    {
        return std::clamp((value - none) / (full - none), 0.0, 1.0);
    };
    for (double away = 1.0; away < 9000.0; away += 7.0)
    {
        double sum = 0.0;
        for (const ProjectiveMapping* level : levels)
        {
            // As shaders/stages/mappings.frag.glsl fades.
            const double soft = level->getSoftness();
            const double near = level->getNearest();
            sum += (near > 0.0 ? ramp(away, near * (1 - soft), near) : 1.0) *
                   ramp(-away, -level->getFarthest() * (1 + soft), -level->getFarthest());
        }
        ASSERT_NEAR(sum, 1.0, 1e-9) << away;
    }
}

TEST_F(Symbols, comeMoveAndGo)
{
    {
        osg::ref_ptr<SymbolMapping> symbols = new SymbolMapping(*_mappings);
        SymbolMapping::Look look;
        look.levels = {{someLayer(), 5000.0}};
        look.width = 200.0;
        look.stretch = 1.5;
        look.pixels = 40.0;
        look.turned = true;
        look.order = 7;
        const auto number = symbols->addLook(look);
        ASSERT_TRUE(number);
        std::vector<int> all;
        for (int i = 0; i < 100; ++i)
            all.push_back(*symbols->add(*number, {i * 300.0, 0.0, 10.0}));
        EXPECT_EQ(symbols->size(), 100u);
        EXPECT_EQ(_mappings->getNumMappings(), 100u);
        const ProjectiveMapping& one = *symbols->mappings(all[3])[0];
        EXPECT_EQ(one.getLayer(), look.levels[0].layer);
        EXPECT_NEAR(one.getU().length(), 100.0, 1e-9);
        EXPECT_NEAR(one.getV().length(), 150.0, 1e-9);
        // The GPU's measure is the root of both half sizes.
        EXPECT_NEAR(one.getSizeInPixels(), 40.0 * std::sqrt(1.5), 1e-9);
        EXPECT_TRUE(one.getTurned());
        EXPECT_EQ(one.getHeight(), 10.0);
        EXPECT_EQ(one.getOrder(), 7);
        EXPECT_EQ(symbols->symbolOf(one), all[3]);

        EXPECT_TRUE(symbols->move(all[3], {5.0, 6.0, 7.0}));
        EXPECT_EQ(one.getCenter(), Vec2d(5.0, 6.0));
        EXPECT_TRUE(symbols->setEnabled(all[3], false));
        EXPECT_FALSE(one.getEnabled());
        EXPECT_TRUE(symbols->remove(all[3]));
        EXPECT_FALSE(symbols->remove(all[3]));
        EXPECT_FALSE(symbols->move(all[3], {}));
        EXPECT_EQ(_mappings->getNumMappings(), 99u);
        EXPECT_GT(*symbols->add(*number, {}), all.back());
    }
    EXPECT_EQ(_mappings->getNumMappings(), 0u);
}

TEST_F(Symbols, refuseLooksThatMakeNoSense)
{
    osg::ref_ptr<SymbolMapping> symbols = new SymbolMapping(*_mappings);
    SymbolMapping::Look look;
    EXPECT_TRUE(refused([&] { return static_cast<bool>(symbols->addLook(look)); }));
    look.levels = {{nullptr, 100.0}};
    EXPECT_TRUE(refused([&] { return static_cast<bool>(symbols->addLook(look)); }));
    look.levels = {{someLayer(), 1000.0}, {someLayer(), 1100.0}}; // fades out at 1200
    EXPECT_TRUE(refused([&] { return static_cast<bool>(symbols->addLook(look)); }));
    look.levels[1].farthest = 1200.0;
    EXPECT_TRUE(symbols->addLook(look));
    EXPECT_TRUE(refused([&] { return static_cast<bool>(symbols->add(1, {})); }));
    EXPECT_TRUE(refused([&] { return static_cast<bool>(symbols->add(0, {std::nan(""), 0.0, 0.0})); }));
    EXPECT_EQ(_mappings->getNumMappings(), 0u);
}

TEST_F(Swap, takesTurnsAndLeavesNothing)
{
    osg::ref_ptr<osg::Group> inside = new osg::Group, outside = new osg::Group, rest = new osg::Group;
    const char* define = "GEOFX_MAPPING_CHANNELS";
    {
        const osg::ref_ptr<GeometrySwap> swap =
            swapGeometries(*inside, *outside, *rest, *_mappings, someLayer(), {100, 200}, 50.0, 30.0);
        EXPECT_EQ(inside->getStateSet()->getDefinePair(define)->first, "1");
        EXPECT_EQ(outside->getStateSet()->getDefinePair(define)->first, "2");
        EXPECT_EQ(rest->getStateSet()->getDefinePair(define)->first, "252");
        EXPECT_EQ(_mappings->getNumMappings(), 6u);
        Random random(3);
        for (int i = 0; i < 1000; ++i)
        {
            // By channel: the inner geometry is asked for everywhere, the outer one where the mask is.
            const Vec2d place(random.uniform(0, 200), random.uniform(100, 300));
            const bool within = std::abs(place.x() - 100) < 50 && std::abs(place.y() - 200) < 30;
            int count[3] = {};
            for (const ProjectiveMapping* mapping : _mappings->mappingsAt(place))
            {
                ASSERT_EQ(mapping->getTransfer()->getEquation(), ColorTransfer::DISCARD);
                ASSERT_TRUE(mapping->getChannels() == 1 || mapping->getChannels() == 2);
                ++count[mapping->getChannels()];
            }
            ASSERT_EQ(count[1], 1);
            ASSERT_EQ(count[2], within ? 1 : 0);
        }
        const ProjectiveMapping& inner = swap->mappings().at(0);
        EXPECT_GT(inner.getTransfer()->getRampLow(), inner.getTransfer()->getRampHigh());
        swap->setEnabled(false);
        EXPECT_TRUE(_mappings->mappingsAt({100, 200}).empty());
        // A define that someone else has set since stays.
        outside->getStateSet()->setDefine(define, "4");
    }
    EXPECT_EQ(_mappings->getNumMappings(), 0u);
    EXPECT_FALSE(inside->getStateSet()->getDefinePair(define));
    EXPECT_TRUE(outside->getStateSet()->getDefinePair(define));
    EXPECT_FALSE(rest->getStateSet()->getDefinePair(define));
}

TEST(Town, isMadeOfManyHousesThatFaceOutwards)
{
    geofx::test::TownPlan plan;
    plan.blocksAcross = 12;
    plan.blocksAlong = 10;
    plan.height = [](double x, double)
    {
        return 0.1 * x;
    };
    const std::size_t blocks = geofx::test::townBlocks(plan).size();
    EXPECT_LT(blocks, 120u);
    EXPECT_GT(blocks, 90u);
    const auto check = [](const osg::Geometry& geometry)
    {
        const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
        const auto& normals = static_cast<const osg::Vec3Array&>(*geometry.getNormalArray());
        ASSERT_EQ(vertices.size(), normals.size());
        for (std::size_t i = 0; i < vertices.size(); i += 3)
        {
            const osg::Vec3 face = (vertices[i + 1] - vertices[i]) ^ (vertices[i + 2] - vertices[i]);
            ASSERT_GT(face * normals[i], 0.0f);
            ASSERT_GE(normals[i].z(), -1e-3f) << "a face that looks down";
        }
    };
    const osg::ref_ptr<osg::Geometry> town = geofx::test::makeTown(plan);
    const osg::ref_ptr<osg::Geometry> coarse = geofx::test::makeGeneralisedTown(plan);
    check(*town);
    check(*coarse);
    check(*geofx::test::makeTownGround(plan, 50.0));
    // A prism has ten triangles, a gabled house fourteen.
    EXPECT_EQ(coarse->getVertexArray()->getNumElements(), blocks * 30);
    EXPECT_GT(town->getVertexArray()->getNumElements(), blocks * 4 * 30);
    EXPECT_GT(town->getBoundingBox().zMin(), -8.1f - 0.1f * 700.0f);
    const osg::ref_ptr<osg::Geometry> again = geofx::test::makeTown(plan);
    EXPECT_EQ(static_cast<const osg::Vec3Array&>(*again->getVertexArray()).asVector(),
              static_cast<const osg::Vec3Array&>(*town->getVertexArray()).asVector());
}
