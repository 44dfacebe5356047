// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The parser of the scene file alone, without osgDB.
#include <geofx/SceneFile.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace
{

using osgGeoFX::parseScene;
using osgGeoFX::SceneFile;
using osgGeoFX::SceneResult;

const std::string terrain = "<terrain><database file='terrain.osgb'/></terrain>";

/// A scene with a terrain, and more in it, on line 2.
std::string sceneWith(const std::string& more)
{
    return "<geofx version='1'>" + terrain + "\n" + more + "</geofx>";
}

/// A scene of rasters, the inside of <rasters> on line 3.
std::string rastersWith(const std::string& attributes, const std::string& inside)
{
    return "<geofx version='1'><terrain>\n<rasters " + attributes + ">\n" + inside +
           "\n</rasters></terrain></geofx>";
}

SceneFile parsed(const std::string& text)
{
    const SceneResult result = parseScene(text, "x.geofx", "/scenes");
    for (const std::string& error : result.errors)
        ADD_FAILURE() << error;
    return result.scene.value_or(SceneFile());
}

TEST(SceneFile, ReadsAllThatASceneSays)
{
    const SceneFile scene = parsed(R"(<geofx version="1">
  <background color="#ff8000" visibility="60000.5" sky="true"/>
  <sun azimuth="-115.5" elevation="35" color="#ffffff" ambient="#003300"/>
  <homeView longitude="-157.905" latitude="+21.245" height="1400" heading="25" pitch="-12" roll=".5"
            verticalFieldOfView="35"/>
  <terrain>
    <rasters cache="cache" srs=" EPSG:32604 " vertical="egm96" tileSize="64" textureSize="256" pixelError="0.5"
             texelError="3" memory="512" voids="keep" voidReach="30" voidSmoothing="0">
      <dem file="a.tif"/>
      <dem file="/data/b.tif"/>
      <imagery file="c d.jp2"/>
      <landCover file="../e.tif" table="e.csv"/>
      <treeCover file="t.tif"/>
    </rasters>
  </terrain>
</geofx>)");
    EXPECT_FALSE(scene.database);
    ASSERT_TRUE(scene.rasters && scene.rasters->landCover && scene.homeView && scene.sun && scene.background);
    ASSERT_EQ(scene.rasters->dems.size(), 2u);
    EXPECT_EQ(scene.rasters->dems[0].path, "/scenes/a.tif");
    EXPECT_EQ(scene.rasters->dems[0].place.line, 9);
    EXPECT_EQ(scene.rasters->dems[1].path, "/data/b.tif");
    ASSERT_EQ(scene.rasters->imagery.size(), 1u);
    EXPECT_EQ(scene.rasters->imagery[0].path, "/scenes/c d.jp2");
    EXPECT_EQ(scene.rasters->landCover->file.path, "/e.tif");
    EXPECT_EQ(scene.rasters->landCover->table.path, "/scenes/e.csv");
    ASSERT_TRUE(scene.rasters->treeCover);
    EXPECT_EQ(scene.rasters->treeCover->path, "/scenes/t.tif");
    EXPECT_EQ(scene.rasters->cache, "/scenes/cache");
    EXPECT_EQ(scene.rasters->epsg, 32604);
    EXPECT_EQ(scene.rasters->vertical, "egm96");
    EXPECT_EQ(scene.rasters->tileSize, 64);
    EXPECT_EQ(scene.rasters->textureSize, 256);
    EXPECT_EQ(scene.rasters->pixelError, 0.5);
    EXPECT_EQ(scene.rasters->texelError, 3.0);
    EXPECT_EQ(scene.rasters->memoryMiB, 512);
    EXPECT_EQ(scene.rasters->voids, "keep");
    EXPECT_EQ(scene.rasters->voidReach, 30);
    EXPECT_EQ(scene.rasters->voidSmoothing, 0);
    EXPECT_EQ(scene.homeView->longitude, -157.905);
    EXPECT_EQ(scene.homeView->latitude, 21.245);
    EXPECT_EQ(scene.homeView->height, 1400.0);
    EXPECT_EQ(scene.homeView->heading, 25.0);
    EXPECT_EQ(scene.homeView->pitch, -12.0);
    EXPECT_EQ(scene.homeView->roll, 0.5);
    EXPECT_EQ(scene.homeView->verticalFieldOfView, 35.0);
    EXPECT_EQ(scene.sun->azimuth, -115.5);
    EXPECT_EQ(scene.sun->elevation, 35.0);
    EXPECT_EQ(scene.sun->color, (osgGeoFX::SceneColor{1.0, 1.0, 1.0}));
    EXPECT_EQ(scene.sun->ambient, (osgGeoFX::SceneColor{0.0, 0.2, 0.0}));
    EXPECT_EQ(scene.background->color, (osgGeoFX::SceneColor{1.0, 128.0 / 255.0, 0.0}));
    EXPECT_EQ(scene.background->visibility, 60000.5);
    EXPECT_TRUE(scene.background->sky);
    const SceneFile plain = parsed(sceneWith("<background color='#000000'/>"));
    EXPECT_FALSE(plain.background->visibility || plain.background->sky);
}

TEST(SceneFile, ReadsWhatIsStatedOfADatabaseOfAnotherMaker)
{
    const SceneFile scene = parsed("<geofx version='1'><terrain><database file='a.osgb' frame='geocentric' "
                                   "minHeight='-2.5' maxHeight='2110' tileCells='24'/></terrain></geofx>");
    EXPECT_EQ(scene.ground.frame, osgGeoFX::EffectScene::GEOCENTRIC);
    EXPECT_EQ(scene.ground.minHeight, -2.5);
    EXPECT_EQ(scene.ground.maxHeight, 2110.0);
    EXPECT_EQ(scene.ground.tileCells, 24);
    const SceneFile projected =
        parsed("<geofx version='1'><terrain><database file='a.osgb' frame='projected'/>"
               "</terrain></geofx>");
    EXPECT_EQ(projected.ground.frame, osgGeoFX::EffectScene::PROJECTED);
    const SceneFile plain = parsed(sceneWith(""));
    EXPECT_EQ(plain.ground.frame, osgGeoFX::EffectScene::AUTOMATIC);
    EXPECT_FALSE(plain.ground.minHeight || plain.ground.maxHeight);
    EXPECT_EQ(plain.ground.tileCells, 0);
}

TEST(SceneFile, HasTheSchemasDefaults)
{
    const SceneFile scene = parsed(rastersWith("", "<dem file='a.tif'/>"));
    ASSERT_TRUE(scene.rasters);
    EXPECT_EQ(scene.rasters->cache, "");
    EXPECT_EQ(scene.rasters->epsg, 0);
    EXPECT_EQ(scene.rasters->vertical, "none");
    EXPECT_EQ(scene.rasters->tileSize, 128);
    EXPECT_EQ(scene.rasters->textureSize, 0);
    EXPECT_EQ(scene.rasters->pixelError, 1.0);
    EXPECT_EQ(scene.rasters->texelError, 2.0);
    EXPECT_EQ(scene.rasters->memoryMiB, 1024);
    EXPECT_EQ(scene.rasters->voids, "fill");
    EXPECT_EQ(scene.rasters->voidReach, 100);
    EXPECT_EQ(scene.rasters->voidSmoothing, 10);
    EXPECT_TRUE(scene.rasters->imagery.empty());
    EXPECT_FALSE(scene.rasters->landCover || scene.homeView || scene.sun || scene.background);

    const SceneFile other =
        parsed(sceneWith("<homeView longitude='1' latitude='2' height='3' heading='4' pitch='5'/>"
                         "<sun azimuth='1' elevation='2'/>"));
    ASSERT_TRUE(other.database && other.homeView && other.sun);
    EXPECT_EQ(other.database->path, "/scenes/terrain.osgb");
    EXPECT_EQ(other.homeView->roll, 0.0);
    EXPECT_FALSE(other.homeView->verticalFieldOfView);
    EXPECT_EQ(other.sun->color, (osgGeoFX::SceneColor{1.0, 244.0 / 255.0, 224.0 / 255.0}));
    EXPECT_EQ(other.sun->ambient, (osgGeoFX::SceneColor{76.0 / 255.0, 85.0 / 255.0, 102.0 / 255.0}));
}

/// The effects of a scene, as someone types them, on line 3.
SceneFile withEffects(const std::string& effects)
{
    return parsed(sceneWith("<effects>\n" + effects + "</effects>"));
}

TEST(SceneFile, ReadsEffectsInTheirOrder)
{
    const SceneFile scene = withEffects(R"(
        <verticalExaggeration factor="2" baseHeight="-10" relight="false"/>
        <birdsEyeView horizonLine="0.95" focusLine="0.9" contextTilt=".25" curve="bezier" mapUnit="2"/>
        <blendedView lowHeight="5000" highHeight="+6000" enabled="false">
          <pedestrianView bendAngle="90" planeReference="eye" planeHeight="-2"/>
          <birdsEyeView focusLine="0.1" horizonLine="0.2"/>
        </blendedView>
        <pedestrianView focusDistance="-5.5" zoneWidth="750" contextSaturation="0" contextBrightness="2"
                        tallest="40" transitionDetail="4" contextDetail="0.5" tessellation="true" tessellationPixels="2.5"/>
        <verticalExaggeration/>)");
    ASSERT_EQ(scene.effects.size(), 5u);
    const auto value = [&](std::size_t i, const char* name)
    {
        return scene.effects[i]->getProperty(name);
    };
    EXPECT_EQ(osgGeoFX::kindOf(*scene.effects[0]), "verticalExaggeration");
    EXPECT_EQ(value(0, "factor"), 2.0);
    EXPECT_EQ(value(0, "baseHeight"), -10.0);
    EXPECT_EQ(value(0, "relight"), 0.0);
    EXPECT_EQ(value(0, "enabled"), 1.0);
    EXPECT_EQ(osgGeoFX::kindOf(*scene.effects[1]), "birdsEyeView");
    EXPECT_EQ(value(1, "focusLine"), 0.9);
    EXPECT_EQ(value(1, "horizonLine"), 0.95);
    EXPECT_EQ(value(1, "contextTilt"), 0.25);
    EXPECT_EQ(value(1, "curve"), osgGeoFX::PerspectiveBend::BEZIER);
    EXPECT_EQ(value(1, "mapUnit"), 2.0);
    const auto* blended = dynamic_cast<const osgGeoFX::BlendedView*>(scene.effects[2].get());
    ASSERT_TRUE(blended);
    EXPECT_EQ(value(2, "lowHeight"), 5000.0);
    EXPECT_EQ(value(2, "highHeight"), 6000.0);
    EXPECT_FALSE(blended->getEnabled());
    EXPECT_EQ(blended->getPedestrianView()->getBendAngle(), osg::PI_2);
    EXPECT_EQ(blended->getPedestrianView()->getPlaneReference(), osgGeoFX::PerspectiveBend::EYE);
    EXPECT_EQ(blended->getPedestrianView()->getPlaneHeight(), -2.0);
    EXPECT_EQ(blended->getBirdsEyeView()->getFocusLine(), 0.1);
    EXPECT_EQ(blended->getBirdsEyeView()->getHorizonLine(), 0.2);
    EXPECT_EQ(osgGeoFX::kindOf(*scene.effects[3]), "pedestrianView");
    EXPECT_EQ(value(3, "focusDistance"), -5.5);
    EXPECT_EQ(value(3, "zoneWidth"), 750.0);
    EXPECT_EQ(value(3, "contextSaturation"), 0.0);
    EXPECT_EQ(value(3, "contextBrightness"), 2.0);
    EXPECT_EQ(value(3, "tallest"), 40.0);
    EXPECT_EQ(value(3, "transitionDetail"), 4.0);
    EXPECT_EQ(value(3, "contextDetail"), 0.5);
    EXPECT_EQ(value(3, "tessellation"), 1.0);
    EXPECT_EQ(value(3, "tessellationPixels"), 2.5);
    EXPECT_EQ(value(4, "factor"), 1.0);
    EXPECT_TRUE(withEffects("").effects.empty());
    EXPECT_TRUE(parsed(sceneWith("")).effects.empty());
}

struct Mistake
{
    const char* name;
    std::string text;
    std::string begins; ///< file, line and element
    std::string holds;  ///< what was expected
};

std::ostream& operator<<(std::ostream& stream, const Mistake& mistake)
{
    return stream << mistake.text;
}

class SceneMistake : public testing::TestWithParam<Mistake>
{
};

TEST_P(SceneMistake, IsNamedWithFileLineElementAndExpectation)
{
    const SceneResult result = parseScene(GetParam().text, "x.geofx", "/scenes");
    EXPECT_FALSE(result.scene);
    ASSERT_EQ(result.errors.size(), 1u) << testing::PrintToString(result.errors);
    EXPECT_EQ(result.errors[0].rfind(GetParam().begins, 0), 0u) << result.errors[0];
    EXPECT_NE(result.errors[0].find(GetParam().holds), std::string::npos) << result.errors[0];
}

const std::string view = "longitude='1' latitude='2' height='3' heading='4' ";

INSTANTIATE_TEST_SUITE_P(
    All, SceneMistake,
    testing::Values(
        Mistake{"Empty", "", "x.geofx:1: <geofx>: ", "expected: a scene in XML."},
        Mistake{"NotXml", "hello", "x.geofx:1: <geofx>: ", "not well-formed XML: "},
        Mistake{"NotClosed", "<geofx version='1'>\n<terrain></geofx>",
                "x.geofx:2: <terrain>: ", "Opening and ending tag mismatch: terrain line 2 and geofx"},
        Mistake{"DocumentType",
                "<!DOCTYPE geofx [<!ENTITY a 'b'>]>\n<geofx version='1'>" + terrain + "</geofx>",
                "x.geofx:1: <geofx>: ", "expected: no <!DOCTYPE>."},
        Mistake{"OtherRoot", "<scene/>", "x.geofx:1: <scene>: ", "expected: <geofx version=\"1\">"},
        Mistake{"Namespace", "<geofx xmlns='a' version='1'/>", "x.geofx:1: <geofx>: ", "without a namespace"},
        Mistake{"NoVersion", "<geofx>" + terrain + "</geofx>",
                "x.geofx:1: <geofx>: ", "expected: version (the version of the scene format, 1)."},
        Mistake{"NewerVersion", "<geofx version='2'><future/></geofx>", "x.geofx:1: <geofx>: version=\"2\" ",
                "expected: the version of the scene format, 1. A newer osgGeoFX may read this scene."},
        Mistake{"NoTerrain", "<geofx version='1'><background color='#000000'/></geofx>",
                "x.geofx:1: <geofx>: ", "expected: <terrain>"},
        Mistake{"EmptyTerrain", "<geofx version='1'>\n<terrain/></geofx>",
                "x.geofx:2: <terrain>: ", "expected: <database> or <rasters> or <engine>."},
        Mistake{"TwoTerrains", sceneWith(terrain),
                "x.geofx:2: <terrain>: ", "expected: at most one each of <terrain>"},
        Mistake{"UnknownFrame",
                "<geofx version='1'><terrain>\n<database file='a' frame='flat'/></terrain></geofx>",
                "x.geofx:2: <database>: frame=\"flat\" ", "\"geocentric\" (coordinates are metres"},
        Mistake{"OneHeight",
                "<geofx version='1'><terrain>\n<database file='a' minHeight='1'/></terrain></geofx>",
                "x.geofx:2: <database>: ", "minHeight and maxHeight must be stated together"},
        Mistake{"HeightsUpsideDown",
                "<geofx version='1'><terrain>\n<database file='a' minHeight='2' "
                "maxHeight='1'/></terrain></geofx>",
                "x.geofx:2: <database>: ", "minHeight must not be above maxHeight"},
        Mistake{"HeightOutOfRange",
                "<geofx version='1'><terrain>\n<database file='a' minHeight='2' "
                "maxHeight='1e9'/></terrain></geofx>",
                "x.geofx:2: <database>: maxHeight=", "metres, from -12000 to 100000"},
        Mistake{"HalfACell",
                "<geofx version='1'><terrain>\n<database file='a' tileCells='2.5'/></terrain></geofx>",
                "x.geofx:2: <database>: tileCells=", "a whole number from 1 to 4096"},
        Mistake{"DatabaseAndRasters",
                "<geofx version='1'><terrain><database file='a'/>\n<rasters><dem "
                "file='b'/></rasters></terrain></geofx>",
                "x.geofx:2: <rasters>: ", "expected: only one of <database>, <rasters>, <engine>."},
        Mistake{"UnknownElement", sceneWith("<panorama/>"),
                "x.geofx:2: <panorama>: this element is not known in <geofx>",
                "expected: <terrain>, <homeView>, <sun>, <background>, <effects>, <presets>, <map>."},
        Mistake{"UnknownElementBelow", rastersWith("", "<dem file='a'/><bathymetry/>"),
                "x.geofx:3: <bathymetry>: this element is not known in <rasters>",
                "expected: <dem> or <imagery> or <landCover> or <treeCover>."},
        Mistake{"UnknownAttribute", sceneWith("<background color='#000000' colour='#000000'/>"),
                "x.geofx:2: <background>: the attribute \"colour\" is not known here",
                "expected: color, visibility, sky."},
        Mistake{"NoSightAtAll", sceneWith("<background color='#000000' visibility='0'/>"),
                "x.geofx:2: <background>: visibility=\"0\"", "expected: metres at which haze has left 2 %"},
        Mistake{"Order", rastersWith("", "<imagery file='a'/><dem file='b'/>"),
                "x.geofx:3: <imagery>: ", "expected: <dem>."},
        Mistake{"NoDem", rastersWith("", ""), "x.geofx:2: <rasters>: ", "expected: <dem>."},
        Mistake{"NoFile", rastersWith("", "<dem/>"), "x.geofx:3: <dem>: ", "expected: file (a path; "},
        Mistake{"EmptyFile", rastersWith("", "<dem file=''/>"), "x.geofx:3: <dem>: file=\"\"",
                "expected: a path; "},
        Mistake{"Text", sceneWith("hello"), "x.geofx:1: <geofx>: ", "expected: elements only."},
        Mistake{"Inside", sceneWith("<background color='#000000'>x</background>"),
                "x.geofx:2: <background>: ", "expected: nothing"},
        Mistake{"Srs", rastersWith("srs='32604'", "<dem file='a'/>"), "x.geofx:2: <rasters>: srs=\"32604\" ",
                "expected: \"geocentric\", or a projected coordinate system as \"EPSG:\" and its number."},
        Mistake{"Vertical", rastersWith("vertical='msl'", "<dem file='a'/>"),
                "x.geofx:2: <rasters>: vertical=\"msl\" ", "\"egm96\""},
        Mistake{"TileSize", rastersWith("tileSize='300'", "<dem file='a'/>"),
                "x.geofx:2: <rasters>: tileSize=\"300\" ", "from 8 to 240."},
        Mistake{"PixelError", rastersWith("pixelError='0'", "<dem file='a'/>"),
                "x.geofx:2: <rasters>: pixelError=\"0\" ", "from 0.01 to 100."},
        Mistake{"Memory", rastersWith("memory='99999999999'", "<dem file='a'/>"),
                "x.geofx:2: <rasters>: memory=", "a whole number from 128."},
        Mistake{"Longitude",
                sceneWith("<homeView longitude='181' latitude='2' height='3' heading='4' pitch='5'/>"),
                "x.geofx:2: <homeView>: longitude=\"181\" ", "expected: degrees east of Greenwich"},
        Mistake{"NotANumber",
                sceneWith("<homeView longitude='NaN' latitude='2' height='3' heading='4' pitch='5'/>"),
                "x.geofx:2: <homeView>: longitude=\"NaN\" ", "from -180 to 180."},
        Mistake{"Pitch", sceneWith("<homeView " + view + "pitch='-91'/>"),
                "x.geofx:2: <homeView>: pitch=\"-91\" ", "from -90 (straight down) to 90."},
        Mistake{"NoPitch", sceneWith("<homeView " + view + "/>"),
                "x.geofx:2: <homeView>: ", "expected: pitch ("},
        Mistake{"FieldOfView", sceneWith("<homeView " + view + "pitch='0' verticalFieldOfView='180'/>"),
                "x.geofx:2: <homeView>: verticalFieldOfView=\"180\" ", "from 1 to 170"},
        Mistake{"Elevation", sceneWith("<sun azimuth='0' elevation='91'/>"),
                "x.geofx:2: <sun>: elevation=\"91\" ", "from -90 to 90."},
        Mistake{"Color", sceneWith("<sun azimuth='0' elevation='9' color='red'/>"),
                "x.geofx:2: <sun>: color=\"red\" ", "two hexadecimal digits each"},
        Mistake{"TwoEffects", sceneWith("<effects/>\n<effects/>"),
                "x.geofx:3: <effects>: ", "expected: at most one each of <terrain>"},
        Mistake{"UnknownEffect", sceneWith("<effects>\n<fishEye/></effects>"),
                "x.geofx:3: <fishEye>: this element is not known in <effects>",
                "expected: <birdsEyeView> or <pedestrianView> or <blendedView> or <verticalExaggeration> or "
                "<regionalLiberty> or <groundDetail> or <sunShadows> or "
                "<projectiveMappings> or <closeUps> or <panoramaMap>."},
        Mistake{"UnknownProperty", sceneWith("<effects>\n<verticalExaggeration power='2'/></effects>"),
                "x.geofx:3: <verticalExaggeration>: the attribute \"power\" is not known here",
                "expected: enabled, factor, baseHeight, relight."},
        Mistake{"UnknownPropertyOfBend", sceneWith("<effects>\n<birdsEyeView bendAngle='2'/></effects>"),
                "x.geofx:3: <birdsEyeView>: the attribute \"bendAngle\" is not known here",
                "expected: enabled, curve, planeHeight, "},
        Mistake{"PropertyOutOfRange", sceneWith("<effects>\n<pedestrianView bendAngle='91'/></effects>"),
                "x.geofx:3: <pedestrianView>: bendAngle=\"91\" ",
                "expected: the angle by which the ground ahead is folded up, degrees, from 0 to 90."},
        Mistake{"PropertyOfAllBends", sceneWith("<effects>\n<pedestrianView curve='spline'/></effects>"),
                "x.geofx:3: <pedestrianView>: curve=\"spline\" ", "\"arcLength\""},
        Mistake{"PropertyOfAllEffects", sceneWith("<effects>\n<pedestrianView enabled='1'/></effects>"),
                "x.geofx:3: <pedestrianView>: enabled=\"1\" ", "true or false."},
        Mistake{"PropertyNotANumber", sceneWith("<effects>\n<verticalExaggeration factor='NaN'/></effects>"),
                "x.geofx:3: <verticalExaggeration>: factor=\"NaN\" ", "from 0.01 to 100."},
        Mistake{"PropertyNotWhole", sceneWith("<effects>\n<birdsEyeView mapUnit='0.5'/></effects>"),
                "x.geofx:3: <birdsEyeView>: mapUnit=\"0.5\" ", "a whole number from -1 to 3; -1 is none."},
        Mistake{"LinesDoNotFit",
                sceneWith("<effects>\n<birdsEyeView focusLine='0.9' horizonLine='0.5'/></effects>"),
                "x.geofx:3: <birdsEyeView>: BirdsEyeView: focusLine must lie below horizonLine.", ""},
        Mistake{"LineDoesNotFitTheDefault", sceneWith("<effects>\n<birdsEyeView focusLine='0.9'/></effects>"),
                "x.geofx:3: <birdsEyeView>: BirdsEyeView: focusLine must lie below horizonLine.", ""},
        Mistake{"HeightsDoNotFit",
                sceneWith("<effects>\n<blendedView lowHeight='20' highHeight='10'/></effects>"),
                "x.geofx:3: <blendedView>: BlendedView: lowHeight must be less than highHeight.", ""},
        Mistake{
            "LinesOfAPartDoNotFit",
            sceneWith("<effects><blendedView>\n<birdsEyeView horizonLine='0.4'/></blendedView></effects>"),
            "x.geofx:3: <birdsEyeView>: BirdsEyeView: focusLine must lie below horizonLine.", ""},
        Mistake{"PartTwice",
                sceneWith("<effects><blendedView><birdsEyeView/>\n<birdsEyeView/></blendedView></effects>"),
                "x.geofx:3: <birdsEyeView>: ", "at most one each of <birdsEyeView>, <pedestrianView>."},
        Mistake{"NoPart",
                sceneWith("<effects><blendedView>\n<verticalExaggeration/></blendedView></effects>"),
                "x.geofx:3: <verticalExaggeration>: this element is not known in <blendedView>",
                "expected: <birdsEyeView>"},
        Mistake{"InsideAnEffect",
                sceneWith("<effects>\n<birdsEyeView><pedestrianView/></birdsEyeView></effects>"),
                "x.geofx:3: <birdsEyeView>: something stands inside", "expected: nothing"},
        Mistake{"TextBetweenEffects", sceneWith("<effects>hello</effects>"),
                "x.geofx:2: <effects>: ", "expected: elements only."},
        Mistake{"ForeignAttribute", sceneWith("<background color='#000000' xml:lang='de'/>"),
                "x.geofx:2: <background>: the attribute ", "expected: color, visibility, sky."}),
    [](const auto& mistake) { return std::string(mistake.param.name); });

// Not among the mistakes above, whose texts each run of this program makes.
TEST(SceneFile, LargerThanSixteenMebibytesIsRefused)
{
    const SceneResult result = parseScene(std::string(osgGeoFX::largestScene + 1, ' '), "x.geofx", "/scenes");
    EXPECT_FALSE(result.scene);
    ASSERT_EQ(result.errors.size(), 1u) << testing::PrintToString(result.errors);
    EXPECT_EQ(result.errors[0].rfind("x.geofx:1: <geofx>: ", 0), 0u) << result.errors[0];
    EXPECT_NE(result.errors[0].find("16 MiB"), std::string::npos) << result.errors[0];
}

TEST(SceneFile, NamesSeveralMistakesOfAScene)
{
    const SceneResult result =
        parseScene(sceneWith("<sun azimuth='x' elevation='y'/>\n<panorama/>"), "x.geofx", "/");
    ASSERT_EQ(result.errors.size(), 3u) << testing::PrintToString(result.errors);
    EXPECT_EQ(result.errors[0].rfind("x.geofx:2: <sun>: azimuth", 0), 0u) << result.errors[0];
    EXPECT_EQ(result.errors[1].rfind("x.geofx:2: <sun>: elevation", 0), 0u) << result.errors[1];
    EXPECT_EQ(result.errors[2].rfind("x.geofx:3: <panorama>: ", 0), 0u) << result.errors[2];
}

TEST(SceneFile, NamesEachEffectThatDoesNotFitAndNotWithoutEnd)
{
    const std::string wrong = "<birdsEyeView focusLine='0.9'/>\n";
    SceneResult result = parseScene(sceneWith("<effects>\n" + wrong + wrong + "</effects>"), "x.geofx", "/");
    EXPECT_FALSE(result.scene);
    ASSERT_EQ(result.errors.size(), 2u);
    EXPECT_EQ(result.errors[0].rfind("x.geofx:3: <birdsEyeView>: ", 0), 0u) << result.errors[0];
    EXPECT_EQ(result.errors[1].rfind("x.geofx:4: <birdsEyeView>: ", 0), 0u) << result.errors[1];
    std::string many;
    for (int i = 0; i < 100; ++i)
        many += wrong;
    result = parseScene(sceneWith("<effects>" + many + "</effects>"), "x.geofx", "/");
    EXPECT_EQ(result.errors.size(), 20u);
}

TEST(SceneFile, OpensNoSchemaThatASceneNames)
{
    // This one declares other elements; a validator that opened it would not accept the scene.
    const geofx::test::TempDir folder;
    const auto schema =
        folder.write("other.xsd", "<xs:schema xmlns:xs='http://www.w3.org/2001/XMLSchema' broken='");
    parsed("<geofx version='1' xmlns:xsi='http://www.w3.org/2001/XMLSchema-instance' "
           "xsi:noNamespaceSchemaLocation='" +
           schema.string() + "' xsi:schemaLocation='a " + schema.string() + "'>" + terrain + "</geofx>");
}

TEST(SceneFile, NamesFilesThatAreNotThere)
{
    const geofx::test::TempDir folder;
    folder.write("a.tif", "");
    folder.write("sub/b.tif", "");
    const auto errorsOf = [&](const std::string& inside)
    {
        const SceneResult result = parseScene(rastersWith("", inside), "x.geofx", folder.path().string());
        return result.scene ? osgGeoFX::missingFiles(*result.scene) : result.errors;
    };
    EXPECT_TRUE(errorsOf("<dem file='a.tif'/><imagery file='sub/b.tif'/><imagery file='/vsizip/x.zip/c.tif'/>"
                         "<landCover file='sub/../a.tif' table='" +
                         (folder / "a.tif").string() + "'/>")
                    .empty());

    const auto errors =
        errorsOf("<dem file='b.tif'/>\n<imagery file='sub'/>\n<landCover file='a.tif' table='t.csv'/>");
    ASSERT_EQ(errors.size(), 3u);
    EXPECT_EQ(errors[0],
              "x.geofx:3: <dem>: the file \"" + (folder / "b.tif").string() +
                  "\" does not exist; correct the attribute \"file\" (a relative path starts in the folder "
                  "of the scene file).");
    EXPECT_NE(errors[1].find("x.geofx:4: <imagery>: "), std::string::npos);
    EXPECT_NE(errors[1].find("is a folder"), std::string::npos);
    EXPECT_NE(errors[2].find("x.geofx:5: <landCover>: "), std::string::npos);
    EXPECT_NE(errors[2].find("attribute \"table\""), std::string::npos);

    // A ready legend is no file; tree cover is one.
    EXPECT_TRUE(errorsOf("<dem file='a.tif'/><landCover file='a.tif' table='worldcover'/>").empty());
    const auto trees = errorsOf("<dem file='a.tif'/>\n<treeCover file='t.tif'/>");
    ASSERT_EQ(trees.size(), 1u);
    EXPECT_NE(trees[0].find("x.geofx:4: <treeCover>: "), std::string::npos);
}

TEST(SceneFile, JudgesTheFuzzersCorpusAsItsNamesSay)
{
    int valid = 0, invalid = 0;
    for (const auto& entry : std::filesystem::directory_iterator(GEOFX_SOURCE_DIR "/tests/fuzz/corpus/scene"))
    {
        const std::string name = entry.path().filename().string();
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
        const bool expected = name.rfind("valid-", 0) == 0;
        EXPECT_EQ(parseScene(text, name, "/scenes").scene.has_value(), expected) << name;
        ++(expected ? valid : invalid);
    }
    EXPECT_GE(valid, 4);
    EXPECT_GE(invalid, 8);
}

TEST(SceneFile, TheScenesOfOahuAreSome)
{
    for (const char* const name : {"oahu.geofx", "plain.geofx"})
    {
        std::ifstream stream(GEOFX_SOURCE_DIR "/data/oahu/" + std::string(name));
        const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
        const SceneResult result = parseScene(text, name, GEOFX_SOURCE_DIR "/data/oahu");
        ASSERT_TRUE(result.scene) << testing::PrintToString(result.errors);
        EXPECT_EQ(osgGeoFX::missingFiles(*result.scene), std::vector<std::string>());
    }
}

TEST(ScenePresets, AreReadWithTheirEffects)
{
    const std::string effects = "<effects><birdsEyeView/><blendedView/><birdsEyeView/></effects>\n";
    const SceneFile scene = parsed(sceneWith(
        effects + "<presets><preset name='a'><set property='birdsEyeView[2].focusLine' value='0.3'/>"
                  "<set property='blendedView.pedestrianView.bendAngle' value='30'/></preset>"
                  "<preset name='b'><set property='birdsEyeView.curve' value='bezier'/></preset></presets>"));
    ASSERT_EQ(scene.presets.size(), 2u);
    EXPECT_EQ(scene.presets[0].name, "a");
    ASSERT_EQ(scene.presets[0].settings.size(), 2u);
    EXPECT_EQ(scene.presets[0].settings[1],
              std::pair(std::string("blendedView.pedestrianView.bendAngle"), std::string("30")));
    EXPECT_EQ(scene.presets[1].settings[0].second, "bezier");
    const auto errorOf = [&](const std::string& inside)
    {
        const SceneResult result =
            parseScene(sceneWith(effects + "<presets>\n" + inside + "</presets>"), "x.geofx", "/scenes");
        EXPECT_FALSE(result.scene);
        EXPECT_EQ(result.errors.size(), 1u) << ::testing::PrintToString(result.errors);
        return result.errors.empty() ? std::string() : result.errors.front();
    };
    const auto setting = [&](const std::string& property, const std::string& value)
    {
        return errorOf("<preset name='a'>\n<set property='" + property + "' value='" + value +
                       "'/></preset>");
    };
    EXPECT_EQ(setting("lens.size", "1").rfind("x.geofx:5: <set>: ", 0), 0u) << setting("lens.size", "1");
    EXPECT_NE(setting("birdsEyeView.focusLane", "1").find("no property \"focusLane\""), std::string::npos);
    EXPECT_NE(setting("birdsEyeView.focusLine", "nan").find("focusLine"), std::string::npos);
    EXPECT_NE(setting("blendedView.pedestrianView.bendAngle", "100").find("bendAngle"), std::string::npos);
    EXPECT_NE(errorOf("<preset name='a'/>").find("<preset>"), std::string::npos);
    const std::string good = "<set property='birdsEyeView.curve' value='bezier'/>";
    EXPECT_NE(errorOf("<preset name='a'>" + good + "</preset><preset name='a'>" + good + "</preset>")
                  .find("stands twice"),
              std::string::npos);
}

} // namespace
