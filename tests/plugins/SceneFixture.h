// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What tests of the scene file's effects have in common.
#pragma once

#include <geofx/SceneFile.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/GeofxPlugins.h>
#include <tools/NotifyWatch.h>
#include <tools/TempDir.h>

#include <osg/CoordinateSystemNode>
#include <osgDB/WriteFile>

#include <ostream>
#include <string>

namespace geofx::test
{

/// A mistake in a scene file, and what its message says.
struct SceneMistake
{
    const char* name;
    std::string inside;
    std::string begins; ///< behind the file's name: line and element
    std::string holds;
};

inline std::ostream& operator<<(std::ostream& stream, const SceneMistake& mistake)
{
    return stream << mistake.inside;
}

/// The parser refuses a scene with one message.
inline void expectMistake(const std::string& scene, const SceneMistake& mistake)
{
    NotifyWatch watch;
    osgGeoFX::SceneResult result;
    // What was refused may have something to say, too.
    watch.messagesOf([&] { result = osgGeoFX::parseScene(scene, "x.geofx", "/scenes"); });
    EXPECT_FALSE(result.scene);
    ASSERT_EQ(result.errors.size(), 1u) << testing::PrintToString(result.errors);
    const std::string& error = result.errors[0];
    EXPECT_EQ(error.rfind("x.geofx:" + mistake.begins, 0), 0u) << error;
    EXPECT_NE(error.find(mistake.holds), std::string::npos) << error;
    EXPECT_EQ(error.back(), '.') << error;
}

/// Scenes that are read through osgdb_geofx, in a folder with a terrain.
class SceneFiles : public GeofxPlugins
{
protected:
    /// A terrain of nothing but its coordinate system; 0: geocentric.
    static osg::ref_ptr<osg::CoordinateSystemNode> terrainOf(int epsg)
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
        if (epsg == 0)
            root->setEllipsoidModel(new osg::EllipsoidModel);
        else
            root->setCoordinateSystem(wktOf(epsg));
        root->setFormat("WKT");
        return root;
    }
    void saveTerrain(const osg::Node& terrain)
    {
        ASSERT_TRUE(osgDB::writeNodeFile(terrain, (_folder / "terrain.osgb").string()));
    }
    void setTerrain(int epsg) { saveTerrain(*terrainOf(epsg)); }

    /// The first effect of a scene; null, and a failure, where the scene cannot be read.
    template<typename Effect>
    Effect* effectOf(const std::string& scene)
    {
        const auto file = _folder.write("x.geofx", scene);
        osgDB::ReaderWriter::ReadResult result =
            osgDB::Registry::instance()->readNode(file.string(), nullptr);
        _scene = result.getNode();
        auto* effects = dynamic_cast<osgGeoFX::EffectScene*>(_scene.get());
        if (!effects) ADD_FAILURE() << result.message();
        return effects ? dynamic_cast<Effect*>(effects->getEffect(0)) : nullptr;
    }

    const TempDir _folder;
    NotifyWatch _watch;
    osg::ref_ptr<osg::Node> _scene;
};

} // namespace geofx::test
