// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/GeofxPlugins.h>
#include <tools/NotifyWatch.h>
#include <tools/PropertySamples.h>
#include <tools/TempDir.h>

#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cctype>
#include <fstream>
#include <iterator>

namespace geofx::test
{

inline const std::vector<std::string> formats = {".osgt", ".osgb", ".osgx"};

inline std::string nameInFiles(std::string name)
{
    name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    return name;
}

inline std::string contentOf(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// What OSG has to say fails a test, unless the test asks for it.
class Serializers : public GeofxPlugins
{
protected:
    const TempDir _folder;
    NotifyWatch _watch;

    /// Writes an object and reads it again.
    template<typename Class>
    osg::ref_ptr<Class> throughFile(const Class& object, const std::string& format)
    {
        const std::string file = (_folder / ("object" + format)).string();
        EXPECT_TRUE(osgDB::writeObjectFile(object, file));
        const osg::ref_ptr<osg::Object> read = osgDB::readRefObjectFile(file);
        osg::ref_ptr<Class> result = dynamic_cast<Class*>(read.get());
        EXPECT_TRUE(result) << format;
        return result;
    }

    /// What an ASCII file with an object gives that has these lines.
    osg::ref_ptr<osgGeoFX::PropertyHolder> fromLines(const std::string& className, const std::string& lines)
    {
        const auto file =
            _folder.write("lines.osgt", "#Ascii Object\n#Version 161\n#Generator OpenSceneGraph 3.6.5\n\n" +
                                            className + " {\n  UniqueID 1\n" + lines + "}\n");
        const osg::ref_ptr<osg::Object> read = osgDB::readRefObjectFile(file.string());
        return dynamic_cast<osgGeoFX::PropertyHolder*>(read.get());
    }
};

/// A scene with every kind of effect, and a building below it.
inline osg::ref_ptr<osgGeoFX::EffectScene> fullScene()
{
    osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->setName("a scene");
    for (const std::string& kind : osgGeoFX::effectKinds())
        scene->addEffect(alteredEffect(kind));
    scene->setDebugBounds(true);
    const osg::ref_ptr<osgGeoFX::RigidReference> building = new osgGeoFX::RigidReference;
    building->setTurn(false);
    building->addChild(new osg::MatrixTransform);
    scene->addChild(building);
    return scene;
}

inline void expectFullScene(osgGeoFX::EffectScene& scene)
{
    const std::vector<std::string> kinds = osgGeoFX::effectKinds();
    EXPECT_EQ(scene.getName(), "a scene");
    EXPECT_TRUE(scene.getDebugBounds());
    EXPECT_TRUE(scene.getCompensation());
    EXPECT_FALSE(scene.isCullingActive() && scene.getCullingActive());
    ASSERT_EQ(scene.getNumEffects(), kinds.size());
    for (unsigned int i = 0; i < kinds.size(); ++i)
    {
        EXPECT_EQ(osgGeoFX::kindOf(*scene.getEffect(i)), kinds[i]) << "the order stays";
        expectSame(*scene.getEffect(i), *alteredEffect(kinds[i]));
    }
    ASSERT_EQ(scene.getNumChildren(), 1u);
    const auto* building = dynamic_cast<const osgGeoFX::RigidReference*>(scene.getChild(0));
    ASSERT_TRUE(building);
    EXPECT_FALSE(building->getTurn());
    ASSERT_EQ(building->getNumChildren(), 1u);
    EXPECT_TRUE(dynamic_cast<const osg::MatrixTransform*>(building->getChild(0)));
}

} // namespace geofx::test
