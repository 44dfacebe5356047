// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Rasters that are larger than memory: what is shown against the raster's own function, what is read, and within what memory.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/SceneData.h>
#include <tools/MappingStage.h>

#include <osg/CoordinateSystemNode>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

/// A raster of 131,072 x 131,072 pixels over 2 km: 68 GB. Its colors are smooth, so that each pixel's is known at any level.
class SmoothTiles : public RasterTiles
{
public:
    osg::Vec2d low() const override { return {-1000.0, -1000.0}; }
    osg::Vec2d high() const override { return {1000.0, 1000.0}; }
    double texel() const override { return 2000.0 / 131072.0; }
    DataLayer::Kind kind() const override { return DataLayer::COLOR; }
    osg::ref_ptr<osg::Image> read(const osg::Vec2d& from, const osg::Vec2d& to, int columns, int rows,
                                  std::string& error) override
    {
        const double side = (to - from).x();
        if (side < brokenBelow)
        {
            error = "ortho.tif: its pixels cannot be read; mend it.";
            return nullptr;
        }
        ++reads;
        texels += columns * rows;
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(columns, rows, 1, format, GL_UNSIGNED_BYTE);
        if (format != GL_RGBA) return image;
        for (int y = 0; y < rows; ++y)
        {
            for (int x = 0; x < columns; ++x)
            {
                const osg::Vec2d place(from.x() + (x + 0.5) / columns * (to.x() - from.x()),
                                       from.y() + (y + 0.5) / rows * (to.y() - from.y()));
                const osg::Vec3d color = colorAt(place);
                unsigned char* texel =
                    image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
                for (int c = 0; c < 3; ++c)
                    texel[c] = static_cast<unsigned char>(std::lround(255.0 * color[c]));
                texel[3] = std::abs(place.x()) <= 1000.0 && std::abs(place.y()) <= 1000.0 ? 255 : 0;
            }
        }
        return image;
    }
    /// Two waves of 40 m on a slope over all of it.
    static osg::Vec3d colorAt(const osg::Vec2d& place)
    {
        return {0.5 + 0.4 * std::sin(place.x() / 6.4), 0.5 + 0.4 * std::cos(place.y() / 6.4),
                0.5 + place.x() / 2500.0};
    }

    GLenum format = GL_RGBA;
    std::atomic<double> brokenBelow{0.0}; ///< tiles smaller than this cannot be read
    std::atomic<int> reads{0};
    std::atomic<std::int64_t> texels{0};

protected:
    ~SmoothTiles() override = default;
};

} // namespace

class PagedRasters : public MappingStage
{
protected:
    PagedRasters() : MappingStage(320, 240) {}

    void add(const PagedRaster::Options& options = {})
    {
        std::string error;
        _raster = PagedRaster::create(_tiles, options, error);
        ASSERT_TRUE(_raster) << error;
        ASSERT_TRUE(_mappings->addRaster(_raster));
    }
    osg::ref_ptr<osg::Image> drawSettled() { return MappingStage::drawSettled(*_raster); }
    /// How many pixels of ground are off from the raster's own color by more than some shades.
    int wrong(const osg::Image& image, double opacity = 1.0, double shades = 4.0, int top = 240)
    {
        const DeformedView view(*_scene, *viewer().getCamera());
        int off = 0;
        for (int y = 2; y < top; y += 5)
        {
            for (int x = 2; x < _width; x += 5)
            {
                const auto hit = view.pick(x + 0.5, y + 0.5);
                if (!hit || std::abs(hit->world.x()) > 990.0 || std::abs(hit->world.y()) > 990.0) continue;
                const osg::Vec3d color = SmoothTiles::colorAt({hit->world.x(), hit->world.y()}) * opacity +
                                         groundColor() * (1.0 - opacity);
                if (difference(at(image, x, y), color) > shades / 255.0) ++off;
            }
        }
        return off;
    }

    const osg::ref_ptr<SmoothTiles> _tiles = new SmoothTiles;
    osg::ref_ptr<PagedRaster> _raster;
};

TEST_F(PagedRasters, ShowThePixelsOfTheRasterAtAnyDistance)
{
    add();
    const int first = _tiles->reads;
    EXPECT_LE(first, 6);
    lookDown({0.0, 0.0}, 5.0);
    // The first picture is there at once, and coarse.
    EXPECT_LT(difference(at(*draw(), 160, 120), SmoothTiles::colorAt({2.5, 2.5})), 0.35);
    for (const double pixel : {0.5, 0.1, 0.02})
    {
        lookDown({123.0, -77.0}, pixel);
        EXPECT_EQ(wrong(*drawSettled()), 0) << pixel;
    }
    look({0.0, -300.0, 60.0}, {0.0, -100.0, 0.0});
    // Waves that are finer than pixels are averaged far away.
    const osg::ref_ptr<osg::Image> image = drawSettled();
    const DeformedView view(*_scene, *viewer().getCamera());
    for (const int y : {20, 60, 100})
    {
        const auto hit = view.pick(160.5, y + 0.5);
        ASSERT_TRUE(hit);
        const osg::Vec3d color = SmoothTiles::colorAt({hit->world.x(), hit->world.y()});
        EXPECT_LT(difference(at(*image, 160, y), color), 0.03) << y;
    }
    EXPECT_LT(_tiles->texels, std::int64_t{40000000}) << "of 17 billion";
    EXPECT_EQ(_raster->statistics().failed, 0);
    EXPECT_FALSE(_raster->statistics().coarser);
}

TEST_F(PagedRasters, TilesDoNotOverlapAndLeaveNoGap)
{
    add();
    // Where two lay over each other, or none, an opacity would be seen.
    _raster->getMapping()->setOpacity(0.5);
    lookDown({100.0, 50.0}, 0.3, 0.5);
    for (int i = 0; i < 60; ++i)
    {
        const osg::ref_ptr<osg::Image> image = draw();
        // Coarse tiles have other colors, but never more or less than half of them.
        for (int y = 1; y < _height; y += 3)
            for (int x = 1; x < _width; x += 3)
            {
                const double blue = at(*image, x, y).z();
                ASSERT_GT(blue, 0.5 * groundColor().z() + 0.5 * 0.08) << x << ", " << y;
                ASSERT_LT(blue, 0.5 * groundColor().z() + 0.5 * 0.95) << x << ", " << y;
            }
        if (i > 3 && _raster->statistics().settled) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EXPECT_EQ(wrong(*drawSettled(), 0.5), 0);
    // What is said of the mapping is said of all tiles, and they keep their texels.
    const std::uint64_t before = _mappings->capacity().uploadedBytes;
    _raster->getMapping()->setOpacity(0.25);
    EXPECT_EQ(wrong(*drawSettled(), 0.25), 0);
    EXPECT_LT(_mappings->capacity().uploadedBytes - before, 100000u);
    _raster->getMapping()->setEnabled(false);
    draw();
    EXPECT_LE(difference(at(*draw(), 160, 120), groundColor()), tolerance);
}

TEST_F(PagedRasters, SettleToTheSamePictureWhicheverWayTheCameraCame)
{
    add();
    lookDown({100.0, 50.0}, 0.3, 0.5);
    const osg::ref_ptr<osg::Image> straight = drawSettled();
    for (const double pixel : {3.0, 0.04})
    {
        lookDown({-300.0, 400.0}, pixel);
        drawSettled();
        lookDown({100.0, 50.0}, 0.3, 0.5);
        EXPECT_EQ(differing(*drawSettled(), *straight), 0);
    }
}

TEST_F(PagedRasters, KeepToTheirMemory)
{
    PagedRaster::Options options;
    options.megabytes = 32;
    add(options);
    for (int i = 0; i < 12; ++i)
    {
        lookDown({70.0 * i - 400.0, 30.0 * i - 200.0}, i % 2 == 0 ? 0.05 : 0.2);
        EXPECT_EQ(wrong(*drawSettled()), 0) << i;
        EXPECT_LE(_raster->statistics().megabytes, 32.0) << i;
    }
    EXPECT_FALSE(_raster->statistics().coarser);
    // A view along the ground needs more than that: all of it is coarser, and it settles.
    look({0.0, -900.0, 2.0}, {0.0, 0.0, 0.0});
    drawSettled();
    EXPECT_TRUE(_raster->statistics().coarser);
    EXPECT_LE(_raster->statistics().megabytes, 32.0);
}

TEST_F(PagedRasters, TilesThatCannotBeReadLeaveCoarseOnes)
{
    add();
    _tiles->brokenBelow = 100.0;
    lookDown({0.0, 0.0}, 0.05);
    osg::ref_ptr<osg::Image> image;
    const std::vector<std::string> said = watch().messagesOf([&] { image = drawSettled(); });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("ortho.tif: its pixels cannot be read; mend it."), std::string::npos) << said[0];
    EXPECT_GT(_raster->statistics().failed, 0);
    EXPECT_EQ(wrong(*image, 1.0, 12.0), 0) << "the finest one that can be read";
}

TEST_F(PagedRasters, TilesThatFailAreReadAgain)
{
    add();
    _tiles->brokenBelow = 100.0;
    lookDown({0.0, 0.0}, 0.05);
    watch().messagesOf([&] { drawSettled(); });
    EXPECT_GT(_raster->statistics().failed, 0);
    EXPECT_EQ(_raster->statistics().fault, "ortho.tif: its pixels cannot be read; mend it.");
    EXPECT_EQ(faultOfData(*_scene), _raster->statistics().fault);
    _tiles->brokenBelow = 0.0;
    for (int i = 0; i < 500 && _raster->statistics().failed > 0; ++i)
    {
        draw();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_EQ(_raster->statistics().failed, 0);
    EXPECT_EQ(wrong(*drawSettled()), 0);
    EXPECT_EQ(faultOfData(*_scene), "");
}

TEST_F(PagedRasters, FollowDeformations)
{
    add();
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    _scene->addEffect(bend);
    look({0.0, -600.0, 120.0}, {0.0, 0.0, 0.0});
    const osg::ref_ptr<osg::Image> image = drawSettled();
    // Farther away the waves are finer than pixels.
    EXPECT_EQ(wrong(*image, 1.0, 12.0, 60), 0);
    EXPECT_FALSE(_raster->statistics().coarser);
}

TEST_F(PagedRasters, ComeAndGo)
{
    add();
    lookDown({0.0, 0.0}, 0.3);
    const osg::ref_ptr<osg::Image> image = drawSettled();
    EXPECT_EQ(_mappings->getNumMappings(), 1u);
    EXPECT_EQ(_mappings->getNumRasters(), 1u);
    EXPECT_TRUE(_mappings->removeRaster(_raster));
    EXPECT_EQ(_mappings->getNumMappings(), 0u);
    EXPECT_LE(difference(at(*draw(), 160, 120), groundColor()), tolerance);
    EXPECT_TRUE(_mappings->addRaster(_raster));
    EXPECT_EQ(differing(*drawSettled(), *image), 0);
    EXPECT_EQ(watch().messagesOf([&] { EXPECT_FALSE(_mappings->addRaster(_raster)); }).size(), 1u);
    // Another mapping on top, and one below.
    const osg::ref_ptr<ProjectiveMapping> top = makeSolid({0.0, 0.0}, 10.0, {1.0, 0.0, 0.0});
    _mappings->addMapping(top);
    EXPECT_TRUE(alike(at(*drawSettled(), 160, 120), {1.0, 0.0, 0.0}));
    // New tiles come below it, too.
    _raster->getMapping()->setOpacity(0.99);
    EXPECT_TRUE(alike(at(*drawSettled(), 160, 120), {1.0, 0.0, 0.0}));
    _raster->getMapping()->setOpacity(1.0);
    top->setOrder(-1);
    EXPECT_LT(difference(at(*drawSettled(), 160, 120), SmoothTiles::colorAt({0.15, 0.15})), 6.0 / 255.0);
    _mappings->removeMappings();
    EXPECT_EQ(_mappings->getNumRasters(), 0u);
    EXPECT_LE(difference(at(*draw(), 160, 120), groundColor()), tolerance);
}

TEST_F(PagedRasters, TellWhetherAPictureHasAllThatItNeeds)
{
    EXPECT_TRUE(hasAllData(*_scene)) << "there is no raster";
    add();
    for (const double pixel : {0.3, 0.05})
    {
        lookDown({100.0 * pixel, 50.0}, pixel);
        draw();
        // The first frame of a view cannot have what it has just asked for.
        EXPECT_FALSE(hasAllData(*_scene)) << pixel;
        osg::ref_ptr<osg::Image> image;
        for (int i = 0; i < 2000 && !hasAllData(*_scene); ++i)
        {
            image = draw();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        ASSERT_TRUE(hasAllData(*_scene));
        EXPECT_EQ(wrong(*image), 0) << pixel;
    }
    lookDown({100.0, 50.0}, 0.05);
    _raster->getMapping()->setEnabled(false);
    draw();
    EXPECT_TRUE(hasAllData(*_scene)) << "it is not shown";
}

TEST_F(PagedRasters, AreComposedBeforehandLikeOtherMappings)
{
    add();
    _mappings->setCaching(ProjectiveMappings::AUTOMATIC);
    lookDown({40.0, 20.0}, 0.4);
    for (int i = 0; i < 300; ++i)
    {
        drawSettled();
        if (_mappings->cacheStatistics().settled && _mappings->cacheStatistics().reason.empty()) break;
    }
    EXPECT_EQ(_mappings->cacheStatistics().reason, "");
    EXPECT_EQ(wrong(*draw()), 0);
}

TEST_F(PagedRasters, OptionsOutOfRangeAreRefused)
{
    std::string error;
    PagedRaster::Options options;
    options.megabytes = 3;
    EXPECT_FALSE(PagedRaster::create(_tiles, options, error));
    EXPECT_EQ(error, "PagedRaster: megabytes must be 32 to 65536, not 3.");
    EXPECT_FALSE(PagedRaster::create(nullptr, {}, error));
    EXPECT_NE(error.find("covers no area"), std::string::npos);
    // A program's own tiles may be anything.
    _tiles->format = GL_RGB;
    EXPECT_FALSE(PagedRaster::create(_tiles, {}, error));
    EXPECT_NE(error.find("is not 256 x 256 pixels of GL_RGBA bytes"), std::string::npos) << error;
    _tiles->format = GL_RGBA;
    _tiles->brokenBelow = 1e9;
    EXPECT_FALSE(PagedRaster::create(_tiles, {}, error));
    EXPECT_NE(error.find("ortho.tif"), std::string::npos);
}
