// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What osggeofx_viewer puts into its viewer: the keys, the page that tells them, the manipulators and their home.
#include <osgGeoFX/closeup/CloseUpHandler.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/light/SunLight.h>
#include <osgGeoFX/map/MapContents.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/panorama/PanoramaComposer.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/viewer/CurvePanel.h>
#include <osgGeoFX/viewer/EffectPanel.h>
#include <osgGeoFX/viewer/EffectPresets.h>
#include <osgGeoFX/viewer/HelpPage.h>
#include <osgGeoFX/viewer/Liberties.h>
#include <osgGeoFX/viewer/MappingPanel.h>
#include <panorama/Recipe.h>
#include <tools/GlFixture.h>
#include <tools/PagedScene.h>
#include <tools/TempDir.h>
#include <viewer/MapSaver.h>
#include <viewer/ViewerSetup.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <OpenThreads/Thread>
#include <osg/Math>
#include <osg/ValueObject>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgGA/FlightManipulator>
#include <osgGA/SphericalManipulator>
#include <osgText/Text>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

using namespace osgGeoFX;
using Event = osgGA::GUIEventAdapter;

namespace
{

constexpr double longitude = -157.81;
constexpr double latitude = 21.395;
constexpr double eyeHeight = 2500.0;
constexpr double heading = 40.0;
constexpr double pitch = -30.0;

/// The texts that overlays show, with where they stand, in pixels.
class ShownTexts : public osg::NodeVisitor
{
public:
    ShownTexts() : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN) {}

    void apply(osg::Drawable& drawable) override
    {
        if (auto* text = dynamic_cast<osgText::Text*>(&drawable)) found.emplace_back(text);
    }
    std::vector<osg::ref_ptr<osgText::Text>> found;
};

std::string wordsOf(const osgText::Text& text)
{
    return const_cast<osgText::Text&>(text).getText().createUTF8EncodedString();
}

/// What people call keys that are no letters.
const std::map<int, std::string> names = {
    {Event::KEY_F1, "F1"},
    {Event::KEY_F2, "F2"},
    {Event::KEY_F3, "F3"},
    {Event::KEY_F4, "F4"},
    {Event::KEY_F5, "F5"},
    {Event::KEY_F6, "F6"},
    {Event::KEY_F7, "F7"},
    {Event::KEY_F8, "F8"},
    {Event::KEY_F9, "F9"},
    {Event::KEY_F10, "F10"},
    {Event::KEY_F11, "F11"},
    {Event::KEY_F12, "F12"},
    {Event::KEY_Up, "Up"},
    {Event::KEY_Down, "Down"},
    {Event::KEY_Left, "Left"},
    {Event::KEY_Right, "Right"},
    {Event::KEY_Page_Up, "Page Up"},
    {Event::KEY_Page_Down, "Page Down"},
    {Event::KEY_Home, "Home"},
    {Event::KEY_End, "End"},
    {Event::KEY_Return, "Return"},
    {Event::KEY_KP_Enter, "Return"},
    {Event::KEY_KP_Add, "+"},
    {Event::KEY_KP_Subtract, "-"},
    {Event::KEY_Tab, "Tab"},
    {Event::KEY_Delete, "Delete"},
    {Event::KEY_BackSpace, "Backspace"},
    {Event::KEY_Insert, "Insert"},
    {Event::KEY_Print, "Print"},
    {' ', "Space"},
    {'=', "+"} // the same key on many keyboards
};

std::string nameOf(int key)
{
    const auto found = names.find(key);
    return found != names.end() ? found->second : std::string(1, static_cast<char>(key));
}

std::vector<int> allKeys()
{
    std::vector<int> keys;
    for (int key = ' '; key < 127; ++key)
        keys.push_back(key);
    for (const auto& [key, name] : names)
        if (key > 127) keys.push_back(key);
    return keys;
}

/// Whether a binding such as "Page Up and Page Down, Home and End" or "( and )" has a key.
bool hasKey(const std::string& binding, const std::string& name)
{
    if (binding == name) return true;
    for (std::size_t at = binding.find(name); at != std::string::npos; at = binding.find(name, at + 1))
    {
        const std::size_t end = at + name.size();
        const bool begins = at == 0 || binding[at - 1] == ' ';
        // "Up" is not in "Page Up".
        const bool isPart = at >= 5 && binding.compare(at - 5, 5, "Page ") == 0;
        if (begins && !isPart && (end == binding.size() || binding[end] == ' ' || binding[end] == ','))
            return true;
    }
    return false;
}

class ViewerKeys : public geofx::test::GlFixture
{
protected:
    ViewerKeys() : GlFixture(1280, 720) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _file = geofx::test::PagedScene::write(_folder.path(), geofx::test::PagedScene::Kind::Geocentric)
                    .string();
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(_file);
        ASSERT_TRUE(node);
        node->setUserValue("geofx.homeView", std::string("-157.81,21.395,2500,40,-30"));
        std::string error;
        _scene = Scene::adopt(node, error);
        ASSERT_TRUE(_scene) << error;
        const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        bend->setEnabled(false);
        _scene->effects->addEffect(bend);
        const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        mappings->addMapping(new ProjectiveMapping);
        mappings->setEnabled(false);
        _scene->effects->addEffect(mappings);
        const osg::ref_ptr<CloseUps> closeUps = new CloseUps;
        closeUps->addCloseUp(new CloseUp);
        closeUps->setEnabled(false);
        _scene->effects->addEffect(closeUps);
        _map->setEnabled(false);
        _scene->effects->addEffect(_map);
        EffectPreset::write(*_scene->effects, {{"usual", {{"birdsEyeView.focusLine", "0.4"}}}});
        viewer().setSceneData(_scene->node);
    }

    /// As the program does it.
    void setUpViewer()
    {
        int argc = 1;
        char name[] = "osggeofx_viewer";
        char* argv[] = {name, nullptr};
        osg::ArgumentParser arguments(&argc, argv);
        // Handlers of another set-up would answer the same keys, for manipulators that nobody has any more.
        viewer().getEventHandlers().clear();
        _manipulators = geofx::viewer::makeManipulators(arguments);
        geofx::viewer::addPanorama(*_manipulators, *_scene->effects);
        geofx::viewer::addHandlers(viewer(), *_scene, *_manipulators, _file);
        viewer().getCamera()->setProjectionMatrixAsPerspective(30.0, 1280.0 / 720.0, 1.0, 1e6);
        geofx::viewer::setHome(*_manipulators, *_scene, 30.0, 1280.0 / 720.0);
        geofx::viewer::setManipulators(viewer(), *_manipulators, *_scene->effects);
        for (const auto& handler : viewer().getEventHandlers())
            if (auto* page = dynamic_cast<HelpPage*>(handler.get())) _page = page;
        ASSERT_TRUE(_page);
        frame();
    }

    /// Names and lines, of the other side of the Earth, so that no picture has them.
    void addMap()
    {
        MapContents contents;
        MapName name;
        name.text = "Nowhere";
        name.places = {{-6378137.0, 0.0, 0.0}};
        contents.names = {name};
        contents.lines = {{"river", "", {{-6378137.0, 0.0, 0.0}, {-6378137.0, 100.0, 0.0}}}};
        _scene->node = contents.addTo(*_scene->effects, *_scene->node);
        viewer().setSceneData(_scene->node);
    }

    /// What has keys of its own where it is there: names and lines, a sun with a time, and layers in time.
    void addAll()
    {
        addMap();
        const osg::ref_ptr<SunLight> sun = new SunLight;
        sun->setTime(*readClockTime("2026-06-21T07:30:00-10:00"));
        _scene->effects->addChild(sun);
        LayerPlayer::onto(*_scene->effects);
    }

    void press(int key)
    {
        viewer().getEventQueue()->keyPress(key);
        viewer().getEventQueue()->keyRelease(key);
        frame();
    }

    /// osgText updates its vertices in a buffer that it has told OpenGL is static, and Mesa says so.
    void frame()
    {
        for (const std::string& message : watch().messagesOf([&] { viewer().frame(); }))
            EXPECT_NE(message.find("GL_STATIC_DRAW"), std::string::npos) << message;
    }

    bool handles(osgGA::GUIEventHandler& handler, int key)
    {
        const osg::ref_ptr<Event> event = new Event;
        event->setEventType(Event::KEYDOWN);
        event->setKey(key);
        if (auto* closeUps = dynamic_cast<CloseUpHandler*>(&handler))
        {
            // It leaves the key to other effects' handlers, too.
            const CloseUpHandler::Mode before = closeUps->getMode();
            handler.handle(*event, viewer());
            return closeUps->getMode() != before;
        }
        return handler.handle(*event, viewer());
    }

    static bool isOurs(const osgGA::EventHandler& handler)
    {
        const std::string name = typeid(handler).name();
        return name.find("osgGeoFX") != std::string::npos || name.find("geofx") != std::string::npos;
    }

    /// The keys on all pages behind a key, as they are written there.
    std::vector<std::string> bindings(int key)
    {
        std::vector<std::string> result;
        while (_page->shown())
            press('h');
        press(key);
        for (std::size_t left = _page->pages(); left > 0; --left)
        {
            for (const std::string& line : _page->lines())
            {
                const std::size_t tab = line.find('\t');
                if (tab != std::string::npos) result.push_back(line.substr(0, tab));
            }
            press(key);
        }
        EXPECT_FALSE(_page->shown()) << "the last page is followed by none";
        return result;
    }

    std::vector<osg::ref_ptr<osgText::Text>> shownTexts()
    {
        ShownTexts texts;
        for (unsigned int i = 0; i < viewer().getNumSlaves(); ++i)
        {
            osg::Camera& camera = *viewer().getSlave(i)._camera;
            if (camera.getNodeMask() != 0) camera.accept(texts);
        }
        return texts.found;
    }

    /// Every text lies in the window, none on another, large enough to read, and no word is lost.
    void expectReadable(double width, double height)
    {
        const auto texts = shownTexts();
        ASSERT_GT(texts.size(), 3u);
        std::multiset<std::string> words;
        for (std::size_t i = 0; i < texts.size(); ++i)
        {
            const osg::BoundingBox& box = texts[i]->getBoundingBox();
            const std::string shown = wordsOf(*texts[i]);
            EXPECT_GE(box.xMin(), 0.0f) << shown;
            EXPECT_GE(box.yMin(), 0.0f) << shown;
            EXPECT_LE(static_cast<double>(box.xMax()), width) << shown;
            EXPECT_LE(static_cast<double>(box.yMax()), height) << shown;
            EXPECT_GE(static_cast<double>(texts[i]->getCharacterHeight()),
                      std::min(height / 45.0, width / 70.0))
                << shown;
            for (std::size_t k = 0; k < i; ++k)
            {
                const osg::BoundingBox& other = texts[k]->getBoundingBox();
                const bool apart = box.xMax() <= other.xMin() || other.xMax() <= box.xMin() ||
                                   box.yMax() <= other.yMin() || other.yMax() <= box.yMin();
                EXPECT_TRUE(apart) << "\"" << shown << "\" and \"" << wordsOf(*texts[k])
                                   << "\" lie on each other";
            }
            std::istringstream stream(shown);
            for (std::string word; stream >> word;)
                words.insert(word);
        }
        for (const std::string& line : _page->lines())
        {
            std::istringstream stream(line);
            for (std::string word; stream >> word;)
            {
                const auto found = words.find(word);
                EXPECT_TRUE(found != words.end()) << "\"" << word << "\" of \"" << line << "\" is not shown";
                if (found != words.end()) words.erase(found);
            }
        }
    }

    void keep(const std::string& name)
    {
        const char* folder = std::getenv("GEOFX_KEEP_PICTURES");
        if (!folder) return;
        const osg::ref_ptr<osg::Image> picture = new osg::Image;
        withContext([&](osg::State&) { picture->readPixels(0, 0, 1280, 720, GL_RGB, GL_UNSIGNED_BYTE); });
        osgDB::writeImageFile(*picture, std::string(folder) + "/" + name + ".png");
    }

    std::string _file; ///< what is shown
    geofx::test::TempDir _folder;
    std::optional<Scene> _scene;
    osg::ref_ptr<PanoramaMap> _map = new PanoramaMap;
    osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> _manipulators;
    HelpPage* _page = nullptr;
};

} // namespace

TEST_F(ViewerKeys, HelpPagesCanBeRead)
{
    addMap();
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    EXPECT_TRUE(shownTexts().empty());
    press('h');
    ASSERT_TRUE(_page->shown());
    EXPECT_EQ(_page->pages(), 1u) << "the program's own keys are on one page at 1280 × 720";
    EXPECT_EQ(_page->lines().front(), "Ground");
    expectReadable(1280.0, 720.0);
    keep("help-own");
    press('H');
    expectReadable(1280.0, 720.0);
    EXPECT_LE(_page->pages(), 2u);
    keep("help-osg");
    press('h');
    EXPECT_EQ(_page->lines().front(), "Ground") << "h shows the program's own from there, too";
    press('h');
    EXPECT_FALSE(_page->shown());
    EXPECT_TRUE(shownTexts().empty());
}

TEST_F(ViewerKeys, AnyTerrainBecomesAMapByAKey)
{
    auto* const bend = dynamic_cast<BirdsEyeView*>(_scene->effects->getEffect(0));
    bend->setEnabled(true);
    // Once with a map that the scene has, and once without one.
    for (const bool known : {true, false})
    {
        if (!known) _scene->effects->removeEffect(_map);
        ASSERT_NO_FATAL_FAILURE(setUpViewer());
        const auto find = [&]
        {
            PanoramaMap* found = nullptr;
            for (unsigned int i = 0; i < _scene->effects->getNumEffects(); ++i)
                if (auto* map = dynamic_cast<PanoramaMap*>(_scene->effects->getEffect(i))) found = map;
            return found;
        };
        ASSERT_EQ(find() != nullptr, known);
        press(Event::KEY_F11);
        PanoramaMap* map = nullptr;
        for (int i = 0; i < 600 && !(map && map->getEnabled()); ++i)
        {
            frame();
            OpenThreads::Thread::microSleep(100000);
            map = find();
        }
        ASSERT_TRUE(map && map->getEnabled());
        EXPECT_FALSE(bend->getEnabled()) << "a scene has one projection";
        frame();
        const auto* const manipulator =
            dynamic_cast<PanoramaManipulator*>(_manipulators->getCurrentMatrixManipulator());
        ASSERT_TRUE(manipulator);

        std::string error;
        const auto relief = TerrainRelief::read(*_scene->node, nullptr, 512, error);
        ASSERT_TRUE(relief) << error;
        PanoramaWishes wishes;
        wishes.aspect = 1280.0 / 720.0;
        const PanoramaComposition expected = PanoramaComposer(*relief, wishes).compose();
        EXPECT_EQ(map->getViewRadius(), expected.viewRadius);
        EXPECT_EQ(map->getExaggeration(), expected.exaggeration);
        EXPECT_NEAR(std::remainder(manipulator->getHeading() - expected.heading, 2.0 * osg::PI), 0.0, 1e-6);
        // The camera stands above the place.
        double eyeLongitude = 0.0, eyeLatitude = 0.0, height = 0.0;
        const osg::Vec3d eye = osg::Vec3d() * viewer().getCamera()->getInverseViewMatrix();
        ASSERT_TRUE(_scene->reference &&
                    _scene->reference->toGeodetic(eye, eyeLongitude, eyeLatitude, height));
        EXPECT_NEAR(osg::RadiansToDegrees(eyeLongitude), expected.place.x(), 1e-5);
        EXPECT_NEAR(osg::RadiansToDegrees(eyeLatitude), expected.place.y(), 1e-5);
        keep(known ? "automatic-known" : "automatic-new");
        bend->setEnabled(true);
    }
}

TEST_F(ViewerKeys, ATunedMapIsSavedAsASceneAndAsARecipe)
{
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    const osg::ref_ptr<geofx::viewer::MapSaver> saver = new geofx::viewer::MapSaver(*_scene, _file);
    EXPECT_NE(saver->save(viewer()).find("No panorama map is shown"), std::string::npos);
    _map->setEnabled(true);
    _map->setSeason(0.75);
    _map->setHorizonLine(0.7);
    _map->setLightAzimuth(0.5);
    _map->setEdge(PanoramaMap::HAZE);
    _map->setViewRadius(9000.0);
    _manipulators->selectMatrixManipulator(0); // key 0, the map's
    frame();
    const auto folder = std::filesystem::path(_file).parent_path();
    const std::string stem = std::filesystem::path(_file).stem().string();
    press(Event::KEY_F12);
    std::string saved = (folder / (stem + "-map.geofx")).string();
    // The scene that was saved, and one that was saved of it, are the same as what was shown.
    for (int turn = 0; turn < 2; ++turn)
    {
        std::string error;
        const std::optional<Scene> again = Scene::load(saved, error);
        ASSERT_TRUE(again) << error;
        const PanoramaMap* map = nullptr;
        for (unsigned int i = 0; i < again->effects->getNumEffects(); ++i)
            if (auto* each = dynamic_cast<PanoramaMap*>(again->effects->getEffect(i))) map = each;
        ASSERT_TRUE(map);
        for (const Property& property : map->properties())
            EXPECT_NEAR(property.get(*map), property.get(*_map), 1e-9) << property.name;
        const osg::Matrixd shown = viewer().getCamera()->getViewMatrix();
        const osg::Matrixd home = again->homeViewMatrix(osg::DegreesToRadians(30.0), 1280.0 / 720.0);
        const osg::Vec3d shownEye = osg::Vec3d() * osg::Matrixd::inverse(shown);
        EXPECT_LT((osg::Vec3d() * osg::Matrixd::inverse(home) - shownEye).length(), 0.1);
        const osg::Vec3d right = osg::Matrixd::transform3x3(osg::X_AXIS, osg::Matrixd::inverse(shown));
        EXPECT_NEAR(osg::Matrixd::transform3x3(osg::X_AXIS, osg::Matrixd::inverse(home)) * right, 1.0, 1e-9)
            << "the heading";
        const osg::ref_ptr<geofx::viewer::MapSaver> second = new geofx::viewer::MapSaver(*_scene, saved);
        const std::string said = second->save(viewer());
        saved = (folder / (std::filesystem::path(saved).stem().string() + "-map.geofx")).string();
        EXPECT_NE(said.find("Saved " + saved), std::string::npos) << said;
    }
    // Nothing is written over.
    press(Event::KEY_F12);
    EXPECT_TRUE(std::filesystem::exists(folder / (stem + "-map-2.geofx")));

    const geofx::panorama::Recipe recipe =
        geofx::panorama::Recipe::read((folder / (stem + "-map.json")).string());
    EXPECT_TRUE(std::filesystem::equivalent(recipe.terrain, _file));
    EXPECT_EQ(recipe.width, 1280);
    EXPECT_EQ(recipe.view.viewRadius, 9000.0);
    EXPECT_EQ(recipe.view.horizonLine, 0.7);
    EXPECT_EQ(recipe.map.at("season"), "0.75");
    EXPECT_EQ(recipe.map.at("edge"), "haze");
    EXPECT_EQ(recipe.map.count("horizonLine"), 0u);
    TerrainRelief frame;
    frame.geocentric = true;
    const osg::Matrixd ofRecipe = recipe.view.viewMatrix(frame);
    const osg::Vec3d right =
        osg::Matrixd::transform3x3(osg::X_AXIS, viewer().getCamera()->getInverseViewMatrix());
    EXPECT_NEAR(osg::Matrixd::transform3x3(osg::X_AXIS, osg::Matrixd::inverse(ofRecipe)) * right, 1.0, 1e-9);

    const osg::ref_ptr<geofx::viewer::MapSaver> nowhere =
        new geofx::viewer::MapSaver(*_scene, "/nowhere/at/all.osgb");
    EXPECT_NE(nowhere->save(viewer()).find("cannot be written"), std::string::npos);
}

TEST_F(ViewerKeys, LibertiesAreSavedWithAMap)
{
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    _map->setEnabled(true);
    _map->setViewRadius(9000.0);
    _manipulators->selectMatrixManipulator(0);
    frame();
    const osg::ref_ptr<geofx::viewer::MapSaver> saver = new geofx::viewer::MapSaver(*_scene, _file);
    const osg::ref_ptr<RegionalLiberty> liberty = new RegionalLiberty;
    liberty->setGeodeticCenter(osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude));
    liberty->setRadii(1500.0, 2500.0);
    liberty->setEnlarge(1.25);
    liberty->setTurn(osg::DegreesToRadians(12.0));
    addLiberty(*_scene->effects, *liberty);
    ASSERT_EQ(_scene->effects->getEffect(0), liberty) << "before the bend and the map";
    const auto folder = std::filesystem::path(_file).parent_path();
    const std::string stem = (folder / std::filesystem::path(_file).stem()).string();
    saver->save(viewer());
    std::string saved = stem + "-map.geofx";
    const auto recipe = geofx::panorama::Recipe::read(stem + "-map.json");
    ASSERT_EQ(recipe.liberties.size(), 1u);
    EXPECT_EQ(recipe.liberties[0].at("enlarge"), "1.25");
    EXPECT_EQ(recipe.liberties[0].at("turn"), "12");
    EXPECT_EQ(recipe.liberties[0].count("widen"), 0u);
    // The scene that was saved, and then one more liberty in it, and the first one removed.
    for (int turn = 0; turn < 3; ++turn)
    {
        SCOPED_TRACE(turn);
        std::string error;
        const std::optional<Scene> again = Scene::load(saved, error);
        ASSERT_TRUE(again) << error;
        std::vector<const RegionalLiberty*> liberties;
        const PanoramaMap* map = nullptr;
        for (unsigned int i = 0; i < again->effects->getNumEffects(); ++i)
        {
            const Effect* const each = again->effects->getEffect(i);
            if (const auto* one = dynamic_cast<const RegionalLiberty*>(each))
            {
                EXPECT_FALSE(map) << "liberties come first";
                liberties.push_back(one);
            }
            if (const auto* one = dynamic_cast<const PanoramaMap*>(each)) map = one;
        }
        ASSERT_TRUE(map);
        EXPECT_EQ(map->getViewRadius(), 9000.0);
        ASSERT_EQ(liberties.size(), turn == 1 ? 2u : 1u);
        EXPECT_NEAR(liberties[0]->getEnlarge(), turn < 2 ? 1.25 : 1.5, 1e-9);
        EXPECT_NEAR(liberties[0]->getLatitude(), osg::DegreesToRadians(latitude), 1e-9);
        EXPECT_NEAR(liberties[0]->getAlong(), turn < 2 ? 2500.0 : 2000.0, 1e-6);
        if (turn == 2) break;
        const osg::ref_ptr<geofx::viewer::MapSaver> next = new geofx::viewer::MapSaver(*again, saved);
        if (turn == 0)
        {
            const osg::ref_ptr<RegionalLiberty> more = new RegionalLiberty;
            more->setGeodeticCenter(osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude));
            more->setEnlarge(1.5);
            addLiberty(*again->effects, *more);
        }
        else
            again->effects->removeEffect(again->effects->getEffect(0));
        const std::string said = next->save(viewer());
        saved = (folder / (std::filesystem::path(saved).stem().string() + "-map.geofx")).string();
        EXPECT_NE(said.find("Saved " + saved), std::string::npos) << said;
    }
}

TEST_F(ViewerKeys, ABendingCurveIsDraggedAndSaved)
{
    _map->setEnabled(true);
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    const auto picture = [&]
    {
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        withContext([&](osg::State&) { image->readPixels(0, 0, 1280, 720, GL_RGB, GL_UNSIGNED_BYTE); });
        return image;
    };
    /// Pixels beside the panel that differ.
    const auto changed = [](const osg::Image& a, const osg::Image& b)
    {
        int count = 0;
        for (int y = 0; y < 720; ++y)
            for (int x = 0; x < 640; ++x)
                count += std::equal(a.data(x, y), a.data(x, y) + 3, b.data(x, y)) ? 0 : 1;
        return count;
    };
    _map->setRipples(0.0);
    // Until all tiles are there.
    osg::ref_ptr<osg::Image> before = picture();
    for (int i = 0, same = 0; i < 200 && same < 5; ++i)
    {
        OpenThreads::Thread::microSleep(50000);
        frame();
        const osg::ref_ptr<osg::Image> now = picture();
        same = changed(*before, *now) == 0 ? same + 1 : 0;
        before = now;
    }
    press(Event::KEY_F4);
    const auto texts = shownTexts();
    EXPECT_TRUE(std::any_of(texts.begin(), texts.end(),
                            [](const auto& text) { return wordsOf(*text) == "0 of 6 points"; }));
    EXPECT_EQ(changed(*before, *picture()), 0) << "the panel changes nothing beside it";
    keep("curve-none");

    // The graph's field lies from the word "base" to the word "horizon", above them.
    osg::Vec3d base, horizon;
    for (const auto& text : texts)
    {
        if (wordsOf(*text) == "base") base = text->getPosition();
        if (wordsOf(*text) == "horizon") horizon = text->getPosition();
    }
    ASSERT_GT(horizon.x(), base.x() + 100.0);
    auto& queue = *viewer().getEventQueue();
    const auto place = [&](double distance, double height)
    {
        // Thirteen heights of the text, above a line of text.
        const double size = 14.0;
        const double bottom = base.y() - 0.5 * (1.5 - 0.72) * size + 1.5 * size;
        return osg::Vec2d(base.x() + distance * (horizon.x() - base.x()),
                          bottom + height * _map->getHorizonLine() * 13.0 * size);
    };
    const auto from = place(0.5, _map->curveHeight(0.5)), to = place(0.4, 0.25);
    const osg::Matrixd stood = viewer().getCamera()->getViewMatrix();
    queue.mouseButtonPress(static_cast<float>(from.x()), static_cast<float>(from.y()), 1);
    frame();
    queue.mouseMotion(static_cast<float>(to.x()), static_cast<float>(to.y()));
    frame();
    ASSERT_EQ(_map->getCurvePoints().size(), 1u);
    EXPECT_NEAR(_map->getCurvePoints()[0].x(), 0.4, 5e-3);
    EXPECT_NEAR(_map->getCurvePoints()[0].y(), 0.25, 1e-2);
    frame();
    EXPECT_GT(changed(*before, *picture()), 2000) << "the map follows while the button is still down";
    queue.mouseButtonRelease(static_cast<float>(to.x()), static_cast<float>(to.y()), 1);
    frame();
    EXPECT_EQ(viewer().getCamera()->getViewMatrix(), stood) << "the camera does not";
    keep("curve-one");

    ASSERT_TRUE(_map->setHorizonExaggeration(3.5));
    press(Event::KEY_F12);
    const std::string stem = std::filesystem::path(_file).replace_extension().string() + "-map";
    std::string error;
    const std::optional<Scene> again = Scene::load(stem + ".geofx", error);
    ASSERT_TRUE(again) << error;
    const PanoramaMap* map = nullptr;
    for (unsigned int i = 0; i < again->effects->getNumEffects(); ++i)
        if (auto* each = dynamic_cast<PanoramaMap*>(again->effects->getEffect(i))) map = each;
    ASSERT_TRUE(map);
    EXPECT_EQ(map->getCurvePoints(), _map->getCurvePoints());
    EXPECT_EQ(map->getHorizonExaggeration(), 3.5);
    const auto recipe = geofx::panorama::Recipe::read(stem + ".json");
    EXPECT_EQ(recipe.map.at("horizonExaggeration"), "3.5");
    EXPECT_EQ(recipe.map.count("curve1Distance") + recipe.map.count("curve1Height"), 2u);

    press(Event::KEY_Delete);
    EXPECT_TRUE(_map->getCurvePoints().empty());
    _map->setHorizonExaggeration(-1.0);
    press(Event::KEY_F4);
    frame();
    EXPECT_EQ(changed(*before, *picture()), 0) << "all is as it was";
    _map->setEnabled(false);
    press(Event::KEY_F4);
    const auto sentence = shownTexts();
    EXPECT_TRUE(std::any_of(sentence.begin(), sentence.end(),
                            [](const auto& text)
                            { return wordsOf(*text) == "No panorama map is shown; F11 makes one."; }));
}

TEST_F(ViewerKeys, HelpPagesFollowTheWindow)
{
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    for (const int key : {'h', 'H'})
    {
        for (const auto& [width, height] : {std::pair(800, 600), {2560, 1440}, {480, 640}, {400, 200}})
        {
            SCOPED_TRACE(std::to_string(width) + " × " + std::to_string(height));
            viewer().getCamera()->setViewport(0, 0, width, height);
            frame();
            while (_page->shown())
                press(key);
            press(key);
            for (std::size_t left = _page->pages(); left > 0; --left)
            {
                expectReadable(width, height);
                press(key);
            }
        }
    }
    // While it is shown.
    viewer().getCamera()->setViewport(0, 0, 800, 600);
    press('h');
    viewer().getCamera()->setViewport(0, 0, 1280, 720);
    frame();
    expectReadable(1280.0, 720.0);
}

TEST_F(ViewerKeys, NamesAndLinesAreHiddenAndShown)
{
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    const auto has = [&](const std::string& key)
    {
        const std::vector<std::string> keys = bindings('h');
        return std::count(keys.begin(), keys.end(), key) == 1;
    };
    EXPECT_FALSE(has("n") || has("r")) << "there is nothing to show";
    viewer().getEventHandlers().clear();
    addMap();
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    EXPECT_TRUE(has("n") && has("r"));
    MapLabels* names = nullptr;
    for (unsigned int i = 0; i < _scene->node->asGroup()->getNumChildren(); ++i)
        if (auto* each = dynamic_cast<MapLabels*>(_scene->node->asGroup()->getChild(i))) names = each;
    MapLines* lines = nullptr;
    for (unsigned int i = 0; i < _scene->effects->getNumChildren(); ++i)
        if (auto* each = dynamic_cast<MapLines*>(_scene->effects->getChild(i))) lines = each;
    ASSERT_TRUE(names && lines);
    press('n');
    EXPECT_FALSE(names->isShown());
    EXPECT_TRUE(lines->isShown());
    press('r');
    EXPECT_FALSE(lines->isShown());
    press('n');
    EXPECT_TRUE(names->isShown());
    EXPECT_FALSE(lines->isShown());
    press('r');
    EXPECT_TRUE(names->isShown() && lines->isShown());
}

TEST_F(ViewerKeys, EachKeyThatAHandlerKnowsStandsOnAPage)
{
    addAll();
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    const std::vector<std::string> own = bindings('h');
    const std::vector<std::string> others = bindings('H');
    const auto stands = [](const std::vector<std::string>& page, const std::string& name)
    {
        return std::any_of(page.begin(), page.end(),
                           [&](const std::string& each) { return hasKey(each, name); });
    };
    int known = 0;
    for (const auto& handler : viewer().getEventHandlers())
    {
        auto* each = dynamic_cast<osgGA::GUIEventHandler*>(handler.get());
        if (!each || each == _page) continue;
        if (isOurs(*each))
        {
            // The lists know more keys while they are shown.
            if (dynamic_cast<MappingPanel*>(each)) press(Event::KEY_F9);
            if (dynamic_cast<EffectPanel*>(each)) press(Event::KEY_F10);
            std::vector<int> keys = allKeys();
            // Those that hide what knows the others come last.
            std::stable_partition(keys.begin(), keys.end(),
                                  [](int key) { return key < Event::KEY_F1 || key > Event::KEY_F12; });
            for (const int key : keys)
            {
                if (!handles(*each, key)) continue;
                ++known;
                EXPECT_TRUE(stands(own, nameOf(key))) << nameOf(key) << " of " << typeid(*each).name();
            }
        }
        else
        {
            const osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
            each->getUsage(*usage);
            for (const auto& [key, text] : usage->getKeyboardMouseBindings())
            {
                ++known;
                EXPECT_EQ(std::count(others.begin(), others.end(), key), 1) << key << ": " << text;
                EXPECT_EQ(std::count(own.begin(), own.end(), key), 0) << key << ": " << text;
            }
        }
    }
    EXPECT_GT(known, 40);
    const osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
    _manipulators->getUsage(*usage);
    for (const auto& [key, text] : usage->getKeyboardMouseBindings())
    {
        // Ours stands below its own title.
        const std::string prefix = "Panorama: ";
        const bool isOwn = key.rfind(prefix, 0) == 0;
        const std::vector<std::string>& page = isOwn ? own : others;
        EXPECT_GE(std::count(page.begin(), page.end(), isOwn ? key.substr(prefix.size()) : key), 1)
            << key << ": " << text;
        EXPECT_TRUE(!isOwn || std::count(others.begin(), others.end(), key) == 0) << key << ": " << text;
    }
    // Mouse buttons have no key to try.
    EXPECT_TRUE(stands(own, "Ctrl + left button"));
    EXPECT_TRUE(stands(own, "Shift + left button"));
    EXPECT_TRUE(stands(own, "left button"));
    // The page's own, on the last one.
    press('h');
    for (std::size_t page = 1; page < _page->pages(); ++page)
        press('h');
    const auto texts = shownTexts();
    EXPECT_TRUE(std::any_of(texts.begin(), texts.end(),
                            [](const auto& text)
                            { return wordsOf(*text) == "h  close      H  keys of OpenSceneGraph"; }));
}

TEST_F(ViewerKeys, NoKeyHasTwoMeanings)
{
    addAll();
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    std::map<std::string, std::string> owners;
    const auto add = [&](const std::string& key, const std::string& owner)
    {
        const auto [found, isNew] = owners.emplace(key, owner);
        EXPECT_TRUE(isNew || found->second == owner)
            << key << " belongs to " << found->second << " and to " << owner;
    };
    for (const auto& handler : viewer().getEventHandlers())
    {
        auto* each = dynamic_cast<osgGA::GUIEventHandler*>(handler.get());
        ASSERT_TRUE(each);
        const std::string name = typeid(*each).name();
        if (isOurs(*each))
        {
            for (const int key : allKeys())
            {
                if (!handles(*each, key)) continue;
                add(std::string(1, static_cast<char>(key)) + nameOf(key), name);
                // Lists are hidden again.
                if (key == Event::KEY_F4 || key >= Event::KEY_F9) handles(*each, key);
            }
            continue;
        }
        const osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
        each->getUsage(*usage);
        for (const auto& [key, text] : usage->getKeyboardMouseBindings())
            if (key.size() == 1) add(key + key, name);
    }
    for (const auto& [key, manipulator] : _manipulators->getKeyManipMap())
        add(std::string(2, static_cast<char>(key)), "the choice of manipulators");
    EXPECT_EQ(owners.count("cc"), 1u) << "osgviewer's key for pictures of the window";
    EXPECT_EQ(owners.count("gg"), 1u);
}

TEST_F(ViewerKeys, EveryManipulatorComesHome)
{
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    const GeographicLib::Geocentric earth(GeographicLib::Constants::WGS84_a(),
                                          GeographicLib::Constants::WGS84_f());
    const GeographicLib::LocalCartesian local(latitude, longitude, eyeHeight, earth);
    const auto inWorld = [&](const osg::Vec3d& place)
    {
        double lat = 0.0;
        double lon = 0.0;
        double h = 0.0;
        osg::Vec3d world;
        local.Reverse(place.x(), place.y(), place.z(), lat, lon, h);
        earth.Forward(lat, lon, h, world.x(), world.y(), world.z());
        return world;
    };
    const double turn = osg::DegreesToRadians(heading);
    const double rise = osg::DegreesToRadians(pitch);
    const osg::Vec3d eye = inWorld({});
    const osg::Vec3d ahead = inWorld({1000.0 * std::sin(turn) * std::cos(rise),
                                      1000.0 * std::cos(turn) * std::cos(rise), 1000.0 * std::sin(rise)}) -
                             eye;
    const osg::Vec3d right = inWorld({1000.0 * std::cos(turn), -1000.0 * std::sin(turn), 0.0}) - eye;

    const std::pair<int, const char*> all[] = {
        {'1', "TrackballManipulator"}, {'2', "FlightManipulator"}, {'3', "Drive"},
        {'4', "TerrainManipulator"},   {'5', "OrbitManipulator"},  {'6', "FirstPersonManipulator"},
        {'7', "Spherical Manipulator"}};
    EXPECT_STREQ(_manipulators->getCurrentMatrixManipulator()->className(), "TerrainManipulator");
    for (const auto& [key, name] : all)
    {
        SCOPED_TRACE(name);
        press(key);
        EXPECT_STREQ(_manipulators->getCurrentMatrixManipulator()->className(), name);
        // OSG's spherical manipulator goes by the world's axes, and misses any home on a globe.
        if (key == '7') continue;
        // From somewhere else.
        viewer().getCameraManipulator()->setByMatrix(osg::Matrixd::translate(eye * 1.2));
        press(' ');
        const osg::Matrixd view = viewer().getCamera()->getViewMatrix();
        const osg::Matrixd camera = osg::Matrixd::inverse(view);
        EXPECT_LT((camera.getTrans() - eye).length(), 1.0);
        const osg::Vec3d seen = osg::Matrixd::transform3x3(ahead / ahead.length(), view);
        EXPECT_LT((seen - osg::Vec3d(0.0, 0.0, -1.0)).length(), 1e-3)
            << seen.x() << " " << seen.y() << " " << seen.z();
        const osg::Vec3d across = osg::Matrixd::transform3x3(right / right.length(), view);
        EXPECT_LT((across - osg::Vec3d(1.0, 0.0, 0.0)).length(), 1e-3);
    }
}

TEST_F(ViewerKeys, APanoramaMapBeginsWithItsManipulator)
{
    _map->setEnabled(true);
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    EXPECT_TRUE(dynamic_cast<PanoramaManipulator*>(_manipulators->getCurrentMatrixManipulator()));
    press('4');
    EXPECT_STREQ(_manipulators->getCurrentMatrixManipulator()->className(), "TerrainManipulator");
    press('0');
    EXPECT_TRUE(dynamic_cast<PanoramaManipulator*>(_manipulators->getCurrentMatrixManipulator()));
}

TEST_F(ViewerKeys, WithoutAHomeViewTheWholeSceneIsSeen)
{
    _scene->settings.homeView.reset();
    ASSERT_NO_FATAL_FAILURE(setUpViewer());
    press(' ');
    const osg::Matrixd toClip =
        viewer().getCamera()->getViewMatrix() * osg::Matrixd::perspective(30.0, 1280.0 / 720.0, 1.0, 1e6);
    // The corners of the terrain lie in the picture, and not all near its middle.
    double farthest = 0.0;
    const GeographicLib::Geocentric earth(GeographicLib::Constants::WGS84_a(),
                                          GeographicLib::Constants::WGS84_f());
    ASSERT_TRUE(_scene->terrain);
    for (const double lon : {_scene->terrain->west, _scene->terrain->east})
    {
        for (const double lat : {_scene->terrain->south, _scene->terrain->north})
        {
            osg::Vec3d world;
            earth.Forward(lat, lon, _scene->terrain->minHeight, world.x(), world.y(), world.z());
            const osg::Vec3d clip = world * toClip;
            farthest = std::max({farthest, std::abs(clip.x()), std::abs(clip.y())});
        }
    }
    EXPECT_LT(farthest, 1.0);
    EXPECT_GT(farthest, 0.4);
}
