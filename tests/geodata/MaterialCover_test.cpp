// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What lies on the ground of other engines, by the names of their materials.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/MaterialLegend.h>
#include <tools/NotifyWatch.h>

#include <gtest/gtest.h>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/Material>
#include <osg/PagedLOD>

#include <cmath>
#include <optional>

using namespace osgGeoFX;

namespace
{

/// What a node's own texture says of the ground; nothing where it has none.
std::optional<glsl::geofx_Cover> coverOf(const osg::Node& node, unsigned int unit = 7)
{
    const osg::StateSet* state = node.getStateSet();
    const auto* texture = dynamic_cast<const osg::Texture2D*>(
        state ? state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE) : nullptr);
    if (!texture) return std::nullopt;
    const osg::Image& image = *texture->getImage();
    EXPECT_EQ(image.s(), 1);
    EXPECT_EQ(image.t(), 1);
    const unsigned char* bytes = image.data();
    const glsl::Rgba texel(bytes[0] / 255.0, bytes[1] / 255.0, bytes[2] / 255.0, bytes[3] / 255.0);
    EXPECT_TRUE(glsl::geofx_coverKnown(texel));
    return glsl::geofx_coverOf(texel);
}

} // namespace

TEST(MaterialCover, NamesOfFlightGearAreForestsTownsIceAndWater)
{
    const osg::ref_ptr<MaterialCover> cover = readMaterialCover("flightgear");
    const osg::ref_ptr<osg::Group> tile = new osg::Group;
    const auto add = [&](const std::string& name)
    {
        const osg::ref_ptr<osg::Geode> node = new osg::Geode;
        node->setName(name);
        tile->addChild(node);
        return node;
    };
    const auto sea = add("Ocean"), forest = add("EvergreenForest"), town = add("Urban"), ice = add("Glacier"),
               other = add("runway 09L");
    // As a tile that a pager has read.
    static_cast<TileListener&>(*cover).tileRead(*tile);
    ASSERT_TRUE(coverOf(*sea) && coverOf(*forest) && coverOf(*town) && coverOf(*ice));
    EXPECT_GT(coverOf(*sea)->shore, 1e5) << "as the sea that the map paints where no terrain is";
    EXPECT_LT(coverOf(*forest)->shore, -100.0);
    EXPECT_NEAR(coverOf(*forest)->trees, 0.95, 0.003);
    EXPECT_EQ(coverOf(*forest)->town, 0.0);
    EXPECT_EQ(coverOf(*town)->town, 1.0);
    EXPECT_EQ(coverOf(*ice)->bare, 1.0);
    EXPECT_FALSE(coverOf(*other)) << "heights and slopes decide";
    EXPECT_FALSE(coverOf(*tile));
    EXPECT_THROW(readMaterialCover("no/such/table.csv"), BuildError);
    // An engine whose shaders read unit 7 has another one.
    const osg::ref_ptr<osg::Geode> lake = new osg::Geode;
    lake->setName("Lake");
    readMaterialCover("flightgear", 31)->apply(*lake);
    EXPECT_TRUE(coverOf(*lake, 31));
    EXPECT_FALSE(coverOf(*lake, 7));
}

TEST(MaterialCover, NamesAreThoseOfNodesStateSetsAndMaterials)
{
    const osg::ref_ptr<MaterialCover> cover = new MaterialCover(9);
    ASSERT_TRUE(cover->setCover("wood", {0.5, 0.0, 0.0, false}));
    ASSERT_TRUE(cover->setCover("lake", {0.0, 0.0, 0.0, true}));
    const osg::ref_ptr<osg::Geometry> byState = new osg::Geometry, byMaterial = new osg::Geometry,
                                      plain = new osg::Geometry;
    byState->getOrCreateStateSet()->setName("wood");
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setName("lake");
    byMaterial->getOrCreateStateSet()->setAttribute(material);
    plain->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    for (const auto& each : {byState, byMaterial, plain})
        geode->addDrawable(each);
    cover->apply(*geode);
    ASSERT_TRUE(coverOf(*byState, 9) && coverOf(*byMaterial, 9));
    EXPECT_FALSE(coverOf(*byState, 7));
    EXPECT_NEAR(coverOf(*byState, 9)->trees, 0.5, 0.003);
    EXPECT_GT(coverOf(*byMaterial, 9)->shore, 0.0);
    EXPECT_FALSE(coverOf(*plain, 9));
    EXPECT_TRUE(cover->unknownMaterials().empty());
}

TEST(MaterialCover, AnEngineTellsNamesInItsOwnWay)
{
    const osg::ref_ptr<MaterialCover> cover = new MaterialCover;
    ASSERT_TRUE(cover->setCover("Ocean", {0.0, 0.0, 0.0, true}));
    cover->setNaming([](const osg::Node& node)
                     { return node.getName().substr(0, node.getName().find('#')); });
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (const char* name : {"Ocean#1", "Moon#2", ""})
    {
        root->addChild(new osg::Group);
        root->getChild(root->getNumChildren() - 1)->setName(name);
    }
    cover->apply(*root);
    EXPECT_TRUE(coverOf(*root->getChild(0)));
    EXPECT_FALSE(coverOf(*root->getChild(1)) || coverOf(*root->getChild(2)));
    EXPECT_EQ(cover->unknownMaterials(), std::set<std::string>{"Moon"});
}

TEST(MaterialCover, AStateSetThatOthersShareStaysAsItIs)
{
    const osg::ref_ptr<MaterialCover> cover = new MaterialCover;
    ASSERT_TRUE(cover->setCover("Ocean", {0.0, 0.0, 0.0, true}));
    const osg::ref_ptr<osg::StateSet> shared = new osg::StateSet;
    shared->setMode(GL_BLEND, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::Group> root = new osg::Group, sea = new osg::Group, land = new osg::Group;
    sea->setName("Ocean");
    for (const auto& each : {sea, land})
    {
        each->setStateSet(shared);
        root->addChild(each);
    }
    cover->apply(*root);
    EXPECT_TRUE(coverOf(*sea));
    EXPECT_FALSE(coverOf(*land));
    EXPECT_EQ(sea->getStateSet()->getMode(GL_BLEND), static_cast<unsigned int>(osg::StateAttribute::ON));
}

TEST(MaterialCover, ObjectsAreWhatHoldsNoGround)
{
    const osg::ref_ptr<MaterialCover> cover = new MaterialCover;
    ASSERT_TRUE(cover->setCover("Ocean", {0.0, 0.0, 0.0, true}));
    cover->setNaming([](const osg::Node& node) { return node.getName(); });
    const auto add = [](osg::Group& to, const std::string& name)
    {
        const osg::ref_ptr<osg::Group> node = new osg::Group;
        node->setName(name);
        to.addChild(node);
        return node;
    };
    const auto keepsLook = [](const osg::Node& node)
    {
        const osg::StateSet* state = node.getStateSet();
        return state && state->getDefineList().count("GEOFX_PAINTED") == 1 &&
               state->getDefineList().at("GEOFX_PAINTED").second == osg::StateAttribute::OFF;
    };
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const auto tile = add(*root, ""), sea = add(*tile, "Ocean"), unknown = add(*tile, "Moon"),
               town = add(*tile, ""), house = add(*town, ""), ofSea = add(*sea, "");
    const osg::ref_ptr<osg::PagedLOD> later = new osg::PagedLOD;
    later->setFileName(0, "later.osgb");
    tile->addChild(later);
    cover->apply(*root);
    EXPECT_FALSE(keepsLook(*town)) << "only where it is wanted";
    cover->setKeepsObjects(true);
    cover->apply(*root);
    EXPECT_TRUE(keepsLook(*town));
    for (const auto& each : {root, tile, sea, unknown, house, ofSea})
        EXPECT_FALSE(keepsLook(*each)) << each->getName();
    EXPECT_FALSE(keepsLook(*later)) << "what it reads may be ground";
    // A tile of objects alone.
    const osg::ref_ptr<osg::Group> objects = new osg::Group;
    add(*objects, "");
    cover->apply(*objects);
    EXPECT_TRUE(keepsLook(*objects));
}

TEST(MaterialCover, SharesThatCannotBeAreRefusedInASentence)
{
    geofx::test::NotifyWatch watch;
    const osg::ref_ptr<MaterialCover> cover = new MaterialCover;
    ASSERT_TRUE(cover->setCover("Ocean", {0.0, 0.0, 0.0, true}));
    for (const GroundCover& wrong : {GroundCover{1.1, 0.0, 0.0, false}, GroundCover{0.0, -0.1, 0.0, false},
                                     GroundCover{0.0, 0.0, std::nan(""), false}})
    {
        const auto said = watch.messagesOf([&] { EXPECT_FALSE(cover->setCover("Ocean", wrong)); });
        ASSERT_EQ(said.size(), 1u);
        EXPECT_NE(said[0].find("\"Ocean\""), std::string::npos);
        EXPECT_TRUE(cover->getCover("Ocean")->water) << "what was known stays";
    }
    EXPECT_EQ(watch.messagesOf([&] { EXPECT_FALSE(cover->setCover("", {})); }).size(), 1u);
    EXPECT_EQ(cover->getCover("Moon"), nullptr);
}
