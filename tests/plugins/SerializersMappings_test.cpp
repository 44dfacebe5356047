// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What mappings have beside properties, through files and copies: layers, tables, and who shares what.
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <plugins/SerializerFixture.h>
#include <plugins/SerializerSamples.h>
#include <tools/RandomSamples.h>

#include <cmath>
#include <set>

namespace
{

using geofx::test::alter;
using geofx::test::byteImage;
using geofx::test::contentOf;
using geofx::test::expectSame;
using geofx::test::expectSameImage;
using geofx::test::expectSameTable;
using geofx::test::floatImage;
using geofx::test::formats;
using geofx::test::sampleTable;
using osgGeoFX::ColorTable;
using osgGeoFX::ColorTransfer;
using osgGeoFX::DataLayer;
using osgGeoFX::ProjectiveMapping;
using osgGeoFX::ProjectiveMappings;
using osgGeoFX::RouteMapping;
using SerializersMappings = geofx::test::Serializers;

void expectSameLayer(DataLayer* actual, DataLayer* expected)
{
    ASSERT_EQ(!actual, !expected);
    if (!expected) return;
    expectSame(*actual, *expected);
    expectSameImage(actual->getImage(), expected->getImage());
}

void expectSameMapping(ProjectiveMapping& actual, ProjectiveMapping& expected)
{
    EXPECT_EQ(actual.getName(), expected.getName());
    expectSame(actual, expected); // with the transfer, which is a part
    expectSameLayer(actual.getLayer(), expected.getLayer());
    expectSameLayer(actual.getMask(), expected.getMask());
    expectSameTable(actual.getTable(), expected.getTable());
}

void expectSameMappings(ProjectiveMappings& actual, ProjectiveMappings& expected)
{
    expectSame(actual, expected);
    ASSERT_EQ(actual.getNumMappings(), expected.getNumMappings());
    for (unsigned int i = 0; i < expected.getNumMappings(); ++i)
    {
        SCOPED_TRACE(i);
        expectSameMapping(*actual.getMapping(i), *expected.getMapping(i));
    }
}

osg::ref_ptr<ProjectiveMapping> fullMapping()
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setName("noise");
    mapping->setLayer(new DataLayer(byteImage()));
    alter(*mapping->getLayer());
    mapping->setMask(new DataLayer(floatImage()));
    mapping->setTable(sampleTable(13));
    mapping->getTable()->setName("decibels");
    alter(*mapping);
    return mapping;
}

/// Three mappings: the first two share all that can be shared, the last one has next to nothing.
osg::ref_ptr<ProjectiveMappings> threeMappings()
{
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    alter(*mappings);
    const osg::ref_ptr<ProjectiveMapping> first = fullMapping();
    const osg::ref_ptr<ProjectiveMapping> second = new ProjectiveMapping;
    second->setCenter({123.4567890123456789, -1e6 / 3.0});
    second->setLayer(first->getMask());
    second->setMask(first->getLayer());
    second->setTable(first->getTable());
    second->setTransfer(first->getTransfer());
    mappings->addMapping(first);
    mappings->addMapping(second);
    mappings->addMapping(new ProjectiveMapping);
    return mappings;
}

void expectShared(ProjectiveMappings& mappings)
{
    ASSERT_EQ(mappings.getNumMappings(), 3u);
    ProjectiveMapping& first = *mappings.getMapping(0);
    ProjectiveMapping& second = *mappings.getMapping(1);
    EXPECT_TRUE(first.getLayer());
    EXPECT_EQ(first.getLayer(), second.getMask());
    EXPECT_EQ(first.getMask(), second.getLayer());
    EXPECT_NE(first.getLayer(), first.getMask());
    EXPECT_EQ(first.getTable(), second.getTable());
    EXPECT_EQ(first.getTransfer(), second.getTransfer());
    EXPECT_NE(first.getTransfer(), mappings.getMapping(2)->getTransfer());
}

TEST_F(SerializersMappings, KeepColorTables)
{
    for (int seed = 0; seed < 84; ++seed)
    {
        const osg::ref_ptr<ColorTable> table = sampleTable(seed);
        for (const std::string& format : formats)
        {
            SCOPED_TRACE(std::to_string(seed) + " " + format);
            expectSameTable(throughFile(*table, format), table);
        }
        expectSameTable(osg::ref_ptr<ColorTable>(osg::clone(table.get(), osg::CopyOp::DEEP_COPY_ALL)), table);
    }
    for (const std::string& name : ColorTable::names())
    {
        const osg::ref_ptr<ColorTable> table = ColorTable::named(name, -20.0, 4200.0);
        for (const std::string& format : formats)
            expectSameTable(throughFile(*table, format), table);
    }
}

TEST_F(SerializersMappings, KeepLayersWithTheirPictures)
{
    for (const osg::ref_ptr<osg::Image>& image : {byteImage(), floatImage(), osg::ref_ptr<osg::Image>()})
    {
        const osg::ref_ptr<DataLayer> layer = new DataLayer(image);
        for (const std::string& format : formats)
        {
            SCOPED_TRACE(format);
            expectSameLayer(throughFile(*layer, format), layer);
        }
        const osg::ref_ptr<DataLayer> shallow = osg::clone(layer.get(), osg::CopyOp::SHALLOW_COPY);
        EXPECT_EQ(shallow->getImage(), image);
        const osg::ref_ptr<DataLayer> deep = osg::clone(layer.get(), osg::CopyOp::DEEP_COPY_ALL);
        expectSameLayer(deep, layer);
        EXPECT_EQ(deep->getImage() == image, !image);
    }
}

TEST_F(SerializersMappings, AMappingComesBackWithAllThatItHas)
{
    const osg::ref_ptr<ProjectiveMapping> mapping = fullMapping();
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<ProjectiveMapping> read = throughFile(*mapping, format);
        ASSERT_TRUE(read);
        expectSameMapping(*read, *mapping);
    }
    const osg::ref_ptr<ProjectiveMapping> shallow = osg::clone(mapping.get(), osg::CopyOp::SHALLOW_COPY);
    expectSameMapping(*shallow, *mapping);
    EXPECT_EQ(shallow->getLayer(), mapping->getLayer());
    EXPECT_EQ(shallow->getMask(), mapping->getMask());
    EXPECT_EQ(shallow->getTable(), mapping->getTable());
    EXPECT_EQ(shallow->getTransfer(), mapping->getTransfer());
    const osg::ref_ptr<ProjectiveMapping> deep = osg::clone(mapping.get(), osg::CopyOp::DEEP_COPY_ALL);
    expectSameMapping(*deep, *mapping);
    EXPECT_NE(deep->getLayer(), mapping->getLayer());
    EXPECT_NE(deep->getMask(), mapping->getMask());
    EXPECT_NE(deep->getTable(), mapping->getTable());
    EXPECT_NE(deep->getTransfer(), mapping->getTransfer());
}

TEST_F(SerializersMappings, MappingsComeBackInTheirOrderAndShareWhatTheyShared)
{
    const osg::ref_ptr<ProjectiveMappings> mappings = threeMappings();
    expectShared(*mappings);
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<ProjectiveMappings> read = throughFile(*mappings, format);
        ASSERT_TRUE(read);
        expectSameMappings(*read, *mappings);
        expectShared(*read);
    }
    const osg::ref_ptr<ProjectiveMappings> shallow = osg::clone(mappings.get(), osg::CopyOp::SHALLOW_COPY);
    expectSameMappings(*shallow, *mappings);
    EXPECT_EQ(shallow->getMapping(0), mappings->getMapping(0));
    const osg::ref_ptr<ProjectiveMappings> deep = osg::clone(mappings.get(), osg::CopyOp::DEEP_COPY_ALL);
    expectSameMappings(*deep, *mappings);
    EXPECT_NE(deep->getMapping(0), mappings->getMapping(0));
}

void expectSameRoute(RouteMapping& actual, RouteMapping& expected)
{
    EXPECT_EQ(actual.getName(), expected.getName());
    expectSame(actual, expected);
    EXPECT_EQ(actual.getWay().line, expected.getWay().line);
    EXPECT_EQ(actual.getWay().wayPoints, expected.getWay().wayPoints);
    EXPECT_EQ(actual.getWay().degrees, expected.getWay().degrees);
    expectSameLayer(actual.getPointLayer(), expected.getPointLayer());
    EXPECT_EQ(actual.getNumMappings(), expected.getNumMappings());
}

TEST_F(SerializersMappings, RoutesComeBackWithAllThatTheyHaveAndMakeTheirMappingsAnew)
{
    const osg::ref_ptr<ProjectiveMappings> mappings = threeMappings();
    mappings->setGeodeticOrigin(0.5, 0.7);
    const osg::EllipsoidModel earth;
    const osg::ref_ptr<RouteMapping> hike = new RouteMapping;
    mappings->addRoute(hike);
    hike->setName("a hike");
    alter(*hike);
    std::string error;
    ASSERT_TRUE(hike->setProperties({{"enabled", 1.0}, {"highlightedLeg", 1.0}}, error)) << error;
    ASSERT_TRUE(hike->setGeographicWayPoints({{27.1, 40.2}, {28.123456789012345, 40.0}, {33.0, 41.0}}, &earth,
                                             nullptr, error))
        << error;
    hike->setPointLayer(mappings->getMapping(0)->getLayer());
    const osg::ref_ptr<RouteMapping> plain = new RouteMapping;
    mappings->addRoute(plain);
    plain->setWayPoints({{0, 1.0 / 3.0}, {1000, 0}, {1000, 800}});
    mappings->addRoute(new RouteMapping);
    ASSERT_GT(hike->getNumMappings(), 10u);
    ASSERT_GT(hike->getWay().line.size(), 3u) << "legs of several strips";
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<ProjectiveMappings> read = throughFile(*mappings, format);
        ASSERT_TRUE(read);
        expectSameMappings(*read, *mappings);
        ASSERT_EQ(read->getNumRoutes(), 3u);
        for (unsigned int i = 0; i < 3; ++i)
            expectSameRoute(*read->getRoute(i), *mappings->getRoute(i));
        EXPECT_EQ(read->getRoute(0)->getPointLayer(), read->getMapping(0)->getLayer())
            << "one layer, as before";
        // It can be edited.
        EXPECT_TRUE(read->getRoute(1)->setWayPoints({{0, 0}, {50, 50}}));
        EXPECT_EQ(read->getRoute(1)->mappings(RouteMapping::POINTS).size(), 2u);
        // Mappings are not written: the files has three and no more.
        const std::string content = contentOf(_folder / ("object" + format));
        std::size_t count = 0;
        const std::string name = "osgGeoFX::ProjectiveMapping";
        for (std::size_t at = content.find(name); at != std::string::npos; at = content.find(name, at + 1))
            count += content.compare(at, name.size() + 1, name + "s") != 0;
        // In XML at the end, too.
        if (format != ".osgx")
        {
            EXPECT_EQ(count, 3u);
        }
    }
    // A file that somebody has spoilt has the rest.
    _watch.messagesOf(
        [&]
        {
            const auto spoilt =
                fromLines("osgGeoFX::RouteMapping", "  Dash 5\n  Way 2 0 {\n    0 0 1\n    6e7 0 1\n  }\n");
            ASSERT_TRUE(spoilt);
            const auto& route = dynamic_cast<RouteMapping&>(*spoilt);
            EXPECT_EQ(route.getStyle().dash, 5.0);
            EXPECT_TRUE(route.getWayPoints().empty());
        });
}

TEST_F(SerializersMappings, TwoEffectsMayHaveOneMapping)
{
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    const osg::ref_ptr<ProjectiveMappings> one = threeMappings();
    const osg::ref_ptr<ProjectiveMappings> other = new ProjectiveMappings;
    other->addMapping(one->getMapping(1));
    scene->addEffect(one);
    scene->addEffect(other);
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osgGeoFX::EffectScene> read = throughFile(*scene, format);
        ASSERT_TRUE(read);
        ASSERT_EQ(read->getNumEffects(), 2u);
        auto* first = dynamic_cast<ProjectiveMappings*>(read->getEffect(0));
        auto* second = dynamic_cast<ProjectiveMappings*>(read->getEffect(1));
        ASSERT_TRUE(first && second);
        expectShared(*first);
        ASSERT_EQ(second->getNumMappings(), 1u);
        EXPECT_EQ(second->getMapping(0), first->getMapping(1));
    }
}

TEST_F(SerializersMappings, AChangeOfWhatWasReadIsOneOfTheMapping)
{
    const osg::ref_ptr<ProjectiveMappings> read = throughFile(*threeMappings(), ".osgb");
    ASSERT_TRUE(read);
    ProjectiveMapping& mapping = *read->getMapping(0);
    const unsigned int before = mapping.revision();
    EXPECT_TRUE(mapping.getTransfer()->setBrightness(2.5));
    EXPECT_GT(mapping.revision(), before);
}

/// What an ASCII file with a table gives; what OSG has to say is in `said`.
osg::ref_ptr<ColorTable> tableFromText(const geofx::test::TempDir& folder, geofx::test::NotifyWatch& watch,
                                       const std::string& text, std::vector<std::string>& said)
{
    const auto file = folder.write("table.osgt", "#Ascii Object\n#Version 161\n#Generator OpenSceneGraph "
                                                 "3.6.5\n\nosgGeoFX::ColorTable {\n  UniqueID 1\n  Stops " +
                                                     text + "\n}\n");
    osg::ref_ptr<osg::Object> read;
    said = watch.messagesOf([&] { read = osgDB::readRefObjectFile(file.string()); });
    return dynamic_cast<ColorTable*>(read.get());
}

TEST_F(SerializersMappings, TablesOfAnotherHandAreTakenOrRefusedWithAWarning)
{
    std::vector<std::string> said;
    osg::ref_ptr<ColorTable> table =
        tableFromText(_folder, _watch, "STEPS 0 0 0 0.5 2 {\n 7 1 0 0 1\n -7 0 0 1 1\n}", said);
    ASSERT_TRUE(table);
    EXPECT_TRUE(said.empty()) << testing::PrintToString(said);
    ASSERT_EQ(table->getStops().size(), 2u);
    EXPECT_EQ(table->getStops()[0].value, -7.0) << "they are put into order";
    EXPECT_EQ(table->getMode(), ColorTable::STEPS);
    struct Wrong
    {
        const char* text;
        const char* named;
        std::size_t stops;
    };
    const Wrong all[] = {
        {"STAIRS 0 0 0 0 1 {\n 1 0 0 0 1\n}", "STAIRS", 1},
        {"LINEAR 0 0 0 0 1 {\n 1 0 x 0 1\n}", "\"x\"", 1},
        {"LINEAR 0 0 0 0 1 {\n inf 0 0 0 1\n}", "ColorTable", 0},
        {"LINEAR 0 0 0 0 1 {\n 1 0 0 7 1\n}", "ColorTable", 0},
        {"LINEAR 0 nan 0 0 1 {\n 1 0 0 0 1\n}", "ColorTable", 1},
    };
    for (const Wrong& wrong : all)
    {
        table = tableFromText(_folder, _watch, wrong.text, said);
        ASSERT_TRUE(table) << wrong.text;
        ASSERT_EQ(said.size(), 1u) << wrong.text << testing::PrintToString(said);
        EXPECT_NE(said[0].find("osgGeoFX: "), std::string::npos) << said[0];
        EXPECT_NE(said[0].find(wrong.named), std::string::npos) << said[0];
        EXPECT_EQ(table->getStops().size(), wrong.stops) << wrong.text;
    }
}

/// Whatever a damaged file gives keeps what its class promises.
void expectPromises(osg::Object* object)
{
    if (auto* holder = dynamic_cast<osgGeoFX::PropertyHolder*>(object))
    {
        for (const osgGeoFX::Property& property : holder->properties())
            EXPECT_EQ(property.refusal(property.get(*holder)), "");
        std::string error;
        EXPECT_TRUE(holder->setProperties({}, error)) << error;
    }
    if (auto* table = dynamic_cast<ColorTable*>(object))
    {
        for (const ColorTable::Stop& stop : table->getStops())
            EXPECT_TRUE(std::isfinite(stop.value) && stop.color.valid());
    }
    auto* mappings = dynamic_cast<ProjectiveMappings*>(object);
    for (unsigned int i = 0; mappings && i < mappings->getNumMappings(); ++i)
    {
        ProjectiveMapping* mapping = mappings->getMapping(i);
        ASSERT_TRUE(mapping && mapping->getTransfer());
        EXPECT_TRUE(mapping->outline());
        for (osg::Object* part :
             std::initializer_list<osg::Object*>{mapping, mapping->getLayer(), mapping->getMask(),
                                                 mapping->getTable(), mapping->getTransfer()})
            expectPromises(part);
    }
}

TEST_F(SerializersMappings, DamagedMappingsAreNoReasonToHangOrCrash)
{
    for (const std::string format : {".osgb", ".osgt"})
    {
        const osg::ref_ptr<ProjectiveMappings> mappings = threeMappings();
        // OSG hangs where a text file ends before a string. Where a binary file ends within an image, it takes whatever is in
        // memory for the image's size.
        mappings->getMapping(0)->getLayer()->setImage(nullptr);
        mappings->getMapping(0)->getMask()->setImage(nullptr);
        if (format == ".osgt")
        {
            mappings->getMapping(0)->setName("");
            mappings->getMapping(0)->getTable()->setName("");
        }
        const std::string file = (_folder / ("mappings" + format)).string();
        ASSERT_TRUE(osgDB::writeObjectFile(*mappings, file));
        const std::string whole = contentOf(file);
        const std::size_t step = geofx::test::fullTest() ? 1 : 23;
        // Behind what OSG itself reads first, where it may hang.
        for (std::size_t size = whole.find("osgGeoFX::ProjectiveMappings") + 40; size < whole.size();
             size += step)
        {
            SCOPED_TRACE(format + " " + std::to_string(size));
            osg::ref_ptr<osg::Object> read;
            _watch.messagesOf(
                [&] {
                    read = osgDB::readRefObjectFile(
                        _folder.write("cut" + format, whole.substr(0, size)).string());
                });
            expectPromises(read);
        }
    }
}

TEST_F(SerializersMappings, AreThereForEachClassThatOsgCouldWrite)
{
    // From the headers, so that no list has to be kept.
    std::set<std::string> classes;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(GEOFX_SOURCE_DIR "/osgGeoFX"))
    {
        if (entry.path().extension() != ".h") continue;
        const std::string text = contentOf(entry.path());
        for (const std::string macro : {"META_Object(osgGeoFX, ", "META_Node(osgGeoFX, "})
        {
            for (std::size_t at = text.find(macro); at != std::string::npos; at = text.find(macro, at + 1))
            {
                const std::size_t begin = at + macro.size();
                classes.insert(text.substr(begin, text.find(')', begin) - begin));
            }
        }
    }
    EXPECT_GE(classes.size(), 11u);
    auto* wrappers = osgDB::Registry::instance()->getObjectWrapperManager();
    for (const std::string& name : classes)
    {
        const osgDB::ObjectWrapper* wrapper = wrappers->findWrapper("osgGeoFX::" + name);
        ASSERT_TRUE(wrapper) << name << " has no wrapper in plugins/serializers";
        const osg::ref_ptr<osg::Object> object = wrapper->createInstance();
        ASSERT_TRUE(object) << name;
        // And each one with properties is in the tests of properties.
        const std::vector<std::string> kinds = osgGeoFX::propertyHolderKinds();
        const bool listed = std::find(kinds.begin(), kinds.end(), osgGeoFX::kindOf(*object)) != kinds.end();
        EXPECT_EQ(listed, dynamic_cast<osgGeoFX::PropertyHolder*>(object.get()) != nullptr) << name;
    }
}

} // namespace
