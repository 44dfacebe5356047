// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What a probe reads of layers, against what was put there: plane and globe, straight and bent, with pictures of each kind.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/mapping/LayerProbe.h>
#include <osgGeoFX/mapping/LayerWords.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <gtest/gtest.h>
#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/Math>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>

using namespace osgGeoFX;

namespace
{

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// Values at the middles of texels over a square of 2000 m about the origin.
osg::ref_ptr<DataLayer> values(int side, const std::function<double(double, double)>& at)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_RED, GL_FLOAT);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            *reinterpret_cast<float*>(
                image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y))) =
                static_cast<float>(at(((x + 0.5) / side - 0.5) * 2000.0, ((y + 0.5) / side - 0.5) * 2000.0));
    osg::ref_ptr<DataLayer> layer = new DataLayer(image);
    layer->setKind(DataLayer::VALUE);
    return layer;
}

double slope(double x, double y)
{
    return 20.0 + 0.01 * x - 0.003 * y;
}

osg::ref_ptr<ProjectiveMapping> mappingOf(DataLayer* layer, const std::string& name)
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setName(name);
    mapping->setLayer(layer);
    mapping->setRectangle({0.0, 0.0}, 1000.0, 1000.0);
    return mapping;
}

osg::ref_ptr<DataLayer> picture(int width, int height, const std::vector<unsigned char>& rgba)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::copy(rgba.begin(), rgba.end(), image->data());
    return new DataLayer(image);
}

class Probe : public ::testing::Test
{
protected:
    void SetUp() override { _scene->addEffect(_mappings); }
    ProjectiveMapping& add(DataLayer* layer, const std::string& name)
    {
        const osg::ref_ptr<ProjectiveMapping> mapping = mappingOf(layer, name);
        _mappings->addMapping(mapping);
        return *mapping;
    }
    std::vector<LayerReading> at(double x, double y, double z = 0.0)
    {
        return LayerProbe::at(*_scene, {x, y, z}).readings;
    }

    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<ProjectiveMappings> _mappings = new ProjectiveMappings;
};

} // namespace

TEST_F(Probe, ReadsValuesBetweenTexelsWithTheirUnit)
{
    const osg::ref_ptr<DataLayer> layer = values(40, slope);
    LayerWords::setUnit(*layer, "mm");
    ProjectiveMapping& mapping = add(layer, "rain");
    mapping.setTable(ColorTable::named("greys", 0.0, 40.0));
    mapping.getTransfer()->setSource(ColorTransfer::TABLE);
    mapping.getTransfer()->setValueRange(0.0, 40.0);
    for (const osg::Vec2d& place :
         {osg::Vec2d(0.0, 0.0), osg::Vec2d(-812.5, 333.0), osg::Vec2d(951.0, -960.0)})
    {
        const std::vector<LayerReading> found = at(place.x(), place.y());
        ASSERT_EQ(found.size(), 1u);
        ASSERT_TRUE(found[0].value);
        EXPECT_NEAR(*found[0].value, slope(place.x(), place.y()), 1e-5);
        EXPECT_EQ(found[0].unit, "mm");
        EXPECT_NEAR(found[0].texel, 50.0, 1e-9);
        ASSERT_TRUE(found[0].color);
        EXPECT_NEAR(found[0].color->y(), slope(place.x(), place.y()) / 40.0, 1e-6);
        EXPECT_NEAR(found[0].raster.x(), (place.x() + 1000.0) / 2000.0, 1e-12);
    }
    EXPECT_EQ(at(100.0, 0.0)[0].text(), "rain: 21 mm");
    layer->setSmooth(false);
    EXPECT_NEAR(*at(1.0, 1.0)[0].value, slope(25.0, 25.0), 1e-5) << "the texel's own";
    EXPECT_TRUE(at(1000.5, 0.0).empty()) << "beside it";
}

TEST_F(Probe, NoDataCountsForNothing)
{
    // The left half has none, and the first row of the right half the value that means so.
    const osg::ref_ptr<DataLayer> layer =
        values(4,
               [](double x, double y) {
                   return x < 0.0 ? static_cast<double>(none) : y < -500.0 ? -999.0 : 7.0;
               });
    layer->setNoData(-999.0);
    add(layer, "depth");
    EXPECT_FALSE(at(-600.0, 0.0)[0].value);
    EXPECT_FALSE(at(-600.0, 0.0)[0].color);
    EXPECT_EQ(at(-600.0, 0.0)[0].text(), "depth: no data");
    EXPECT_FALSE(at(600.0, -900.0)[0].value);
    // Between a texel with and one without data, the former alone counts.
    EXPECT_DOUBLE_EQ(*at(-100.0, 300.0)[0].value, 7.0);
    EXPECT_DOUBLE_EQ(*at(600.0, -500.0)[0].value, 7.0);
}

// A raster of the world has a part in each of several effects. Two rasters of one effect may have the same name.
TEST_F(Probe, OfARasterInSeveralFramesThePartWithDataCounts)
{
    const auto everywhere = [](double value)
    {
        const osg::ref_ptr<DataLayer> layer = values(2, [value](double, double) { return value; });
        layer->setNoData(-999.0);
        return layer;
    };
    const auto texts = [&]
    {
        std::vector<std::string> result;
        for (const LayerReading& reading : at(0.0, 0.0))
            result.push_back(reading.text());
        return result;
    };
    const osg::ref_ptr<ProjectiveMappings> other = new ProjectiveMappings;
    other->addMapping(mappingOf(everywhere(-999.0), "world"));
    _scene->addEffect(other);
    add(everywhere(-999.0), "world");
    EXPECT_EQ(texts(), std::vector<std::string>{"world: no data"});
    _mappings->removeMapping(_mappings->getMapping(0));
    add(everywhere(7.0), "world");
    EXPECT_EQ(texts(), std::vector<std::string>{"world: 7"});
    _scene->removeEffect(other);
    add(everywhere(-999.0), "world");
    EXPECT_EQ(texts().size(), 2u) << "two rasters";
}

TEST_F(Probe, ReadsClassesByTheirNames)
{
    const osg::ref_ptr<DataLayer> layer = values(2, [](double x, double) { return x < 0.0 ? 10.0 : 20.0; });
    layer->setKind(DataLayer::CLASS);
    LayerWords::setNames(*layer, {{10.0, "woods"}, {30.0, "water"}});
    ProjectiveMapping& mapping = add(layer, "cover");
    osg::ref_ptr<ColorTable> table = new ColorTable;
    table->setMode(ColorTable::EXACT);
    table->setStops({{10.0, {0.0f, 1.0f, 0.0f, 0.5f}}, {20.0, {1.0f, 0.0f, 0.0f, 1.0f}}});
    mapping.setTable(table);
    mapping.getTransfer()->setSource(ColorTransfer::TABLE);
    mapping.getTransfer()->setValueRange(10.0, 20.0);
    const LayerReading woods = at(-1.0, 0.0)[0];
    EXPECT_EQ(woods.className, "woods");
    EXPECT_EQ(*woods.value, 10.0) << "never between two";
    EXPECT_EQ(*woods.color, osg::Vec4d(0.0, 1.0, 0.0, 0.5));
    EXPECT_EQ(woods.text(), "cover: woods (10)");
    EXPECT_EQ(at(1.0, 0.0)[0].text(), "cover: 20");
}

TEST_F(Probe, ReadsColorsAsTheMappingBringsThem)
{
    ProjectiveMapping& mapping = add(picture(2, 1, {255, 0, 0, 255, 0, 0, 255, 128}), "photo");
    EXPECT_EQ(at(-900.0, 0.0)[0].text(), "photo: #ff0000");
    EXPECT_EQ(at(900.0, 0.0)[0].text(), "photo: #0000ff, 50 %");
    const osg::Vec4d middle = *at(0.0, 0.0)[0].color;
    EXPECT_NEAR(middle.x(), 0.5, 1e-9);
    EXPECT_NEAR(middle.z(), 0.5, 1e-9);
    EXPECT_NEAR(middle.w(), 0.5 * (1.0 + 128.0 / 255.0), 1e-9);
    mapping.getTransfer()->setSaturation(0.0);
    const osg::Vec4d grey = *at(-900.0, 0.0)[0].color;
    EXPECT_NEAR(grey.x(), grey.y(), 1e-6);
    EXPECT_LT(grey.x(), 0.5);
    mapping.getTransfer()->setAlpha(ColorTransfer::OPAQUE);
    EXPECT_EQ(at(900.0, 0.0)[0].color->w(), 1.0);
    mapping.getTransfer()->setAlpha(ColorTransfer::FROM_MASK);
    mapping.setMask(picture(1, 1, {128, 128, 128, 255}));
    EXPECT_NEAR(at(900.0, 0.0)[0].color->w(), 128.0 / 255.0, 1e-9);
    mapping.getTransfer()->setSource(ColorTransfer::SCENE);
    EXPECT_FALSE(at(900.0, 0.0)[0].color) << "the probe does not know the ground's color";
    EXPECT_EQ(at(900.0, 0.0)[0].text(), "photo");
    // From above, as films have their rows.
    const osg::ref_ptr<DataLayer> film = picture(1, 2, {1, 2, 3, 255, 9, 9, 9, 255});
    film->getImage()->setOrigin(osg::Image::TOP_LEFT);
    film->setSmooth(false);
    add(film, "film");
    EXPECT_EQ(at(0.0, 500.0)[0].text(), "film: #010203");
    EXPECT_EQ(at(0.0, -500.0)[0].text(), "film: #090909");
}

TEST_F(Probe, TheTopmostComesFirstAndHiddenOnesNot)
{
    add(values(2, slope), "lower");
    add(values(2, slope), "upper").setOrder(3);
    add(values(2, slope), "off").setEnabled(false);
    add(values(2, slope), "high").setHeights(100.0, 200.0);
    const osg::ref_ptr<ProjectiveMappings> over = new ProjectiveMappings;
    over->setOrigin({500.0, 0.0});
    over->addMapping(mappingOf(values(2, slope), "over"));
    _scene->addEffect(over);
    const std::vector<LayerReading> found = at(600.0, 0.0);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].name, "over");
    EXPECT_EQ(found[1].name, "upper");
    EXPECT_EQ(found[2].name, "lower");
    EXPECT_NEAR(found[0].raster.x(), (600.0 - 500.0 + 1000.0) / 2000.0, 1e-12) << "the effect's own frame";
    ASSERT_EQ(at(600.0, 0.0, 150.0).size(), 4u);
    EXPECT_EQ(at(600.0, 0.0, 150.0)[2].name, "high");
    over->setEnabled(false);
    EXPECT_EQ(at(600.0, 0.0).size(), 2u);
}

TEST_F(Probe, ASequenceHasTheValueOfItsClock)
{
    std::vector<osg::ref_ptr<osg::Image>> steps;
    for (int i = 0; i < 3; ++i)
        steps.emplace_back(values(4, [i](double x, double) { return 100.0 * i + 0.01 * x; })->getImage());
    const osg::ref_ptr<LayerSequence> sequence =
        new LayerSequence(new ImageSteps(steps, {0.0, 10.0, 20.0}, DataLayer::VALUE));
    sequence->setWaiting(true);
    add(values(2, slope), "still");
    add(sequence->getLayer(), "rain");
    LayerPlayer* const player = LayerPlayer::onto(*_scene);
    player->add(sequence);
    player->getClock()->setPlaying(false);
    player->getClock()->setTime(15.0);
    player->update(1.0);
    const std::vector<LayerReading> found = at(250.0, 0.0);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].sequence, sequence);
    EXPECT_FALSE(found[1].sequence);
    EXPECT_NEAR(*found[0].value, 152.5, 1e-4);
}

TEST(ProbeOnAGlobe, ReadsTheFootOnTheEllipsoid)
{
    const osg::ref_ptr<osg::CoordinateSystemNode> globe = new osg::CoordinateSystemNode;
    globe->setEllipsoidModel(new osg::EllipsoidModel);
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    scene->addChild(globe);
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    const double longitude = osg::DegreesToRadians(-157.9), latitude = osg::DegreesToRadians(21.4);
    mappings->setGeodeticOrigin(longitude, latitude);
    mappings->addMapping(mappingOf(values(40, slope), "rain"));
    scene->addEffect(mappings);
    const osg::EllipsoidModel earth;
    const auto position = [&](double lon, double lat, double height)
    {
        osg::Vec3d result;
        earth.convertLatLongHeightToXYZ(lat, lon, height, result.x(), result.y(), result.z());
        return result;
    };
    const osg::Vec3d origin = position(longitude, latitude, 0.0);
    const osg::Vec3d east(-std::sin(longitude), std::cos(longitude), 0.0);
    const osg::Vec3d north(-std::sin(latitude) * std::cos(longitude),
                           -std::sin(latitude) * std::sin(longitude), std::cos(latitude));
    for (const osg::Vec2d& off :
         {osg::Vec2d(0.0, 0.0), osg::Vec2d(0.006, -0.004), osg::Vec2d(-0.0081, 0.0079)})
    {
        const double lon = longitude + osg::DegreesToRadians(off.x());
        const double lat = latitude + osg::DegreesToRadians(off.y());
        const osg::Vec3d foot = position(lon, lat, 0.0) - origin;
        // A mountain's top stands over the same place as its foot.
        const std::vector<LayerReading> found = LayerProbe::at(*scene, position(lon, lat, 1200.0)).readings;
        ASSERT_EQ(found.size(), 1u);
        EXPECT_NEAR(*found[0].value, slope(foot * east, foot * north), 1e-4);
    }
    // The straight line down comes out some tens of kilometres beside the antipode.
    mappings->getMapping(0)->setRectangle({0.0, 0.0}, 1e5, 1e5);
    EXPECT_EQ(LayerProbe::at(*scene, position(longitude, latitude, 0.0)).readings.size(), 1u);
    EXPECT_TRUE(LayerProbe::at(*scene, position(longitude + osg::PI, -latitude, 0.0)).readings.empty())
        << "the other side of the globe has the same x and y";
}

// The six parts of a raster of the world lie over each other by a hair; the one on top counts. Another raster may have its name.
TEST(ProbeOnAGlobe, WherePartsOfTheWorldMeetThereIsOneValue)
{
    const osg::ref_ptr<osg::CoordinateSystemNode> globe = new osg::CoordinateSystemNode;
    globe->setEllipsoidModel(new osg::EllipsoidModel);
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    scene->addChild(globe);
    const auto addPart = [&](double longitude, double latitude, double value)
    {
        const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        mappings->setGeodeticOrigin(longitude, latitude);
        const osg::ref_ptr<ProjectiveMapping> mapping =
            mappingOf(values(2, [value](double, double) { return value; }), "world");
        mapping->setRectangle({0.0, 0.0}, 5e6, 5e6);
        mappings->addMapping(mapping);
        scene->addEffect(mappings);
    };
    addPart(0.0, 0.0, 7.0);
    addPart(osg::PI_2, 0.0, 8.0);
    addPart(0.0, osg::PI_2, 9.0);
    osg::Vec3d place;
    osg::EllipsoidModel().convertLatLongHeightToXYZ(std::atan(std::sqrt(0.5)), osg::PI_4, 0.0, place.x(),
                                                    place.y(), place.z());
    std::vector<LayerReading> found = LayerProbe::at(*scene, place).readings;
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].text(), "world: 9");
    addPart(osg::DegreesToRadians(40.0), osg::DegreesToRadians(30.0), 10.0);
    EXPECT_EQ(LayerProbe::at(*scene, place).readings.size(), 2u);
}

namespace
{

/// Waves of ground of 20 x 20 km, with a camera that looks over it.
struct WavyGround
{
    explicit WavyGround(bool bent)
    {
        constexpr int cells = 160;
        osg::ref_ptr<osg::Vec3Array> posts = new osg::Vec3Array;
        osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
        for (int y = 0; y <= cells; ++y)
        {
            for (int x = 0; x <= cells; ++x)
            {
                const osg::Vec2d place((1.0 * x / cells - 0.5) * 20000.0, (1.0 * y / cells - 0.5) * 20000.0);
                posts->push_back(
                    osg::Vec3(osg::Vec3d(place.x(), place.y(),
                                         100.0 * std::sin(place.x() / 900.0) * std::cos(place.y() / 700.0))));
                if (x == cells || y == cells) continue;
                const auto corner = static_cast<unsigned int>(y * (cells + 1) + x);
                for (const unsigned int index : {0u, 1u, cells + 2u, 0u, cells + 2u, cells + 1u})
                    triangles->push_back(corner + index);
            }
        }
        osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setVertexArray(posts);
        geometry->addPrimitiveSet(triangles);
        scene->addChild(geometry);
        if (bent)
        {
            const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
            bend->setFocusLine(0.3);
            bend->setHorizonLine(0.9);
            scene->addEffect(bend);
        }
        scene->addEffect(mappings);
        camera->setViewport(0, 0, 320, 240);
        camera->setViewMatrixAsLookAt({0.0, -4500.0, 5500.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
        camera->setProjectionMatrixAsPerspective(40.0, 4.0 / 3.0, 1.0, 1e5);
    }
    osg::ref_ptr<EffectScene> scene = new EffectScene;
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
};

} // namespace

TEST(ProbeOfAPixel, ReadsWhatThePixelShowsBentOrNot)
{
    std::vector<double> farValues;
    for (const bool bent : {false, true})
    {
        WavyGround ground(bent);
        const osg::ref_ptr<ProjectiveMapping> mapping =
            mappingOf(values(400, [](double x, double y) { return slope(10.0 * x, 10.0 * y); }), "rain");
        mapping->setRectangle({0.0, 0.0}, 10000.0, 10000.0);
        ground.mappings->addMapping(mapping);
        int read = 0;
        for (const osg::Vec2d& pixel :
             {osg::Vec2d(160.5, 30.5), osg::Vec2d(40.5, 90.5), osg::Vec2d(230.5, 165.5)})
        {
            const auto probe = LayerProbe::under(*ground.scene, *ground.camera, pixel.x(), pixel.y());
            if (!probe || probe->readings.empty()) continue;
            ++read;
            ASSERT_EQ(probe->readings.size(), 1u);
            // The pixel's place by drawing the place again: the bend's own function, forwards.
            osg::Vec2d again;
            ASSERT_TRUE(DeformedView(*ground.scene, *ground.camera).project(probe->world, again));
            // Triangles are straight between their corners, and the bend is not.
            EXPECT_NEAR(again.x(), pixel.x(), 0.6);
            EXPECT_NEAR(again.y(), pixel.y(), 0.6);
            EXPECT_NEAR(*probe->readings[0].value, slope(probe->world.x(), probe->world.y()), 1e-3);
            if (pixel.y() > 100.0) farValues.push_back(*probe->readings[0].value);
        }
        EXPECT_GE(read, 2);
        EXPECT_EQ(LayerProbe::under(*ground.scene, *ground.camera, 160.5, 239.5).has_value(), !bent)
            << "the sky";
    }
    ASSERT_EQ(farValues.size(), 2u);
    EXPECT_GT(std::abs(farValues[0] - farValues[1]), 0.2) << "the bend shows another place at this pixel";
}

namespace
{

class SlopeTiles : public RasterTiles
{
public:
    osg::Vec2d low() const override { return {-1000.0, -1000.0}; }
    osg::Vec2d high() const override { return {1000.0, 1000.0}; }
    double texel() const override { return 0.5; }
    DataLayer::Kind kind() const override { return DataLayer::VALUE; }
    osg::ref_ptr<osg::Image> read(const osg::Vec2d& from, const osg::Vec2d& to, int columns, int rows,
                                  std::string&) override
    {
        ++reads;
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(columns, rows, 1, GL_RED, GL_FLOAT);
        for (int y = 0; y < rows; ++y)
        {
            for (int x = 0; x < columns; ++x)
            {
                const osg::Vec2d place(from.x() + (x + 0.5) / columns * (to.x() - from.x()),
                                       from.y() + (y + 0.5) / rows * (to.y() - from.y()));
                const bool inside = std::abs(place.x()) <= 1000.0 && std::abs(place.y()) <= 1000.0;
                *reinterpret_cast<float*>(
                    image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y))) =
                    inside ? static_cast<float>(slope(place.x(), place.y())) : none;
            }
        }
        return image;
    }
    std::atomic<int> reads{0};

protected:
    ~SlopeTiles() override = default;
};

} // namespace

TEST_F(Probe, APagedRasterIsReadFromWhatIsInMemory)
{
    std::string error;
    const osg::ref_ptr<SlopeTiles> tiles = new SlopeTiles;
    const osg::ref_ptr<PagedRaster> raster = PagedRaster::create(tiles, {}, error);
    ASSERT_TRUE(raster) << error;
    LayerWords::setUnit(*raster->getMapping()->getLayer(), "m");
    ASSERT_TRUE(_mappings->addRaster(raster));
    const int before = tiles->reads;
    const LayerReading found = at(321.0, -456.0)[0];
    EXPECT_EQ(tiles->reads, before) << "nothing is read for it";
    EXPECT_NEAR(*found.value, slope(321.0, -456.0), 1e-3);
    EXPECT_EQ(found.unit, "m");
    // The coarsest tiles cover 2048 m with 256 texels.
    EXPECT_NEAR(found.texel, 8.0, 1e-9);
    EXPECT_FALSE(raster->tileAt({1200.0, 0.0}).layer);
}
