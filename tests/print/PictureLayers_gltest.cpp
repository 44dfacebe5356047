// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Layers put together again, as their recipe says, against the picture; what each of them has; places against picking.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/print/PictureLayers.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/DepthReader.h>
#include <print/HillsPicture.h>
#include <tools/RandomSamples.h>
#include <tools/SampledCases.h>

#include <OpenImageIO/imageio.h>
#include <nlohmann/json.hpp>
#include <osg/Math>

#include <cmath>
#include <filesystem>
#include <fstream>

using namespace osgGeoFX;
using namespace geofx::test;

namespace fs = std::filesystem;

namespace
{

constexpr int WIDTH = 180, HEIGHT = 120;

/// The channels of a file, as they are; rows downwards.
struct Layer
{
    int channels = 0;
    std::vector<double> values;
    double at(int x, int y, int channel) const
    {
        return values[static_cast<std::size_t>((y * WIDTH + x) * channels + channel)];
    }
};

class PictureLayersTest : public HillsPicture
{
protected:
    PictureLayersTest() : HillsPicture(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        HillsPicture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        for (int i = 0; i < 12; ++i)
            addName(3000.0 * (i % 4 - 2), 4000.0 * (i / 4 - 1));
    }

    static osg::ref_ptr<PanoramaMap> map()
    {
        osg::ref_ptr<PanoramaMap> result = new PanoramaMap;
        result->setViewRadius(9000.0);
        result->setStrokeSize(10.0);
        return result;
    }
    PictureLayers::Options options(int tile, const osg::ref_ptr<NameSet>& set = nullptr) const
    {
        PictureLayers::Options result;
        result.size = {WIDTH, HEIGHT, 0.0};
        result.tile = tile;
        result.renderer = _drawing;
        result.names = set;
        return result;
    }
    void write(Effect* effect, const PictureLayers::Options& how)
    {
        std::string error;
        ASSERT_TRUE(PictureLayers::write(scene(effect), how, _view, folder(), error)) << error;
        std::ifstream stream(fs::path(folder()) / "layers.json");
        _json = nlohmann::json::parse(stream, nullptr, false);
        ASSERT_TRUE(_json.is_object());
        EXPECT_EQ(_json["width"], WIDTH);
    }
    Layer read(const std::string& file) const
    {
        OIIO::ImageSpec straight;
        straight.attribute("oiio:UnassociatedAlpha", 1);
        const auto input = OIIO::ImageInput::open((fs::path(folder()) / file).string(), &straight);
        EXPECT_TRUE(input) << file;
        Layer layer;
        if (!input) return layer;
        EXPECT_EQ(input->spec().width, WIDTH);
        EXPECT_EQ(input->spec().height, HEIGHT);
        layer.channels = input->spec().nchannels;
        layer.values.resize(static_cast<std::size_t>(WIDTH * HEIGHT * layer.channels));
        EXPECT_TRUE(input->read_image(0, 0, 0, layer.channels, OIIO::TypeDesc::DOUBLE, layer.values.data()));
        return layer;
    }
    bool has(const std::string& name) const
    {
        for (const auto& each : _json["layers"])
            if (each["name"] == name) return true;
        return false;
    }
    /// What the recipe in layers.json makes, 0…1.
    Layer putTogether() const
    {
        Layer made = read("sky.png");
        EXPECT_EQ(made.channels, 3);
        for (const auto& each : _json["layers"])
        {
            if (each["kind"] != "color" || each["name"] == "sky") continue;
            const Layer layer = read(each["file"]);
            EXPECT_EQ(layer.channels, 4);
            const Layer shade = each["name"] == "terrain" ? read("shade.tif") : Layer();
            for (int y = 0; y < HEIGHT; ++y)
            {
                for (int x = 0; x < WIDTH; ++x)
                {
                    const double opacity = layer.at(x, y, 3);
                    for (int i = 0; i < 3; ++i)
                    {
                        const double factor = shade.channels ? shade.at(x, y, i) : 1.0;
                        double& value = made.values[static_cast<std::size_t>(3 * (y * WIDTH + x) + i)];
                        value = (1.0 - opacity) * value + opacity * factor * layer.at(x, y, i);
                    }
                }
            }
        }
        return made;
    }
    void expectThePicture(const osg::Image& picture) const
    {
        const Layer made = putTogether();
        double most = 0.0;
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x)
                for (int i = 0; i < 3; ++i)
                    most =
                        std::max(most, std::abs(255.0 * made.at(x, y, i) -
                                                picture.data(static_cast<unsigned int>(x),
                                                             static_cast<unsigned int>(HEIGHT - 1 - y))[i]));
        EXPECT_LE(most, 2.0);
    }
    std::string folder() const { return (fs::path(_folder.path()) / "layers").string(); }

    nlohmann::json _json;
};

/// The shares of pixels in which a layer is opaque, and in which it is there at all.
osg::Vec2d coverOf(const Layer& layer)
{
    int opaque = 0, some = 0;
    for (int y = 0; y < HEIGHT; ++y)
    {
        for (int x = 0; x < WIDTH; ++x)
        {
            opaque += layer.at(x, y, 3) > 0.99 ? 1 : 0;
            some += layer.at(x, y, 3) > 0.01 ? 1 : 0;
        }
    }
    return osg::Vec2d(opaque, some) / (WIDTH * HEIGHT);
}

} // namespace

TEST_F(PictureLayersTest, OfAPanoramaMapAreThePictureWithItsNames)
{
    const osg::ref_ptr<PanoramaMap> effect = map();
    const osg::ref_ptr<osg::Image> expected = atOnce(effect, names());
    write(effect, options(4096, names()));
    expectThePicture(*expected);
    EXPECT_TRUE(_json["leftOut"].empty());
    for (const char* const name : {"sky", "terrain", "shade", "forest", "water", "strokes", "labels",
                                   "classes", "distance", "height", "lonlat"})
        EXPECT_TRUE(has(name)) << name;
    // Each is there in a part of the picture.
    const osg::Vec2d terrain = coverOf(read("terrain.png")), water = coverOf(read("water.png")),
                     forest = coverOf(read("forest.png")), strokes = coverOf(read("strokes.png")),
                     labels = coverOf(read("labels.png"));
    EXPECT_GT(terrain.x(), 0.5);
    EXPECT_LT(terrain.y(), 0.9);
    EXPECT_GT(water.y(), 0.02);
    EXPECT_LT(water.y(), 0.5);
    EXPECT_GT(forest.x(), 0.05);
    EXPECT_LT(forest.y(), 0.7);
    EXPECT_GT(strokes.x(), 0.01);
    EXPECT_LT(strokes.y(), 0.6);
    EXPECT_GT(labels.y(), 0.01);
    EXPECT_LT(labels.y(), 0.3);
    // In tiles they are the same: 180 and 120 are whole numbers of them.
    write(effect, options(90, names()));
    expectThePicture(*expected);
}

TEST_F(PictureLayersTest, WithSamplesEdgesAreThoseOfThePicture)
{
    _drawing.samples = 4;
    const osg::ref_ptr<PanoramaMap> effect = map();
    write(effect, options(4096));
    expectThePicture(*atOnce(effect, nullptr));
    ASSERT_FALSE(has("labels"));
    EXPECT_EQ(_json["leftOut"][0]["name"], "labels");
    // A class is a number and no mean of two, and ends where the ground does.
    const Layer classes = read("classes.png"), distance = read("distance.tif"), terrain = read("terrain.png");
    int soft = 0;
    for (int y = 0; y < HEIGHT; ++y)
    {
        for (int x = 0; x < WIDTH; ++x)
        {
            const long number = std::lround(255.0 * classes.at(x, y, 0));
            EXPECT_LE(number, 8);
            EXPECT_EQ(number == 0, std::isnan(distance.at(x, y, 0)));
            const double cover = terrain.at(x, y, 3);
            soft += cover > 0.1 && cover < 0.9 ? 1 : 0;
        }
    }
    EXPECT_GT(soft, 50) << "the skyline is smooth";
}

TEST_F(PictureLayersTest, HaveWhatTheyAreCalled)
{
    const osg::ref_ptr<PanoramaMap> effect = map();
    effect->setReflection(0.0);
    write(effect, options(4096));
    const Layer terrain = read("terrain.png"), forest = read("forest.png"), water = read("water.png"),
                shade = read("shade.tif"), classes = read("classes.png"), height = read("height.tif");
    // The plain at the hills' feet is lit as level ground is: there shade changes nothing but what the brush does.
    double lightest = 0.0, darkest = 10.0, sum = 0.0;
    int count = 0, woods = 0, lakes = 0;
    for (int y = 0; y < HEIGHT * 3 / 4; ++y)
    {
        for (int x = 0; x < WIDTH; ++x)
        {
            if (terrain.at(x, y, 3) < 1.0) continue;
            const int number = static_cast<int>(std::lround(255.0 * classes.at(x, y, 0)));
            // A brush strays a little, so borders are left out.
            if (number == 5)
            {
                ++woods;
                EXPECT_GT(forest.at(x, y, 3), 0.2);
            }
            if (number == 8)
            {
                ++lakes;
                EXPECT_GT(water.at(x, y, 3), 0.45);
                EXPECT_NEAR(height.at(x, y, 0), 0.0, 100.0);
            }
            else
            {
                EXPECT_LT(water.at(x, y, 3), 0.55);
            }
            const double factor = shade.at(x, y, 1);
            lightest = std::max(lightest, factor);
            darkest = std::min(darkest, factor);
            sum += factor;
            ++count;
        }
    }
    EXPECT_GT(woods, 600);
    EXPECT_GT(lakes, 60);
    EXPECT_GT(lightest, 1.1);
    EXPECT_LT(darkest, 0.8);
    EXPECT_NEAR(sum / count, 1.0, 0.2);
    // From the other side, light is the same for level ground: it changes the shade alone.
    effect->setLightAzimuth(-effect->getLightAzimuth());
    write(effect, options(4096));
    const Layer turned = read("terrain.png"), otherShade = read("shade.tif");
    int changed = 0;
    for (std::size_t i = 0; i < turned.values.size(); ++i)
        changed += std::abs(turned.values[i] - terrain.values[i]) > 1.5 / 255.0 ? 1 : 0;
    EXPECT_LT(changed, WIDTH * HEIGHT / 100);
    EXPECT_NE(otherShade.values, shade.values);
}

TEST_F(PictureLayersTest, OfOtherViewsAreTheirPictures)
{
    const osg::ref_ptr<BirdsEyeView> bird = new BirdsEyeView, idle = new BirdsEyeView;
    bird->setFocusLine(0.3);
    bird->setHorizonLine(0.85);
    // Where the horizon is in sight already, below its line, there is nothing to bend.
    idle->setFocusLine(0.3);
    idle->setHorizonLine(0.85);
    const osg::Matrixd down = _view,
                       level = _view * osg::Matrixd::rotate(osg::DegreesToRadians(-25.0), osg::X_AXIS);
    for (const osg::ref_ptr<Effect>& effect : std::vector<osg::ref_ptr<Effect>>{nullptr, bird, idle})
    {
        for (const unsigned int samples : sampledCases<unsigned int>({0u, 4u}, 2, effect == bird ? 1 : 0))
        {
            SCOPED_TRACE((effect ? effect->className() : "plain") + std::string(" ") +
                         std::to_string(samples));
            _drawing.samples = samples;
            _view = effect == idle ? level : down;
            write(effect, options(4096, names()));
            expectThePicture(*atOnce(effect, names()));
            for (const char* const name : {"forest", "water", "strokes", "classes"})
                EXPECT_FALSE(has(name)) << name;
            EXPECT_EQ(_json["leftOut"].size(), 4u);
            const Layer distance = read("distance.tif"), terrain = read("terrain.png");
            int wrong = 0;
            for (int y = 0; y < HEIGHT; ++y)
                for (int x = 0; x < WIDTH; ++x)
                    wrong += std::isnan(distance.at(x, y, 0)) == (terrain.at(x, y, 3) > 0.99) ? 1 : 0;
            EXPECT_LT(wrong, samples ? WIDTH * HEIGHT / 50 : 20) << "the ground is in the layer of terrain";
            EXPECT_TRUE(has("shade") && has("labels") && has("lonlat"));
        }
    }
}

// Values are those that a pick at the pixel tells: to half a pixel, with samples, too.
TEST_F(PictureLayersTest, PlacesAreThoseOfPicking)
{
    _drawing.samples = 4;
    const osg::ref_ptr<PanoramaMap> effect = map();
    write(effect, options(90));
    const Layer lonLat = read("lonlat.tif"), height = read("height.tif"), distance = read("distance.tif");
    EXPECT_EQ(lonLat.channels, 2);
    const Scene again = scene(effect);
    ASSERT_TRUE(again.reference) << again.referenceError;
    const DeformedView view(*again.effects, _view,
                            osg::Matrixd::perspective(40.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e6),
                            WIDTH, HEIGHT);
    Random random(5);
    int ground = 0, sky = 0, off = 0;
    for (int i = 0; i < 150; ++i)
    {
        const int x = random.integer(0, WIDTH - 1), y = random.integer(0, HEIGHT - 1);
        SCOPED_TRACE(std::to_string(x) + "," + std::to_string(y));
        const auto hit = view.pick(x + 0.5, HEIGHT - y - 0.5);
        if (std::isnan(lonLat.at(x, y, 0)))
        {
            EXPECT_TRUE(std::isnan(height.at(x, y, 0)));
            sky += hit ? 0 : 1;
            continue;
        }
        osg::Vec2d pixel;
        ASSERT_TRUE(view.project(osg::DegreesToRadians(lonLat.at(x, y, 0)),
                                 osg::DegreesToRadians(lonLat.at(x, y, 1)), height.at(x, y, 0),
                                 *again.reference, pixel));
        EXPECT_LT((pixel - osg::Vec2d(x + 0.5, HEIGHT - y - 0.5)).length(), 0.5);
        if (!hit) continue;
        ++ground;
        const double away = hit->deformed.length();
        const double perPixel = 2.0 * std::tan(osg::DegreesToRadians(20.0)) / HEIGHT * away;
        off += std::abs(distance.at(x, y, 0) - away) > perPixel ? 1 : 0;
    }
    EXPECT_GT(ground, 80);
    EXPECT_GT(sky, 5);
    EXPECT_LE(off, 1);
}

// What a program draws over its pictures is a layer, too.
TEST_F(PictureLayersTest, HaveOverlays)
{
    PictureLayers::Options how = options(64);
    const auto draw = [](osg::Image& rows, int top)
    {
        // Half red from row 50 to 99.
        for (int row = 0; row < rows.t(); ++row)
        {
            if (top + row < 50 || top + row > 99) continue;
            unsigned char* const bytes = rows.data(0, static_cast<unsigned int>(rows.t() - 1 - row));
            for (int x = 0; x < rows.s(); ++x)
                for (int i = 0; i < 3; ++i)
                    bytes[3 * x + i] =
                        static_cast<unsigned char>((bytes[3 * x + i] + (i == 0 ? 255 : 0)) / 2);
        }
    };
    how.overlays.push_back({"lines", "Red.", draw});
    write(nullptr, how);
    ASSERT_TRUE(has("lines"));
    osg::ref_ptr<osg::Image> expected = atOnce(nullptr, nullptr);
    draw(*expected, 0);
    expectThePicture(*expected);
    const Layer lines = read("lines.png");
    EXPECT_EQ(lines.at(10, 49, 3), 0.0);
    EXPECT_NEAR(lines.at(10, 50, 3), 0.5, 0.01);
    EXPECT_NEAR(lines.at(10, 99, 0), 1.0, 0.01);
    EXPECT_EQ(lines.at(10, 100, 3), 0.0);
    const std::string command = _json["command"];
    EXPECT_LT(command.find("lines.png"), command.find("terrain.png"));
}

TEST_F(PictureLayersTest, FaultsAreSentences)
{
    const std::string file = (fs::path(_folder.path()) / "file").string();
    std::ofstream(file) << "x";
    for (const std::string& wrong :
         {file, std::string("/proc/none"), file + "/below", folder() + "/none/none"})
    {
        std::string error;
        EXPECT_FALSE(PictureLayers::write(scene(nullptr), options(4096), _view, wrong, error));
        EXPECT_NE(error.find(wrong), std::string::npos) << error;
        EXPECT_EQ(error.back(), '.');
    }
}
