// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What close-ups have beside properties, through files and copies: regions, anchors, tables, surface data, and who
// shares what.
#include <osgGeoFX/closeup/CloseUps.h>
#include <plugins/SerializerFixture.h>
#include <plugins/SerializerSamples.h>
#include <tools/RandomSamples.h>

namespace
{

using geofx::test::alter;
using geofx::test::byteImage;
using geofx::test::contentOf;
using geofx::test::expectSame;
using geofx::test::expectSameImage;
using geofx::test::expectSameTable;
using geofx::test::formats;
using geofx::test::Random;
using geofx::test::sampleTable;
using osgGeoFX::Anchor;
using osgGeoFX::CloseUp;
using osgGeoFX::CloseUps;
using osgGeoFX::PropertyHolder;
using osgGeoFX::RegionOfInterest;
using osgGeoFX::SurfaceData;
using SerializersCloseUps = geofx::test::Serializers;

constexpr SurfaceData::Kind allKinds[] = {SurfaceData::COLOR, SurfaceData::HEIGHT, SurfaceData::NORMAL,
                                          SurfaceData::SLOPE, SurfaceData::ASPECT, SurfaceData::OCCLUSION,
                                          SurfaceData::CLASS, SurfaceData::VALUE};

/// A layer of every kind, with all bits of its floats in use.
osg::ref_ptr<SurfaceData> fullData()
{
    osg::ref_ptr<SurfaceData> data = new SurfaceData;
    alter(*data);
    data->setName("the island");
    for (const SurfaceData::Kind kind : allKinds)
    {
        Random random(static_cast<std::uint64_t>(kind));
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(5, 3, 1, GL_RGBA, GL_FLOAT);
        for (unsigned int i = 0; i < image->getTotalSizeInBytes() / sizeof(float); ++i)
            reinterpret_cast<float*>(image->data())[i] = static_cast<float>(random.uniform(-1.0, 4000.0));
        EXPECT_TRUE(data->addLayer("a \"layer\" " + std::to_string(kind), kind, image));
    }
    return data;
}

/// The data are those that a file would have, whatever stood in the same place before.
void expectSameData(SurfaceData* actual, SurfaceData* expected)
{
    ASSERT_EQ(!actual, !expected);
    if (!expected) return;
    EXPECT_EQ(actual->getName(), expected->getName());
    expectSame(*actual, *expected);
    ASSERT_EQ(actual->getNumLayers(), expected->getNumLayers());
    for (int layer = 0; layer < expected->getNumLayers(); ++layer)
    {
        SCOPED_TRACE(layer);
        EXPECT_EQ(actual->getLayerName(layer), expected->getLayerName(layer));
        EXPECT_EQ(actual->getLayerKind(layer), expected->getLayerKind(layer));
        expectSameImage(actual->getLayerImage(layer), expected->getLayerImage(layer));
    }
}

void expectSameRegion(RegionOfInterest& actual, RegionOfInterest& expected)
{
    expectSame(actual, expected);
    EXPECT_EQ(actual.getOutline(), expected.getOutline());
    expectSameImage(actual.getImage(), expected.getImage());
    expectSameImage(actual.mask(), expected.mask());
}

void expectSameCloseUp(CloseUp& actual, CloseUp& expected)
{
    EXPECT_EQ(actual.getName(), expected.getName());
    expectSame(actual, expected); // with region and anchor, which are parts
    expectSameRegion(*actual.getRegion(), *expected.getRegion());
    EXPECT_EQ(actual.getAnchor()->getTable(), expected.getAnchor()->getTable());
    EXPECT_EQ(actual.getSurface(), expected.getSurface());
    expectSameTable(actual.getTable(), expected.getTable());
}

void expectSameCloseUps(CloseUps& actual, CloseUps& expected)
{
    expectSame(actual, expected);
    expectSameData(actual.getSurfaceData(), expected.getSurfaceData());
    ASSERT_EQ(actual.getNumCloseUps(), expected.getNumCloseUps());
    for (unsigned int i = 0; i < expected.getNumCloseUps(); ++i)
    {
        SCOPED_TRACE(i);
        expectSameCloseUp(*actual.getCloseUp(i), *expected.getCloseUp(i));
    }
}

osg::ref_ptr<CloseUp> fullCloseUp()
{
    osg::ref_ptr<CloseUp> closeUp = new CloseUp;
    closeUp->setName("Diamond Head");
    alter(*closeUp);
    RegionOfInterest& region = *closeUp->getRegion();
    EXPECT_TRUE(region.setMaskSide(32));
    EXPECT_TRUE(region.setOutline({{-1.0, -1.0 / 3.0}, {0.9, -1.0}, {1.0, 2.0 / 3.0}, {0.0, 0.1}}));
    EXPECT_TRUE(region.setImage(byteImage()));
    EXPECT_TRUE(closeUp->getAnchor()->setTable({0.1f, 1.0f / 3.0f, 1.0f, 0.0f}));
    closeUp->setSurface("the \"slope\" in degrees");
    closeUp->setTable(sampleTable(13));
    return closeUp;
}

/// Three close-ups: the first two share all that can be shared, the last one has next to nothing.
osg::ref_ptr<CloseUps> threeCloseUps()
{
    osg::ref_ptr<CloseUps> closeUps = new CloseUps;
    alter(*closeUps);
    closeUps->setSurfaceData(fullData());
    const osg::ref_ptr<CloseUp> first = fullCloseUp();
    const osg::ref_ptr<CloseUp> second = new CloseUp;
    second->setOffset({123.4567890123456789, -1e6 / 3.0, 0.0});
    second->setRegion(first->getRegion());
    second->setAnchor(first->getAnchor());
    second->setTable(first->getTable());
    closeUps->addCloseUp(first);
    closeUps->addCloseUp(second);
    closeUps->addCloseUp(new CloseUp);
    return closeUps;
}

void expectShared(CloseUps& closeUps)
{
    ASSERT_EQ(closeUps.getNumCloseUps(), 3u);
    CloseUp& first = *closeUps.getCloseUp(0);
    CloseUp& second = *closeUps.getCloseUp(1);
    CloseUp& third = *closeUps.getCloseUp(2);
    EXPECT_EQ(first.getRegion(), second.getRegion());
    EXPECT_EQ(first.getAnchor(), second.getAnchor());
    EXPECT_TRUE(first.getTable());
    EXPECT_EQ(first.getTable(), second.getTable());
    EXPECT_NE(first.getRegion(), third.getRegion());
    EXPECT_NE(first.getAnchor(), third.getAnchor());
    EXPECT_FALSE(third.getTable());
}

TEST_F(SerializersCloseUps, KeepAnchorsWithAnyStyleAndTable)
{
    for (int style = Anchor::SOLID; style <= Anchor::TABLE; ++style)
    {
        for (const bool own : {false, true})
        {
            const osg::ref_ptr<Anchor> anchor = new Anchor;
            if (own) anchor->setTable({0.0f, 0.7f, 1.0f / 3.0f});
            // A table stays beside a style that does not use it.
            anchor->setStyle(static_cast<Anchor::Style>(style));
            for (const std::string& format : formats)
            {
                SCOPED_TRACE(std::to_string(style) + (own ? " own " : " ") + format);
                const osg::ref_ptr<Anchor> read = throughFile(*anchor, format);
                ASSERT_TRUE(read);
                expectSame(*read, *anchor);
                EXPECT_EQ(read->getTable(), anchor->getTable());
            }
            const osg::ref_ptr<Anchor> clone = osg::clone(anchor.get(), osg::CopyOp::DEEP_COPY_ALL);
            expectSame(*clone, *anchor);
            EXPECT_EQ(clone->getTable(), anchor->getTable());
        }
    }
}

TEST_F(SerializersCloseUps, KeepSurfaceDataToTheLastBit)
{
    const osg::ref_ptr<SurfaceData> full = fullData();
    for (const osg::ref_ptr<SurfaceData>& data : {full, osg::ref_ptr<SurfaceData>(new SurfaceData)})
    {
        for (const std::string& format : formats)
        {
            SCOPED_TRACE(format);
            expectSameData(throughFile(*data, format), data);
        }
    }
    const osg::ref_ptr<SurfaceData> shallow = osg::clone(full.get(), osg::CopyOp::SHALLOW_COPY);
    expectSameData(shallow, full);
    EXPECT_EQ(shallow->getLayerImage(0), full->getLayerImage(0));
    const osg::ref_ptr<SurfaceData> deep = osg::clone(full.get(), osg::CopyOp::DEEP_COPY_ALL);
    expectSameData(deep, full);
    EXPECT_NE(deep->getLayerImage(0), full->getLayerImage(0));
}

TEST_F(SerializersCloseUps, ACloseUpComesBackWithAllThatItHas)
{
    const osg::ref_ptr<CloseUp> closeUp = fullCloseUp();
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<CloseUp> read = throughFile(*closeUp, format);
        ASSERT_TRUE(read);
        expectSameCloseUp(*read, *closeUp);
    }
    const osg::ref_ptr<CloseUp> shallow = osg::clone(closeUp.get(), osg::CopyOp::SHALLOW_COPY);
    expectSameCloseUp(*shallow, *closeUp);
    EXPECT_EQ(shallow->getRegion(), closeUp->getRegion());
    EXPECT_EQ(shallow->getAnchor(), closeUp->getAnchor());
    EXPECT_EQ(shallow->getTable(), closeUp->getTable());
    const osg::ref_ptr<CloseUp> deep = osg::clone(closeUp.get(), osg::CopyOp::DEEP_COPY_ALL);
    expectSameCloseUp(*deep, *closeUp);
    EXPECT_NE(deep->getRegion(), closeUp->getRegion());
    EXPECT_NE(deep->getAnchor(), closeUp->getAnchor());
    EXPECT_NE(deep->getTable(), closeUp->getTable());
}

TEST_F(SerializersCloseUps, CloseUpsComeBackInTheirOrderAndShareWhatTheyShared)
{
    const osg::ref_ptr<CloseUps> closeUps = threeCloseUps();
    expectShared(*closeUps);
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<CloseUps> read = throughFile(*closeUps, format);
        ASSERT_TRUE(read);
        expectSameCloseUps(*read, *closeUps);
        expectShared(*read);
    }
    const osg::ref_ptr<CloseUps> shallow = osg::clone(closeUps.get(), osg::CopyOp::SHALLOW_COPY);
    expectSameCloseUps(*shallow, *closeUps);
    EXPECT_EQ(shallow->getCloseUp(0), closeUps->getCloseUp(0));
    EXPECT_EQ(shallow->getSurfaceData(), closeUps->getSurfaceData());
    const osg::ref_ptr<CloseUps> deep = osg::clone(closeUps.get(), osg::CopyOp::DEEP_COPY_ALL);
    expectSameCloseUps(*deep, *closeUps);
    EXPECT_NE(deep->getCloseUp(0), closeUps->getCloseUp(0));
    EXPECT_NE(deep->getSurfaceData(), closeUps->getSurfaceData());
}

TEST_F(SerializersCloseUps, TwoEffectsMayHaveOneCloseUpAndOneSetOfData)
{
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    const osg::ref_ptr<CloseUps> one = threeCloseUps();
    const osg::ref_ptr<CloseUps> other = new CloseUps;
    other->addCloseUp(one->getCloseUp(1));
    other->setSurfaceData(one->getSurfaceData());
    scene->addEffect(one);
    scene->addEffect(other);
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osgGeoFX::EffectScene> read = throughFile(*scene, format);
        ASSERT_TRUE(read);
        ASSERT_EQ(read->getNumEffects(), 2u);
        auto* first = dynamic_cast<CloseUps*>(read->getEffect(0));
        auto* second = dynamic_cast<CloseUps*>(read->getEffect(1));
        ASSERT_TRUE(first && second);
        expectShared(*first);
        ASSERT_EQ(second->getNumCloseUps(), 1u);
        EXPECT_EQ(second->getCloseUp(0), first->getCloseUp(1));
        EXPECT_EQ(second->getSurfaceData(), first->getSurfaceData());
    }
}

TEST_F(SerializersCloseUps, AChangeOfWhatWasReadIsOneOfTheCloseUp)
{
    const osg::ref_ptr<CloseUps> read = throughFile(*threeCloseUps(), ".osgb");
    ASSERT_TRUE(read);
    CloseUp& closeUp = *read->getCloseUp(0);
    unsigned int before = closeUp.revision();
    EXPECT_TRUE(closeUp.getRegion()->setBaseHeight(12.5));
    EXPECT_GT(closeUp.revision(), before);
    before = closeUp.revision();
    EXPECT_TRUE(closeUp.getAnchor()->setOpacity(0.25));
    EXPECT_GT(closeUp.revision(), before);
}

TEST_F(SerializersCloseUps, PartsCannotBeTakenAway)
{
    const osg::ref_ptr<CloseUp> closeUp = new CloseUp;
    const auto said = _watch.messagesOf(
        [&]
        {
            EXPECT_FALSE(closeUp->setRegion(nullptr));
            EXPECT_FALSE(closeUp->setAnchor(nullptr));
        });
    EXPECT_EQ(said.size(), 2u);
    EXPECT_TRUE(closeUp->getRegion() && closeUp->getAnchor());
}

/// Lines of a file by another hand, and what comes of them.
struct Lines
{
    const char* kind;
    const char* text;
    std::vector<const char*> named; ///< in the warnings, one each
};

TEST_F(SerializersCloseUps, FilesOfAnotherHandAreTakenOrRefusedWithAWarning)
{
    const Lines all[] = {
        {"Anchor", "  Table 2 {\n 0.25 0.5\n  }\n", {}},
        {"Anchor", "  Table 2 {\n 0.25 x\n  }\n", {"\"x\""}},
        {"Anchor", "  Table 2 {\n 0.25 1.5\n  }\n", {"0 to 1"}},
        {"Anchor", "  Table 2 {\n nan 1\n  }\n", {"0 to 1"}},
        {"Anchor", "  Table 1 {\n 1\n  }\n", {"2 to 256"}},
        {"Anchor", "  Table 0 {\n  }\n", {"2 to 256"}},
        {"RegionOfInterest", "  Outline 6 {\n -1 -1 1 -1 1 1\n  }\n", {}},
        {"RegionOfInterest", "  Outline 6 {\n -1 -1 1 -1 1 1.5\n  }\n", {"within -1 to 1"}},
        {"RegionOfInterest", "  Outline 6 {\n -1 -1 1 -1 1 inf\n  }\n", {"within -1 to 1"}},
        {"RegionOfInterest", "  Outline 5 {\n -1 -1 1 -1 1\n  }\n", {"x and y"}},
        {"RegionOfInterest", "  Outline 6 {\n 0 0 1 1 0.5 0.5\n  }\n", {"area"}},
        {"RegionOfInterest", "  Outline 0 {\n  }\n", {"three corners"}},
        {"RegionOfInterest", "  Shape circle\n  Points 2\n", {"shape", "points"}},
        {"SurfaceData", "  HighX -2000\n", {"low corner"}},
        {"CloseUp", "  ScaleX 0\n", {"scaleX"}},
        {"CloseUps", "  MaskUnit 12\n", {}},
        {"CloseUps", "  MaskUnit 12\n  TableUnit 12\n", {"must differ"}},
    };
    for (const Lines& lines : all)
    {
        osg::ref_ptr<PropertyHolder> read;
        const std::vector<std::string> said =
            _watch.messagesOf([&] { read = fromLines(std::string("osgGeoFX::") + lines.kind, lines.text); });
        ASSERT_TRUE(read) << lines.text;
        ASSERT_EQ(said.size(), lines.named.size()) << lines.text << testing::PrintToString(said);
        for (std::size_t i = 0; i < said.size(); ++i)
        {
            EXPECT_NE(said[i].find("osgGeoFX: "), std::string::npos) << said[i];
            EXPECT_NE(said[i].find(lines.named[i]), std::string::npos) << said[i];
        }
        if (const auto* anchor = dynamic_cast<const Anchor*>(read.get()))
        {
            // A number that is none is 0, and the table is taken.
            const bool taken = said.empty() || lines.named[0] == std::string("\"x\"");
            EXPECT_EQ(anchor->getStyle(), Anchor::FALLING) << "as the file has it";
            EXPECT_EQ(anchor->getTable().front(), taken ? 0.25f : 1.0f) << lines.text;
        }
        if (const auto* region = dynamic_cast<const RegionOfInterest*>(read.get()))
        {
            EXPECT_EQ(region->getOutline().size(), said.empty() ? 3u : 4u) << lines.text;
        }
    }
}

TEST_F(SerializersCloseUps, LayersThatCannotBeAreLeftOut)
{
    const std::string file = (_folder / "data.osgt").string();
    ASSERT_TRUE(osgDB::writeObjectFile(*fullData(), file));
    const std::string whole = contentOf(file);
    const auto readWith =
        [&](const std::string& word, const std::string& other, std::vector<std::string>& said)
    {
        std::string text = whole;
        const std::size_t at = text.find(word);
        EXPECT_NE(at, std::string::npos) << word;
        text.replace(at, word.size(), other);
        osg::ref_ptr<osg::Object> read;
        said = _watch.messagesOf(
            [&] { read = osgDB::readRefObjectFile(_folder.write("wrong.osgt", text).string()); });
        return osg::ref_ptr<SurfaceData>(dynamic_cast<SurfaceData*>(read.get()));
    };
    std::vector<std::string> said;
    const osg::ref_ptr<SurfaceData> unknown = readWith("ASPECT ", "ASPIC ", said);
    ASSERT_TRUE(unknown);
    EXPECT_EQ(unknown->getNumLayers(), 7);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("ASPIC"), std::string::npos) << said[0];
    const osg::ref_ptr<SurfaceData> twice = readWith("layer\\\" 3", "layer\\\" 2", said);
    ASSERT_TRUE(twice);
    EXPECT_EQ(twice->getNumLayers(), 7);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("there is one of that name"), std::string::npos) << said[0];
}

/// Whatever a damaged file gives keeps what its class promises.
void expectPromises(PropertyHolder* holder)
{
    if (!holder) return;
    for (const osgGeoFX::Property& property : holder->properties())
        EXPECT_EQ(property.refusal(property.get(*holder)), "");
    std::string error;
    EXPECT_TRUE(holder->setProperties({}, error)) << error;
    for (const PropertyHolder::Part& part : holder->parts())
        expectPromises(part.object);
    auto* closeUps = dynamic_cast<CloseUps*>(holder);
    for (unsigned int i = 0; closeUps && i < closeUps->getNumCloseUps(); ++i)
    {
        CloseUp* closeUp = closeUps->getCloseUp(i);
        ASSERT_TRUE(closeUp);
        expectPromises(closeUp);
        EXPECT_TRUE(closeUp->getRegion()->mask());
        EXPECT_GE(closeUp->getAnchor()->getTable().size(), 2u);
    }
    if (closeUps) expectPromises(closeUps->getSurfaceData());
    auto* data = dynamic_cast<SurfaceData*>(holder);
    for (int i = 0; data && i < data->getNumLayers(); ++i)
        EXPECT_TRUE(data->getLayerImage(i) && data->getLayerImage(i)->s() == data->getWidth());
}

TEST_F(SerializersCloseUps, DamagedCloseUpsAreNoReasonToHangOrCrash)
{
    for (const std::string format : {".osgb", ".osgt"})
    {
        const osg::ref_ptr<CloseUps> closeUps = threeCloseUps();
        // OSG hangs where a text file ends before a string. Where a binary file ends within an image, it takes whatever is in
        // memory for the image's size.
        closeUps->getCloseUp(0)->getRegion()->setImage(nullptr);
        closeUps->setSurfaceData(nullptr);
        if (format == ".osgt")
        {
            closeUps->getCloseUp(0)->setName("");
            closeUps->getCloseUp(0)->setSurface("");
        }
        const std::string file = (_folder / ("closeUps" + format)).string();
        ASSERT_TRUE(osgDB::writeObjectFile(*closeUps, file));
        const std::string whole = contentOf(file);
        const std::size_t step = geofx::test::fullTest() ? 1 : 23;
        // Behind what OSG itself reads first, where it may hang.
        for (std::size_t size = whole.find("osgGeoFX::CloseUps") + 40; size < whole.size(); size += step)
        {
            SCOPED_TRACE(format + " " + std::to_string(size));
            osg::ref_ptr<osg::Object> read;
            _watch.messagesOf(
                [&] {
                    read = osgDB::readRefObjectFile(
                        _folder.write("cut" + format, whole.substr(0, size)).string());
                });
            expectPromises(dynamic_cast<PropertyHolder*>(read.get()));
        }
    }
}

} // namespace
