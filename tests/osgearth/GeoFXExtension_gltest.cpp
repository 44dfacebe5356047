// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The extension <geofx> of osgEarth's maps.
#include "EarthMap.h"

#include <osgEarth/ImageLayer>
#include <osgEarth/TerrainEngineNode>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>
#include <tools/ResidentMemory.h>
#include <tools/TempDir.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

const char* const effects[] = {
    "<birdsEyeView/>",
    "<pedestrianView/>",
    "<verticalExaggeration factor=\"3\"/>",
    "<panoramaMap ripples=\"0\"/>",
    "<projectiveMappings><transfer name=\"red\" source=\"constant\" constantColor=\"#e01010\"/><mapping "
    "transfer=\"red\" west=\"10.4\" south=\"0.4\" east=\"10.6\" north=\"0.6\"/></projectiveMappings>",
    "<closeUps pipeline=\"multiPass\"><closeUp offsetHeight=\"4000\" scaleX=\"2\" scaleY=\"2\"><region "
    "longitude=\"10.5\" "
    "latitude=\"0.33\" width=\"9000\" depth=\"9000\"/></closeUp></closeUps>",
};

/// Each effect on a globe, and in a projection.
class GeoFXExtension : public EarthMaps,
                       public testing::WithParamInterface<std::tuple<const char*, const char*>>
{
protected:
    GeoFXExtension() { setProfile(std::get<1>(GetParam())); }
    static std::string effect()
    {
        std::string text = std::get<0>(GetParam());
        // The edges of mappings are the map's own coordinates: degrees on a globe, here metres.
        const std::string degrees = "west=\"10.4\" south=\"0.4\" east=\"10.6\" north=\"0.6\"";
        const std::size_t at = text.find(degrees);
        if (*std::get<1>(GetParam()) && at != std::string::npos)
            text.replace(at, degrees.size(),
                         "west=\"1157723\" south=\"44528\" east=\"1179987\" north=\"66792\"");
        return text;
    }
};

std::string anyEffect(Random& random)
{
    return effects[static_cast<std::size_t>(random.integer(0, 5))];
}

} // namespace

// Each effect changes what osgEarth draws, and says nothing.
TEST_P(GeoFXExtension, ShowsTheEffect)
{
    NotifyWatch watch;
    ASSERT_TRUE(show(""));
    const osg::ref_ptr<osg::Image> plain = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
    ASSERT_TRUE(show(extension(effect())));
    ASSERT_TRUE(scene());
    EXPECT_EQ(scene()->getNumEffects(), 1u);
    EXPECT_GT(differing(*draw(10.5, 0.2, 9000.0, 0.0, -32.0), *plain), 300);
    // Without the effect all is as it was.
    scene()->getEffect(0)->setEnabled(false);
    EXPECT_LE(differing(*draw(10.5, 0.2, 9000.0, 0.0, -32.0), *plain), 20);
}

// Nothing that the picture shows is missing where osgEarth culls for itself, to the bit.
TEST_P(GeoFXExtension, CullsNothingThatIsSeen)
{
    // osgEarth sorts its tiles by addresses, so skirts that coincide with ground would come first or last.
    ASSERT_TRUE(show(extension(effect()), ""));
    ASSERT_TRUE(scene());
    const osg::CullSettings::CullingMode mode = camera().getCullingMode();
    Random random(3);
    const int count = fullTest() ? 50 : 3;
    for (int i = 0; i < count; ++i)
    {
        const double longitude = random.uniform(10.1, 10.9), latitude = random.uniform(0.1, 0.9);
        const double height = random.logarithmic(2500.0, 60000.0);
        const double heading = random.uniform(0.0, 360.0), pitch = random.uniform(-60.0, 5.0);
        SCOPED_TRACE(std::to_string(longitude) + " " + std::to_string(latitude) + " " +
                     std::to_string(height) + " " + std::to_string(heading) + " " + std::to_string(pitch));
        // The levels of a panorama map do not fall with the distance, so a whole globe that nothing culls has no end.
        const bool bounded = effect().find("panoramaMap") == std::string::npos;
        if (bounded) camera().setCullingMode(osg::CullSettings::NO_CULLING);
        // Its picture begins far from the eye. With a near plane at 20 m, 24 bits of depth cannot tell apart hills that are 500 km
        // away and a kilometre behind one another, and osgEarth's order of tiles would decide.
        if (!bounded) setProjection(height / 10.0, 2e7);
        scene()->setEngineCulling(EffectScene::OPEN);
        const osg::ref_ptr<osg::Image> all = draw(longitude, latitude, height, heading, pitch);
        camera().setCullingMode(mode);
        EXPECT_EQ(differing(*draw(longitude, latitude, height, heading, pitch), *all), 0) << "open";
        scene()->setEngineCulling(EffectScene::PROXY);
        EXPECT_EQ(differing(*draw(longitude, latitude, height, heading, pitch), *all), 0) << "proxy";
    }
}

// The drawables of the terrain are as large as the Earth. Near and far are those of the ground that is shown.
TEST_P(GeoFXExtension, FindsNearAndFar)
{
    ASSERT_TRUE(show(extension(effect())));
    ASSERT_TRUE(scene());
    const osg::ref_ptr<osg::Image> fixed = draw(10.5, 0.2, 9000.0, 20.0, -12.0);
    camera().setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    camera().setNearFarRatio(1e-5);
    // Depths are rounded otherwise.
    EXPECT_LE(differing(*draw(10.5, 0.2, 9000.0, 20.0, -12.0), *fixed), WIDTH * HEIGHT / 100);
}

INSTANTIATE_TEST_SUITE_P(OnAGlobe, GeoFXExtension,
                         testing::Combine(testing::ValuesIn(effects), testing::Values("")));
INSTANTIATE_TEST_SUITE_P(Projected, GeoFXExtension,
                         testing::Combine(testing::ValuesIn(effects), testing::Values("plate-carre")));

TEST_F(EarthMaps, AFaultIsASentenceAndTheMapIsDrawn)
{
    NotifyWatch watch;
    ASSERT_TRUE(show(""));
    const osg::ref_ptr<osg::Image> plain = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
    const std::vector<std::string> said =
        watch.messagesOf([&] { EXPECT_TRUE(show(extension("<birdsEyeView focusLane=\"0.4\"/>"))); });
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    // osgEarth's reader makes names lower case.
    EXPECT_NE(said[0].find(file() + ":5: <birdsEyeView>: the attribute \"focuslane\" is not known"),
              std::string::npos)
        << said[0];
    EXPECT_FALSE(scene());
    EXPECT_LE(differing(*draw(10.5, 0.2, 9000.0, 0.0, -32.0), *plain), 20);
}

TEST_F(EarthMaps, OnlyTheFirstOfTwoBlocksActs)
{
    NotifyWatch watch;
    ASSERT_TRUE(show(extension("<verticalExaggeration factor=\"3\"/>")));
    const osg::ref_ptr<osg::Image> one = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
    const std::vector<std::string> said = watch.messagesOf(
        [&]
        {
            EXPECT_TRUE(show(extension("<verticalExaggeration factor=\"3\"/>") + "\n" +
                             extension("<birdsEyeView/>")));
        });
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_NE(said[0].find("this <geofx> is left out"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find(file()), std::string::npos) << said[0];
    ASSERT_TRUE(scene());
    EXPECT_EQ(scene()->getNumEffects(), 1u);
    EXPECT_LE(differing(*draw(10.5, 0.2, 9000.0, 0.0, -32.0), *one), 20);
    map().clearExtensions();
    EXPECT_FALSE(scene());
}

TEST_F(EarthMaps, HeightsUpsideDownAreASentence)
{
    NotifyWatch watch;
    ASSERT_TRUE(show(""));
    const osg::ref_ptr<osg::Image> plain = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
    const std::vector<std::string> said = watch.messagesOf(
        [&]
        {
            EXPECT_TRUE(show("<geofx version=\"1\"><terrain><engine minHeight=\"1100\" maxHeight=\"-10\"/>"
                             "</terrain><effects><birdsEyeView/></effects></geofx>"));
        });
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_NE(said[0].find(file() + ":5"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find("minHeight"), std::string::npos) << said[0];
    EXPECT_FALSE(scene());
    EXPECT_LE(differing(*draw(10.5, 0.2, 9000.0, 0.0, -32.0), *plain), 20);
}

// The hills are 0 to 1000 m high.
TEST_F(EarthMaps, HeightsOutsideOfWhatIsStatedAreASentence)
{
    NotifyWatch watch;
    const auto said = [&](const std::string& heights)
    {
        return watch.messagesOf(
            [&]
            {
                ASSERT_TRUE(
                    show("<geofx version=\"1\"><terrain><engine " + heights +
                         "/></terrain><effects><verticalExaggeration factor=\"3\"/></effects></geofx>"));
                const osg::ref_ptr<osg::Image> picture = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
                const unsigned char* const middle = picture->data(WIDTH / 2, HEIGHT / 3);
                const osg::Vec4 clear = camera().getClearColor() * 255.0f;
                EXPECT_GT(std::abs(static_cast<float>(middle[0]) - clear.r()), 2.0f);
            });
    };
    for (const std::string heights :
         {"minHeight=\"-10\" maxHeight=\"500\"", "minHeight=\"300\" maxHeight=\"1100\""})
    {
        const std::vector<std::string> words = said(heights);
        ASSERT_EQ(words.size(), 1u) << ::testing::PrintToString(words);
        EXPECT_NE(words[0].find(file()), std::string::npos) << words[0];
        EXPECT_NE(words[0].find("but <engine> states"), std::string::npos) << words[0];
    }
    EXPECT_TRUE(said("minHeight=\"-10\" maxHeight=\"1100\"").empty());
    EXPECT_TRUE(said("").empty());
}

// A bend shows what lies below osgEarth's horizon, where its own sky has no color.
TEST_F(EarthMaps, TheSkyComesDownWithTheSkyline)
{
    NotifyWatch watch;
    const std::string bent = extension("<birdsEyeView/>");
    std::string sky = bent;
    sky.insert(sky.find("<effects>"), "<background color=\"#b9d3ea\" sky=\"true\"/>");
    ASSERT_TRUE(show(bent));
    const osg::ref_ptr<osg::Image> plain = draw(10.5, 0.2, 9000.0, 0.0, -40.0);
    ASSERT_TRUE(show(sky));
    const osg::ref_ptr<osg::Image> picture = draw(10.5, 0.2, 9000.0, 0.0, -40.0);
    const osg::Vec4 clear = camera().getClearColor() * 255.0f;
    const auto isClear = [&](const osg::Image& image, int x, int y)
    {
        const unsigned char* const pixel =
            image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
        return std::abs(static_cast<float>(pixel[0]) - clear.r()) < 2.0f &&
               std::abs(static_cast<float>(pixel[2]) - clear.b()) < 2.0f;
    };
    int above = 0, left = 0;
    for (int x = 0; x < WIDTH; ++x)
        for (int y = 0; y < HEIGHT; ++y)
        {
            above += isClear(*plain, x, y) ? 1 : 0;
            if (!isClear(*plain, x, y)) continue;
            left += isClear(*picture, x, y) ? 1 : 0;
            const unsigned char* const pixel =
                picture->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            EXPECT_GT(pixel[2], pixel[0] + 20) << x << ' ' << y;
        }
    EXPECT_GT(above, WIDTH * HEIGHT / 20);
    EXPECT_LT(left, above / 50);
    // The sky goes with the extension.
    map().clearExtensions();
    EXPECT_FALSE(scene());
    EXPECT_EQ(map().getNumParents(), 1u);
    // The plane has no sky, and a background without one is the program's.
    setProfile("plate-carre");
    std::vector<std::string> said = watch.messagesOf([&] { EXPECT_TRUE(show(sky)); });
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_NE(said[0].find("the sky is left out"), std::string::npos) << said[0];
    EXPECT_TRUE(scene());
    sky.replace(sky.find(" sky=\"true\""), 11, "");
    said = watch.messagesOf([&] { EXPECT_TRUE(show(sky)); });
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_NE(said[0].find("expected: sky=\"true\""), std::string::npos) << said[0];
}

// The globe of a map without layers is smooth, and one without terrain shows nothing.
TEST_F(EarthMaps, MapsWithoutLayersOrTerrainSayNothing)
{
    NotifyWatch watch;
    const TempDir folder;
    const std::string file = (folder.path() / "bare.earth").string();
    for (const bool terrain : {true, false})
    {
        std::ofstream(file) << "<map><options><terrain skirt_ratio=\"0.05\" color=\"#7f9f5f\" visible=\""
                            << (terrain ? "true" : "false") << "\"/></options>"
                            << extension("<birdsEyeView/>") << "</map>";
        const std::vector<std::string> said = watch.messagesOf([&] { EXPECT_TRUE(showFile(file)); });
        EXPECT_TRUE(said.empty()) << ::testing::PrintToString(said);
        EXPECT_TRUE(scene());
        const osg::ref_ptr<osg::Image> picture = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
        const unsigned char* const middle = picture->data(WIDTH / 2, HEIGHT / 2);
        const osg::Vec4 clear = camera().getClearColor() * 255.0f;
        const bool isEmpty = std::abs(static_cast<float>(middle[0]) - clear.r()) < 2.0f;
        EXPECT_EQ(isEmpty, !terrain);
    }
}

// Tiles of the map that goes may be on their way.
TEST_F(EarthMaps, MapsAreReplacedWhileTilesCome)
{
    NotifyWatch watch;
    const std::vector<std::string> said = watch.messagesOf(
        [&]
        {
            for (int i = 0; i < 12; ++i)
            {
                ASSERT_TRUE(show(extension(effects[i % 6])));
                camera().setViewMatrix(viewFrom(10.5, 0.2, 9000.0 + 100.0 * i, 30.0 * i, -32.0));
                for (int frame = 0; frame < i; ++frame)
                    viewer().frame();
            }
        });
    EXPECT_TRUE(said.empty()) << ::testing::PrintToString(said);
    const osg::ref_ptr<osg::Image> last = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
    ASSERT_TRUE(show(extension(effects[11 % 6])));
    EXPECT_LE(differing(*draw(10.5, 0.2, 9000.0, 0.0, -32.0), *last), 20);
}

// The scene holds the map, which holds the extension.
TEST_F(EarthMaps, AMapThatGoesIsFreed)
{
    ASSERT_TRUE(show(extension("<birdsEyeView/>")));
    viewer().frame();
    const osg::observer_ptr<osgEarth::MapNode> map = &this->map();
    const osg::observer_ptr<EffectScene> effects = scene();
    EXPECT_TRUE(map.valid());
    EXPECT_TRUE(effects.valid());
    ASSERT_TRUE(show(""));
    for (int frame = 0; frame < 3; ++frame)
        viewer().frame();
    EXPECT_FALSE(effects.valid());
    EXPECT_FALSE(map.valid());
}

// 10,000 steps with GEOFX_TEST_FULL, 500 without, at about 0.4 s each on a core: effects, layers, views and maps come and go.
TEST_F(EarthMaps, RandomStepsEndWell)
{
    Random random(57);
    NotifyWatch watch;
    const int steps = sampleCount() / 10;
    double half = 0.0;
    const std::vector<std::string> said = watch.messagesOf(
        [&]
        {
            ASSERT_TRUE(show(""));
            for (int i = 0; i < steps; ++i)
            {
                switch (random.integer(0, 7))
                {
                case 0:
                    setProfile(random.integer(0, 1) ? "plate-carre" : "");
                    ASSERT_TRUE(show(random.integer(0, 1) ? extension(anyEffect(random)) : ""));
                    break;
                case 1:
                case 2:
                    map().clearExtensions();
                    ASSERT_TRUE(addExtension(extension(anyEffect(random))));
                    break;
                case 3:
                    map().clearExtensions();
                    break;
                case 4:
                {
                    std::vector<osg::ref_ptr<osgEarth::ImageLayer>> layers;
                    map().getMap()->getLayers(layers);
                    for (const auto& layer : layers)
                    {
                        layer->setVisible(random.integer(0, 3) != 0);
                        layer->setOpacity(static_cast<float>(random.uniform(0.2, 1.0)));
                    }
                }
                break;
                case 5:
                    camera().setComputeNearFarMode(
                        random.integer(0, 1) ? osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR
                                             : osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
                    break;
                default:
                    camera().setViewMatrix(viewFrom(random.uniform(-180.0, 180.0),
                                                    random.uniform(-89.0, 89.0),
                                                    random.logarithmic(60.0, 2e7), random.uniform(0.0, 360.0),
                                                    random.uniform(-90.0, 10.0)));
                }
                setProjection(20.0, 2e7);
                viewer().frame();
                if (i == steps / 2) half = residentMiB();
            }
        });
    EXPECT_TRUE(said.empty()) << ::testing::PrintToString(said);
    EXPECT_LT(residentMiB(), 1.2 * half + 100.0) << "MiB; after half of the steps it was " << half;
    setProfile("");
    ASSERT_TRUE(show(extension(effects[0])));
    const osg::ref_ptr<osg::Image> last = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
    ASSERT_TRUE(show(extension(effects[0])));
    EXPECT_LE(differing(*draw(10.5, 0.2, 9000.0, 0.0, -32.0), *last), 20);
}

TEST_F(EarthMaps, TerrainWithoutSkirtsGetsAWarning)
{
    NotifyWatch watch;
    const std::vector<std::string> said =
        watch.messagesOf([&] { EXPECT_TRUE(show(extension("<birdsEyeView/>"), "")); });
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_NE(said[0].find("skirt_ratio"), std::string::npos);
    EXPECT_TRUE(scene());
}

// The panorama map of a plane is as fine as that of the globe, whose ground hardly curves that near.
TEST_F(EarthMaps, PanoramasOfAPlaneAreAsFineAsOfAGlobe)
{
    const std::string panorama = extension("<panoramaMap ripples=\"0\"/>");
    ASSERT_TRUE(show(panorama));
    const osg::ref_ptr<osg::Image> globe = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
    setProfile("plate-carre");
    ASSERT_TRUE(show(panorama));
    const osg::ref_ptr<osg::Image> plane = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
    double sum = 0.0;
    for (int y = 0; y < HEIGHT; ++y)
    {
        for (int i = 0; i < 3 * WIDTH; ++i)
            sum += std::abs(globe->data(0, y)[i] - plane->data(0, y)[i]);
    }
    EXPECT_LT(sum / (3.0 * WIDTH * HEIGHT), 8.0);
}

// Levels by the size of tiles in the picture go by the deformed picture, too.
TEST_F(EarthMaps, LevelsByPixelsStopWhereNothingIsSeen)
{
    ASSERT_TRUE(show(extension("<verticalExaggeration factor=\"3\"/>"),
                     "skirt_ratio=\"0.05\" lod_method=\"screen_space\""));
    const osg::ref_ptr<osg::Image> picture = draw(10.5, 0.2, 9000.0, 0.0, -32.0);
    scene()->setEngineCulling(EffectScene::OPEN);
    EXPECT_LE(differing(*draw(10.5, 0.2, 9000.0, 0.0, -32.0), *picture), 4);
}

// osgEarth unloads what no camera comes to, and a parent that needs it loads it again.
TEST_F(EarthMaps, TilesThatAreNotShownStay)
{
    struct Arrivals : osgEarth::TerrainCallback
    {
        void onTileUpdate(const osgEarth::TileKey&, osg::Node*, osgEarth::TerrainCallbackContext&) override
        {
            ++count;
        }
        int count = 0;
    };
    for (const char* effect : {"", "<verticalExaggeration factor=\"2\"/>", "<panoramaMap/>"})
    {
        SCOPED_TRACE(effect);
        ASSERT_TRUE(show(*effect ? extension(effect) : "",
                         "skirt_ratio=\"0.05\" min_expiry_time=\"0\" min_expiry_frames=\"3\""));
        ASSERT_TRUE(draw(10.5, 0.2, 9000.0, 20.0, -12.0));
        const osg::ref_ptr<Arrivals> arrivals = new Arrivals;
        map().getTerrain()->addTerrainCallback(arrivals);
        for (int i = 0; i < 3; ++i)
            ASSERT_TRUE(draw(10.5, 0.2, 9000.0, 20.0, -12.0));
        EXPECT_EQ(arrivals->count, 0);
        map().getTerrain()->removeTerrainCallback(arrivals);
    }
}

TEST_F(EarthMaps, UnitsAreOsgEarthsAndAreGivenBack)
{
    const auto free = [&]
    {
        std::vector<int> units;
        int unit = 0;
        osgEarth::TerrainResources& resources = *map().getTerrainEngine()->getResources();
        while (resources.reserveTextureImageUnit(unit))
            units.push_back(unit);
        for (const int each : units)
            resources.releaseTextureImageUnit(each);
        return units;
    };
    ASSERT_TRUE(show(extension(std::string(effects[3]) + effects[4])));
    const std::vector<int> during = free();
    for (const int unit : scene()->getTextureUnits())
        EXPECT_EQ(std::count(during.begin(), during.end(), unit), 0) << unit;
    EXPECT_EQ(scene()->getTextureUnits().size(), 8u);
    map().clearExtensions();
    EXPECT_FALSE(scene());
    EXPECT_EQ(free().size(), during.size() + 9);
}
