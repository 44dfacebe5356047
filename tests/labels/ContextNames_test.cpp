// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Names in the context of a bend: all of them, or landmarks alone.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/map/MapContents.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

using namespace osgGeoFX;

namespace
{

MapName nameOf(const std::string& text, double importance, double ahead, double across)
{
    MapName name;
    name.text = text;
    name.importance = importance;
    name.places = {{across, ahead, 0.0}};
    return name;
}

/// Names before a pedestrian's view whose zone begins 400 m ahead and ends at 800 m.
class ContextNames : public ::testing::Test
{
protected:
    ContextNames()
    {
        const osg::ref_ptr<PedestrianView> bend = new PedestrianView;
        bend->setFocusDistance(400.0);
        bend->setZoneWidth(400.0);
        bend->setBendAngle(0.5);
        bend->setTallest(0.0);
        scene->addEffect(bend);
        camera->setViewport(0, 0, 800, 600);
        camera->setProjectionMatrixAsPerspective(60.0, 4.0 / 3.0, 1.0, 1e5);
        camera->setViewMatrixAsLookAt({0.0, 0.0, 150.0}, {0.0, 500.0, 80.0}, {0.0, 0.0, 1.0});
    }
    static std::vector<MapName> names()
    {
        std::vector<MapName> all = {
            nameOf("Near inn", 1.0, 300.0, -60.0),     nameOf("Middle inn", 2.0, 560.0, -150.0),
            nameOf("Beyond inn", 2.0, 640.0, 250.0),   nameOf("Far inn", 3.0, 1200.0, -500.0),
            nameOf("Far summit", 90.0, 1300.0, 300.0), nameOf("Nobody knows", NAN, 1250.0, 0.0),
            nameOf("Near unknown", NAN, 250.0, 100.0)};
        MapName ridge;
        ridge.text = "Far ridge";
        ridge.kind = MapName::LINE;
        ridge.importance = 5.0;
        for (int i = 0; i <= 20; ++i)
            ridge.places.emplace_back(-400.0 + 40.0 * i, 1000.0, 0.0);
        all.push_back(ridge);
        return all;
    }
    std::set<std::string> placed(NameSet& set)
    {
        std::set<std::string> texts;
        const LabelPicture picture(set, *scene, *camera, {});
        for (const LabelPicture::Name& each : picture.placed())
            texts.insert(set.names()[each.name].text);
        return texts;
    }

    const std::set<std::string> all = {"Near inn",   "Middle inn",   "Beyond inn",   "Far inn",
                                       "Far summit", "Nobody knows", "Near unknown", "Far ridge"};
    osg::ref_ptr<EffectScene> scene = new EffectScene;
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
};

} // namespace

TEST_F(ContextNames, AreThoseOfLandmarksIfSoWished)
{
    const osg::ref_ptr<NameSet> set = new NameSet(names());
    EXPECT_EQ(placed(*set), all);
    set->setContextImportance(60.0);
    // The zone's middle is the border: 600 m ahead.
    EXPECT_EQ(placed(*set), (std::set<std::string>{"Near inn", "Middle inn", "Far summit", "Near unknown"}));
    set->setContextImportance(4.0);
    EXPECT_EQ(placed(*set),
              (std::set<std::string>{"Near inn", "Middle inn", "Far summit", "Near unknown", "Far ridge"}));
    // Without a bend there is no context.
    scene->removeEffect(scene->getEffect(0));
    EXPECT_EQ(placed(*set).count("Far inn"), 1u);
    EXPECT_EQ(placed(*set).count("Nobody knows"), 1u);
}

TEST_F(ContextNames, ThoseLeftOutTakeNoNumberFromOthers)
{
    std::vector<MapName> many;
    for (int i = 0; i < 50; ++i)
        many.push_back(nameOf("Far " + std::to_string(i), 50.0, 1100.0 + i, 4.0 * i));
    many.push_back(nameOf("Near", 1.0, 300.0, 0.0));
    const osg::ref_ptr<NameSet> set = new NameSet(many);
    const auto inPicture = [&]
    {
        return set->inPicture(*scene, camera->getViewMatrix(), camera->getProjectionMatrix(), 800.0, 600.0,
                              40);
    };
    EXPECT_EQ(inPicture().size(), 40u);
    set->setContextImportance(60.0);
    const std::vector<NameSet::Seen> seen = inPicture();
    ASSERT_EQ(seen.size(), 51u);
    EXPECT_EQ(std::count_if(seen.begin(), seen.end(), [](const auto& each) { return each.label.visible; }),
              1);
    EXPECT_EQ(set->names()[seen.back().name].text, "Near");
}

TEST_F(ContextNames, AreSaidByAStyleFile)
{
    geofx::test::TempDir folder;
    const auto write = [&](const std::string& text)
    {
        const std::string file = (folder.path() / "style.json").string();
        std::ofstream(file) << text;
        return file;
    };
    MapContents contents;
    contents.names = names();
    const std::string before = contents.digest();
    std::string error;
    ASSERT_TRUE(contents.styles.read(write("{\"contextImportance\": 60}"), error)) << error;
    EXPECT_EQ(contents.styles.contextImportance, 60.0);
    EXPECT_NE(contents.digest(), before) << "prints that are not finished must not go on with others";
    EXPECT_EQ(contents.makeNames()->getContextImportance(), 60.0);
    // A scene that is shown keeps it when names are taken out and others are added.
    const osg::ref_ptr<osg::Node> shown = contents.addTo(*scene, *scene);
    EXPECT_EQ(MapContents::take(*shown).styles.contextImportance, 60.0);
    MapStyles styles;
    EXPECT_FALSE(styles.read(write("{\"contextImportance\": \"high\"}"), error));
    EXPECT_NE(error.find("must be a number"), std::string::npos) << error;
    EXPECT_EQ(styles.contextImportance, -HUGE_VAL);
}
