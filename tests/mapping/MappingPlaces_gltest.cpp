// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Where mappings lie, against PROJ and GeographicLib; and which one lies on top, from wherever one looks.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/MappingStage.h>
#include <tools/Outlines.h>
#include <tools/RandomSamples.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <ogr_spatialref.h>
#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <sstream>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

/// Degrees.
struct Place
{
    double longitude = 0.0;
    double latitude = 0.0;
};

/// What PROJ makes of longitude and latitude.
class Projection
{
public:
    explicit Projection(const std::string& definition)
    {
        OGRSpatialReference from, to;
        from.SetFromUserInput("EPSG:4326");
        from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        EXPECT_EQ(to.SetFromUserInput(definition.c_str()), OGRERR_NONE) << definition;
        to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        _transformation.reset(OGRCreateCoordinateTransformation(&from, &to));
        EXPECT_TRUE(_transformation) << definition;
    }
    osg::Vec2d operator()(const Place& place) const
    {
        double x = place.longitude;
        double y = place.latitude;
        EXPECT_TRUE(_transformation && _transformation->Transform(1, &x, &y));
        return {x, y};
    }

private:
    struct Destroyer
    {
        void operator()(OGRCoordinateTransformation* it) const { OGRCoordinateTransformation::DestroyCT(it); }
    };
    std::unique_ptr<OGRCoordinateTransformation, Destroyer> _transformation;
};

} // namespace

class MappingPlaces : public MappingStage
{
protected:
    using Corners = std::array<Place, 4>;
    using World = std::function<osg::Vec3d(const Place&)>;

    MappingPlaces() : MappingStage(480, 360) {}

    /// A ground in which the vertices are where the function has them, in a grid of degrees about a place.
    osg::ref_ptr<osg::Node> makeGroundOf(const Place& middle, double halfX, double halfY, const World& world)
    {
        constexpr int cells = 160;
        const osg::ref_ptr<osg::Geometry> ground = makeGround(1.0, cells);
        const osg::Vec3d center = world(middle);
        for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*ground->getVertexArray()))
        {
            const Place place = {middle.longitude + halfX * static_cast<double>(vertex.x()),
                                 middle.latitude + halfY * static_cast<double>(vertex.y())};
            vertex = osg::Vec3(world(place) - center);
        }
        ground->dirtyBound();
        osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform(osg::Matrix::translate(center));
        node->addChild(ground);
        return node;
    }

    /// A hundred turned overlays around a place, each with a mapping whose corners the projection places.
    std::vector<Corners> addOverlays(const Place& middle, double halfX, double halfY,
                                     const std::function<osg::Vec2d(const Place&)>& project)
    {
        std::vector<Corners> all;
        for (int i = 0; i < 100; ++i)
        {
            Random random(static_cast<std::uint64_t>(i));
            const double x = middle.longitude + halfX * (i % 10 - 4.5) / 5.5;
            const int row = i / 10;
            const double y = middle.latitude + halfY * (row - 4.5) / 5.5;
            const double turn = random.uniform(-0.6, 0.6);
            Corners corners;
            osg::Vec2d projected[4];
            for (std::size_t c = 0; c < 4; ++c)
            {
                const double angle = turn + osg::PI_4 + static_cast<double>(c) * osg::PI_2 + osg::PI;
                const double size = random.uniform(0.065, 0.08);
                corners[c] = {x + halfX * size * std::cos(angle), y + halfY * size * std::sin(angle)};
                projected[c] = project(corners[c]);
            }
            const osg::ref_ptr<ProjectiveMapping> mapping = makeSolid({0.0, 0.0}, 1.0, colorOf(i));
            EXPECT_TRUE(mapping->setQuad(projected));
            _mappings->addMapping(mapping);
            all.push_back(corners);
        }
        return all;
    }

    /// The overlay's pixels are those within its outline, to a pixel.
    void expectOverlays(const std::vector<Corners>& overlays, const World& world, int fewest,
                        const std::string& name)
    {
        const osg::ref_ptr<osg::Image> image = draw();
        const DeformedView view(*_scene, *viewer().getCamera());
        int seen = 0;
        for (std::size_t i = 0; i < overlays.size(); ++i)
        {
            std::vector<osg::Vec2d> outline;
            bool visible = true;
            osg::Vec2d low(1e9, 1e9), high(-1e9, -1e9);
            constexpr int pieces = 8;
            for (std::size_t c = 0; c < 4 * pieces; ++c)
            {
                const Place& a = overlays[i][c / pieces];
                const Place& b = overlays[i][(c / pieces + 1) % 4];
                const double share = static_cast<double>(c % pieces) / pieces;
                osg::Vec2d pixel;
                visible = view.project(world({a.longitude + share * (b.longitude - a.longitude),
                                              a.latitude + share * (b.latitude - a.latitude)}),
                                       pixel) &&
                          inside(pixel, 4.0) && visible;
                outline.push_back(pixel);
                low.set(std::min(low.x(), pixel.x()), std::min(low.y(), pixel.y()));
                high.set(std::max(high.x(), pixel.x()), std::max(high.y(), pixel.y()));
            }
            if (!visible) continue;
            int within = 0;
            int wrong = 0;
            for (int y = static_cast<int>(low.y()) - 3; y <= static_cast<int>(high.y()) + 3; ++y)
            {
                for (int x = static_cast<int>(low.x()) - 3; x <= static_cast<int>(high.x()) + 3; ++x)
                {
                    if (!inside(osg::Vec2d(x, y))) continue;
                    const double depth = insideOf(outline, osg::Vec2d(x + 0.5, y + 0.5));
                    const bool colored = alike(at(*image, x, y), colorOf(static_cast<int>(i)));
                    within += depth > 1.0 ? 1 : 0;
                    wrong += (depth > 1.0 && !colored) || (depth < -1.0 && colored) ? 1 : 0;
                }
            }
            seen += within > 20 ? 1 : 0;
            EXPECT_EQ(wrong, 0) << name << ": overlay " << i << " of " << within << " pixels about "
                                << outline[0].x() << ", " << outline[0].y();
        }
        EXPECT_GE(seen, fewest) << name;
    }

    void expectCornersInAllViews(const std::vector<Corners>& overlays, const World& world,
                                 const Place& middle, const osg::Matrixd& frame, double reach)
    {
        const std::vector<osg::Vec3d> eyes = {{0.0, -0.01, 2.3}, {0.0, -1.4, 1.3}, {1.1, 0.8, 1.5}};
        for (std::size_t i = 0; i < eyes.size(); ++i)
        {
            osg::Camera& camera = *viewer().getCamera();
            const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.1, 1.0), frame);
            camera.setViewMatrixAsLookAt(eyes[i] * reach * frame, world(middle), up);
            camera.setProjectionMatrixAsPerspective(45.0, static_cast<double>(_width) / _height, 0.05 * reach,
                                                    20.0 * reach);
            expectOverlays(overlays, world, 50, "view " + std::to_string(i));
        }
        osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        bend->setHorizonLine(0.85);
        bend->setFocusLine(0.35);
        bend->setContextTilt(0.5);
        _scene->addEffect(bend);
        viewer().getCamera()->setViewMatrixAsLookAt(
            eyes[1] * reach * frame, world(middle),
            osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.1, 1.0), frame));
        const osg::ref_ptr<osg::Image> bent = draw();
        expectOverlays(overlays, world, 30, "bird's-eye view");
        bend->setEnabled(false);
        EXPECT_GT(differing(*bent, *draw()), _width * _height / 20) << "nothing is bent";
        _scene->removeEffect(bend);
    }

    void replaceGround(osg::Node* node)
    {
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(node);
    }
};

TEST_F(MappingPlaces, OnAGlobe)
{
    const GeographicLib::Geocentric& earth = GeographicLib::Geocentric::WGS84();
    const World world = [&](const Place& place)
    {
        osg::Vec3d p;
        earth.Forward(place.latitude, place.longitude, 0.0, p.x(), p.y(), p.z());
        return p;
    };
    struct Case
    {
        Place origin;
        Place middle;
        double half; // metres
    };
    // Around the origin, from 2 km to 150 km; far off the origin; in the high north; across the date line.
    for (const Case& each :
         {Case{{-158.0, 21.45}, {-158.0, 21.45}, 2000.0}, Case{{-158.0, 21.45}, {-158.05, 21.5}, 150000.0},
          Case{{-158.0, 21.45}, {-157.0, 22.5}, 20000.0}, Case{{13.0, 78.2}, {13.2, 78.1}, 10000.0},
          Case{{179.95, -17.0}, {180.0, -17.0}, 15000.0}})
    {
        SCOPED_TRACE(::testing::Message()
                     << each.middle.longitude << ", " << each.middle.latitude << ": " << each.half << " m");
        const double halfY = each.half / 111000.0;
        const double halfX = halfY / std::cos(osg::DegreesToRadians(each.middle.latitude));
        _mappings->removeMappings();
        _mappings->setGeodeticOrigin(osg::DegreesToRadians(each.origin.longitude),
                                     osg::DegreesToRadians(each.origin.latitude));
        osg::ref_ptr<osg::CoordinateSystemNode> earthNode = new osg::CoordinateSystemNode;
        earthNode->setEllipsoidModel(new osg::EllipsoidModel);
        earthNode->addChild(makeGroundOf(each.middle, 1.5 * halfX, 1.5 * halfY, world));
        replaceGround(earthNode);
        std::ostringstream definition;
        definition << "+proj=ortho +ellps=WGS84 +lat_0=" << each.origin.latitude
                   << " +lon_0=" << each.origin.longitude;
        const Projection projection(definition.str());
        const std::vector<Corners> overlays =
            addOverlays(each.middle, halfX, halfY, [&](const Place& place) { return projection(place); });

        std::vector<double> turn(9);
        osg::Vec3d foot;
        earth.Forward(each.middle.latitude, each.middle.longitude, 0.0, foot.x(), foot.y(), foot.z(), turn);
        const osg::Matrixd frame(turn[0], turn[3], turn[6], 0.0, turn[1], turn[4], turn[7], 0.0, turn[2],
                                 turn[5], turn[8], 0.0, foot.x(), foot.y(), foot.z(), 1.0);
        expectCornersInAllViews(overlays, world, each.middle, frame, each.half);
        if (HasFailure()) break;
    }
}

TEST_F(MappingPlaces, OnAProjectedTerrain)
{
    const Place middle = {-157.9, 21.4};
    const World world = [](const Place& place)
    {
        int zone = 0;
        bool north = false;
        double x = 0.0;
        double y = 0.0;
        GeographicLib::UTMUPS::Forward(place.latitude, place.longitude, zone, north, x, y);
        EXPECT_EQ(zone, 4);
        return osg::Vec3d(x, y, 0.0);
    };
    const osg::Vec2d origin(600000.0, 2365000.0);
    _mappings->setOrigin(origin);
    for (const double half : {3000.0, 20000.0})
    {
        SCOPED_TRACE(half);
        const double halfY = half / 111000.0;
        const double halfX = halfY / std::cos(osg::DegreesToRadians(middle.latitude));
        _mappings->removeMappings();
        replaceGround(makeGroundOf(middle, 1.5 * halfX, 1.5 * halfY, world));
        const Projection projection("EPSG:32604");
        const std::vector<Corners> overlays =
            addOverlays(middle, halfX, halfY, [&](const Place& place) { return projection(place) - origin; });
        expectCornersInAllViews(overlays, world, middle, osg::Matrixd::translate(world(middle)), half);
    }
}

namespace
{

/// What lies where: mixed from below.
osg::Vec3d mixed(const ProjectiveMappings& mappings, const osg::Vec2d& place, osg::Vec3d color)
{
    const std::vector<ProjectiveMapping*> over = mappings.mappingsAt(place);
    for (auto mapping = over.rbegin(); mapping != over.rend(); ++mapping)
    {
        const osg::Vec4d rgba = (*mapping)->getTransfer()->getConstant();
        const double share = (*mapping)->getOpacity();
        color = color * (1.0 - share) + osg::Vec3d(rgba.x(), rgba.y(), rgba.z()) * share;
    }
    return color;
}

} // namespace

TEST_F(MappingPlaces, TheOrderIsTheSameFromAllSides)
{
    Random random(7);
    for (int i = 0; i < 60; ++i)
    {
        osg::ref_ptr<ProjectiveMapping> mapping = makeSolid({0.0, 0.0}, 1.0, colorOf(i));
        mapping->setRectangle({random.uniform(-250.0, 250.0), random.uniform(-250.0, 250.0)},
                              random.uniform(50.0, 200.0), random.uniform(50.0, 200.0),
                              random.uniform(-3.0, 3.0));
        mapping->setOrder(random.integer(-2, 2));
        mapping->setOpacity(i % 2 ? 1.0 : 0.6);
        _mappings->addMapping(mapping);
    }
    const auto clear = [&](const osg::Vec2d& place)
    {
        const auto middle = _mappings->mappingsAt(place);
        for (int i = 0; i < 8; ++i)
        {
            const osg::Vec2d beside(5.0 * std::cos(i * osg::PI_4), 5.0 * std::sin(i * osg::PI_4));
            if (_mappings->mappingsAt(place + beside) != middle) return false;
        }
        return true;
    };
    std::vector<osg::Vec2d> places;
    while (places.size() < 400)
    {
        const osg::Vec2d place(random.uniform(-300.0, 300.0), random.uniform(-300.0, 300.0));
        if (clear(place)) places.push_back(place);
    }
    std::vector<osg::Vec3d> first;
    const int steps = fullTest() ? 72 : 24;
    for (int step = 0; step < steps; ++step)
    {
        const double heading = 2.0 * osg::PI * step / steps;
        for (const bool down : {true, false})
        {
            if (down)
                lookDown({0.0, 0.0}, 2.4, heading);
            else
                look({-600.0 * std::sin(heading), -600.0 * std::cos(heading), 700.0}, {0.0, 0.0, 0.0});
            const osg::ref_ptr<osg::Image> image = draw();
            std::vector<osg::Vec3d> colors;
            int seen = 0;
            for (std::size_t i = 0; i < places.size(); ++i)
            {
                const osg::Vec2d pixel = pixelOf(places[i]);
                ASSERT_TRUE(!down || inside(pixel));
                colors.push_back(inside(pixel) ? at(*image, pixel) : first[i]);
                if (!inside(pixel)) continue;
                ++seen;
                EXPECT_LE(difference(colors[i], mixed(*_mappings, places[i], groundColor())), tolerance)
                    << "place " << i << ", step " << step;
                EXPECT_TRUE(first.empty() || alike(colors[i], first[i]));
            }
            EXPECT_GT(seen, 300);
            if (first.empty()) first = colors;
            if (HasFailure()) return;
        }
    }
}

TEST_F(MappingPlaces, TheHigherOrderThenTheLaterIsOnTop)
{
    lookDown({0.0, 0.0}, 1.0);
    std::vector<osg::ref_ptr<ProjectiveMapping>> all;
    for (int i = 0; i < 5; ++i)
    {
        all.push_back(makeSolid({4.0 * i, 0.0}, 50.0, colorOf(i)));
        _mappings->addMapping(all.back());
    }
    const auto top = [&]
    {
        const osg::Vec3d color = at(*draw(), pixelOf(osg::Vec2d(8.0, 0.0)));
        for (int i = 0; i < 5; ++i)
        {
            if (alike(color, colorOf(i))) return i;
        }
        return -1;
    };
    EXPECT_EQ(top(), 4);
    all[1]->setOrder(1);
    EXPECT_EQ(top(), 1);
    all[2]->setOrder(1);
    EXPECT_EQ(top(), 2);
    all[2]->setOrder(-1000);
    EXPECT_EQ(top(), 1);
    all[1]->setOrder(0);
    EXPECT_EQ(top(), 4);
    all[0]->setOrder(1000);
    EXPECT_EQ(top(), 0);
    // What is added again is the latest.
    _mappings->removeMapping(all[0]);
    EXPECT_EQ(top(), 4);
    all[3]->setOrder(1000);
    _mappings->addMapping(all[0]);
    EXPECT_EQ(top(), 0);
    EXPECT_EQ(_mappings->mappingsAt({8.0, 0.0}).front(), all[0].get());
}
