// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Layers in time and rasters that are larger than memory, through OSG's files: they go on where they were, and from their own files.
#include <osgGeoFX/geodata/SequenceRaster.h>
#include <osgGeoFX/geodata/TiledRaster.h>
#include <osgGeoFX/geodata/TiledVectors.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <plugins/SerializerFixture.h>
#include <tools/TestRasters.h>

#include <cmath>
#include <filesystem>
#include <limits>

namespace
{

using namespace osgGeoFX;
using geofx::test::formats;
using geofx::test::TestRaster;

osg::ref_ptr<osg::Image> numbers(float left, float right)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 1, 1, GL_RED, GL_FLOAT);
    image->setInternalTextureFormat(GL_R32F);
    reinterpret_cast<float*>(image->data())[0] = left;
    reinterpret_cast<float*>(image->data())[1] = right;
    return image;
}

float valueOf(LayerSequence& sequence, int texel)
{
    return reinterpret_cast<const float*>(sequence.getLayer()->getImage()->data())[texel];
}

class SerializersLayers : public geofx::test::Serializers
{
protected:
    /// A scene with one mapping of a sequence.
    static osg::ref_ptr<EffectScene> sceneOf(SequenceSteps* steps, double time)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
        const osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        const osg::ref_ptr<LayerSequence> sequence = new LayerSequence(steps);
        sequence->setBlending(false);
        mapping->setLayer(sequence->getLayer());
        effect->addMapping(mapping);
        scene->addEffect(effect);
        LayerPlayer* const player = LayerPlayer::onto(*scene);
        player->add(sequence, 20.0);
        player->getClock()->setPlaying(false);
        player->getClock()->setTime(time);
        sequence->setWaiting(true);
        player->update(0.0);
        return scene;
    }
    static ProjectiveMapping& mappingOf(EffectScene& scene)
    {
        return *dynamic_cast<ProjectiveMappings&>(*scene.getEffect(0)).getMapping(0);
    }
    /// A file of four bands, each with its number times ten and the column.
    std::string writeBands(int count = 4) const
    {
        TestRaster bands(8, 4, count, GDT_Float32);
        bands.placed(7.0, 45.0, 0.001, 0.001)
            .crs("EPSG:4326")
            .fill([](int column, int, int band) { return 10.0 * band + column; });
        const std::string file = (_folder / "bands.tif").string();
        bands.write(file);
        return file;
    }
};

} // namespace

TEST_F(SerializersLayers, ASequenceInMemoryGoesOnWhereItWas)
{
    const float none = std::numeric_limits<float>::quiet_NaN();
    const osg::ref_ptr<ImageSteps> steps =
        new ImageSteps({numbers(1.0f, none), numbers(3.0f, 4.0f), numbers(5.5f, 6.0f)},
                       {1768197600.25, 1768201200.0, 1768204800.0}, DataLayer::VALUE, true);
    const osg::ref_ptr<EffectScene> scene = sceneOf(steps, 1768202000.0);
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<EffectScene> read = throughFile(*scene, format);
        ASSERT_TRUE(read);
        LayerPlayer* const player = LayerPlayer::of(*read);
        ASSERT_TRUE(player);
        ASSERT_EQ(player->getNumSequences(), 1u);
        LayerSequence& sequence = *player->getSequence(0);
        EXPECT_EQ(sequence.getLayer(), mappingOf(*read).getLayer()) << "the layer that is shown";
        EXPECT_EQ(sequence.steps().times(), steps->times());
        EXPECT_TRUE(sequence.steps().dated());
        EXPECT_EQ(sequence.steps().kind(), DataLayer::VALUE);
        EXPECT_FALSE(sequence.getBlending());
        EXPECT_EQ(sequence.getClock(), player->getClock());
        EXPECT_EQ(player->getClock()->getTime(), 1768202000.0);
        EXPECT_EQ(player->getClock()->getSpeed(), LayerPlayer::of(*scene)->getClock()->getSpeed());
        EXPECT_FALSE(player->getClock()->getPlaying());
        sequence.setWaiting(true);
        player->update(0.0);
        EXPECT_EQ(valueOf(sequence, 0), 3.0f);
        player->getClock()->setTime(0.0);
        player->update(0.0);
        EXPECT_EQ(valueOf(sequence, 0), 1.0f);
        EXPECT_TRUE(std::isnan(valueOf(sequence, 1)));
    }
}

TEST_F(SerializersLayers, ASequenceOfAFileIsOpenedAgain)
{
    const std::string file = writeBands();
    MappingFrame frame;
    std::string error;
    const auto raster = SequenceRaster::open(file, frame, true, {"", 8}, error);
    ASSERT_TRUE(raster) << error;
    const osg::ref_ptr<EffectScene> scene = sceneOf(raster->steps, 2.0);
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<EffectScene> read = throughFile(*scene, format);
        LayerPlayer* const player = read ? LayerPlayer::of(*read) : nullptr;
        ASSERT_TRUE(player && player->getNumSequences() == 1u);
        LayerSequence& sequence = *player->getSequence(0);
        EXPECT_EQ(sequence.steps().source()->file, file);
        EXPECT_EQ(sequence.steps().times(), raster->steps->times());
        sequence.setWaiting(true);
        for (const std::size_t step : {0u, 3u})
        {
            player->getClock()->setTime(static_cast<double>(step));
            player->update(0.0);
            const osg::ref_ptr<osg::Image> expected = raster->steps->read(step, error);
            ASSERT_TRUE(expected);
            const osg::Image& image = *sequence.getLayer()->getImage();
            ASSERT_EQ(image.s(), expected->s());
            ASSERT_EQ(image.getTotalSizeInBytes(), expected->getTotalSizeInBytes());
            EXPECT_TRUE(
                std::equal(image.data(), image.data() + image.getTotalSizeInBytes(), expected->data()));
        }
    }
    // Without the file the layer keeps its picture.
    std::filesystem::remove(file);
    osg::ref_ptr<EffectScene> read;
    const std::vector<std::string> said = _watch.messagesOf([&] { read = throughFile(*scene, ".osgt"); });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("bands.tif"), std::string::npos) << said[0];
    ASSERT_TRUE(LayerPlayer::of(*read));
    EXPECT_EQ(LayerPlayer::of(*read)->getNumSequences(), 0u);
    EXPECT_EQ(mappingOf(*read).getLayer()->getImage()->s(), mappingOf(*scene).getLayer()->getImage()->s());
}

namespace
{

class OwnSteps : public SequenceSteps
{
public:
    const std::vector<double>& times() const override { return _times; }
    DataLayer::Kind kind() const override { return DataLayer::VALUE; }
    osg::ref_ptr<osg::Image> read(std::size_t, std::string&) override { return numbers(7.0f, 8.0f); }

protected:
    ~OwnSteps() override = default;

private:
    std::vector<double> _times = {0.0, 1.0};
};

} // namespace

TEST_F(SerializersLayers, StepsOfAProgramsOwnLeaveTheirPicture)
{
    const osg::ref_ptr<EffectScene> scene = sceneOf(new OwnSteps, 0.0);
    osg::ref_ptr<EffectScene> read;
    const std::vector<std::string> said = _watch.messagesOf([&] { read = throughFile(*scene, ".osgb"); });
    ASSERT_TRUE(read);
    EXPECT_LE(said.size(), 1u);
    EXPECT_EQ(reinterpret_cast<const float*>(mappingOf(*read).getLayer()->getImage()->data())[1], 8.0f);
    ASSERT_TRUE(LayerPlayer::of(*read));
    EXPECT_EQ(LayerPlayer::of(*read)->getNumSequences(), 0u);
}

TEST_F(SerializersLayers, APagedRasterIsOpenedAgainInItsPlace)
{
    const std::string file = writeBands(1);
    MappingFrame frame;
    std::string error;
    ASSERT_TRUE(MappingRaster::moveToMiddle(file, frame, error)) << error;
    PagedRaster::Options options;
    options.megabytes = 77;
    options.threads = 1;
    options.tilesPerFrame = 9;
    const osg::ref_ptr<PagedRaster> raster =
        PagedRaster::create(TiledRaster::open(file, frame, DataLayer::VALUE, error), options, error);
    ASSERT_TRUE(raster) << error;
    raster->getMapping()->setOpacity(0.25);
    raster->getMapping()->getTransfer()->setValueRange(-3.0, 33.0);
    const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
    effect->setLocalOrigin(frame.origin);
    effect->addMapping(new ProjectiveMapping);
    ASSERT_TRUE(effect->addRaster(raster));
    effect->addMapping(new ProjectiveMapping);
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<ProjectiveMappings> read = throughFile(*effect, format);
        ASSERT_TRUE(read);
        ASSERT_EQ(read->getNumMappings(), 3u);
        ASSERT_EQ(read->getNumRasters(), 1u);
        PagedRaster& back = *read->getRaster(0);
        EXPECT_EQ(back.getMapping(), read->getMapping(1)) << "it lies between the other two";
        EXPECT_EQ(back.getMapping()->getOpacity(), 0.25);
        EXPECT_EQ(back.getMapping()->getTransfer()->getHighValue(), 33.0);
        EXPECT_EQ(back.getOptions().megabytes, 77);
        EXPECT_EQ(back.getOptions().threads, 1);
        EXPECT_EQ(back.getOptions().tilesPerFrame, 9);
        EXPECT_EQ(back.tiles().source()->file, file);
        EXPECT_EQ(back.tiles().source()->kind, DataLayer::VALUE);
        EXPECT_EQ(back.tiles().low(), raster->tiles().low());
        EXPECT_TRUE(back.tileAt(raster->tiles().low() + osg::Vec2d(1.0, 1.0)).layer);
        EXPECT_FALSE(_watch.messagesOf([&] { EXPECT_FALSE(read->addRaster(&back)); }).empty()) << "twice";
    }
    std::filesystem::remove(file);
    osg::ref_ptr<ProjectiveMappings> read;
    const std::vector<std::string> said = _watch.messagesOf([&] { read = throughFile(*effect, ".osgb"); });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("bands.tif"), std::string::npos) << said[0];
    EXPECT_EQ(read->getNumRasters(), 0u);
    EXPECT_EQ(read->getNumMappings(), 3u) << "with its coarse picture";
    EXPECT_TRUE(read->getMapping(1)->getLayer()->getImage());
}

// What is shown of a picture's bands stays.
TEST_F(SerializersLayers, ThePicturesBandsAreThoseThatWereChosen)
{
    geofx::test::TestRaster picture(16, 16, 4, GDT_UInt16);
    picture.placed(7.0, 45.0, 0.001, 0.001)
        .crs("EPSG:4326")
        .fill([](int, int, int band) { return 100.0 * band; });
    const std::string file = picture.write(_folder / "picture.tif");
    RasterBands bands;
    bands.channels = {{{4, std::pair(0.0, 300.0)}, {3, std::pair(0.0, 400.0)}, {2, std::nullopt}}};
    MappingFrame frame;
    frame.origin = LocalOrigin::onGlobe(osg::DegreesToRadians(7.0), osg::DegreesToRadians(45.0));
    std::string error;
    for (const std::optional<DataLayer::Kind> kind :
         {std::optional(DataLayer::COLOR), std::optional<DataLayer::Kind>()})
    {
        osg::ref_ptr<RasterTiles> tiles;
        // The range of the third channel is told, once.
        _watch.messagesOf([&] { tiles = TiledRaster::open(file, frame, kind, error, bands); });
        ASSERT_TRUE(tiles) << error;
        const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
        effect->addRaster(PagedRaster::create(tiles, {}, error));
        for (const std::string& format : formats)
        {
            SCOPED_TRACE(format);
            const osg::ref_ptr<ProjectiveMappings> read = throughFile(*effect, format);
            ASSERT_TRUE(read);
            ASSERT_EQ(read->getNumRasters(), 1u);
            const PagedRaster& raster = *read->getRaster(0);
            const std::optional<LayerSource> source = raster.tiles().source();
            ASSERT_TRUE(source && source->bands);
            EXPECT_EQ(source->kind.has_value(), kind.has_value());
            for (std::size_t i = 0; i < 3; ++i)
            {
                EXPECT_EQ(source->bands->channels[i].band, bands.channels[i].band);
                EXPECT_EQ(source->bands->channels[i].range, bands.channels[i].range);
            }
            const osg::Image& coarse = *raster.getMapping()->getLayer()->getImage();
            const unsigned char* const texel = coarse.data(static_cast<unsigned int>(coarse.s() / 2),
                                                           static_cast<unsigned int>(coarse.t() / 2));
            EXPECT_EQ(texel[0], 255);
            EXPECT_EQ(texel[1], 128) << "200 of 400, of the third band";
        }
    }
}

// Areas of a file are drawn again from the file, by the same style.
TEST_F(SerializersLayers, VectorDataAreOpenedAgain)
{
    const std::string file = _folder.write(
        "areas.geojson",
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon",
"coordinates":[[[7,45],[7.01,45],[7.01,45.01],[7,45]]]}}]})");
    const std::string style = _folder.write(
        "look.sld",
        "<FeatureTypeStyle><Rule><PolygonSymbolizer><Fill><CssParameter name='fill'>#00ff00</CssParameter>"
        "</Fill></PolygonSymbolizer></Rule></FeatureTypeStyle>");
    std::string error;
    const std::optional<TiledVectors> vectors = TiledVectors::read(file, {"areas", style, false}, error);
    ASSERT_TRUE(vectors) << error;
    MappingFrame frame;
    frame.origin = LocalOrigin::onGlobe(osg::DegreesToRadians(7.0), osg::DegreesToRadians(45.0));
    const osg::ref_ptr<RasterTiles> tiles = vectors->tiles(frame, std::nullopt, error);
    ASSERT_TRUE(tiles) << error;
    const osg::ref_ptr<PagedRaster> raster = PagedRaster::create(tiles, {}, error);
    ASSERT_TRUE(raster) << error;
    const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
    effect->addRaster(raster);
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<ProjectiveMappings> read = throughFile(*effect, format);
        ASSERT_TRUE(read);
        ASSERT_EQ(read->getNumRasters(), 1u);
        const RasterTiles& back = read->getRaster(0)->tiles();
        EXPECT_EQ(back.low(), tiles->low());
        ASSERT_TRUE(back.source()->vectors);
        EXPECT_EQ(back.source()->vectors->style, style);
        EXPECT_EQ(back.source()->vectors->layer, "areas");
        const PagedRaster::Tile tile = read->getRaster(0)->tileAt({600.0, 300.0});
        ASSERT_TRUE(tile.layer);
        const osg::Image& image = *tile.layer->getImage();
        const osg::Vec2d share((600.0 - tile.low.x()) / (tile.high.x() - tile.low.x()),
                               (300.0 - tile.low.y()) / (tile.high.y() - tile.low.y()));
        const unsigned char* const texel = image.data(static_cast<unsigned int>(share.x() * image.s()),
                                                      static_cast<unsigned int>(share.y() * image.t()));
        EXPECT_EQ(texel[1], 255);
        EXPECT_EQ(texel[3], 255);
    }
}
