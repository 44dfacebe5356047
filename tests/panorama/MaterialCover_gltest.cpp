// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The ground of another engine, named by its materials, in a panorama map.
#include <osgGeoFX/panorama/MaterialCover.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/GlFixture.h>

#include <osg/Geometry>

#include <cmath>
#include <cstring>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 160;

/// A plain a metre above the sea, `cells` cells wide and long, between two values of x.
osg::ref_ptr<osg::Geometry> makePlain(const std::string& name, float left, float right)
{
    constexpr unsigned int cells = 24;
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array, normals = new osg::Vec3Array(1);
    const osg::ref_ptr<osg::DrawElementsUInt> corners = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int i = 0; i < (cells + 1) * (cells + 1); ++i)
    {
        const float x = static_cast<float>(i % (cells + 1)) / cells,
                    y = static_cast<float>(i / (cells + 1)) / cells;
        places->push_back({left + (right - left) * x, 60000.0f * y - 5000.0f, 1.0f});
        if (i % (cells + 1) == cells || i / (cells + 1) == cells) continue;
        for (const unsigned int corner : {i, i + 1, i + cells + 2, i, i + cells + 2, i + cells + 1})
            corners->push_back(corner);
    }
    (*normals)[0].set(0.0f, 0.0f, 1.0f);
    geometry->setVertexArray(places);
    geometry->setNormalArray(normals, osg::Array::BIND_OVERALL);
    geometry->addPrimitiveSet(corners);
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(false);
    geometry->setName(name);
    return geometry;
}

class MaterialPicture : public GlFixture
{
protected:
    MaterialPicture() : GlFixture(WIDTH, HEIGHT) {}

    osg::ref_ptr<osg::Image> draw(const std::vector<osg::ref_ptr<osg::Geometry>>& plains, bool named)
    {
        const osg::ref_ptr<osg::Group> ground = new osg::Group;
        for (const auto& each : plains)
            ground->addChild(each);
        if (named) makeCover()->apply(*ground);
        return draw(*ground, false);
    }
    static osg::ref_ptr<MaterialCover> makeCover()
    {
        const osg::ref_ptr<MaterialCover> cover = new MaterialCover;
        cover->setCover("Ocean", {0.0, 0.0, 0.0, true});
        cover->setCover("Forest", {1.0, 0.0, 0.0, false});
        cover->setCover("Glacier", {0.0, 0.0, 1.0, false});
        return cover;
    }
    osg::ref_ptr<osg::Image> draw(osg::Group& ground, bool strokes)
    {
        const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setStrokes(strokes);
        map->setRipples(0.0); // they move
        map->setViewRadius(10000.0);
        map->setEdge(PanoramaMap::SEA);
        _scene = new EffectScene;
        _scene->setTerrainFrame(EffectScene::PROJECTED);
        _scene->addEffect(map);
        _scene->addChild(&ground);
        osg::Camera& camera = *viewer().getCamera();
        camera.setViewMatrixAsLookAt(osg::Vec3d(0.0, 0.0, 8000.0), osg::Vec3d(0.0, 8000.0, 0.0),
                                     osg::Vec3d(0.0, 0.0, 1.0));
        camera.setProjectionMatrixAsPerspective(40.0, static_cast<double>(WIDTH) / HEIGHT, 10.0, 1e5);
        return render(_scene);
    }

    /// The mean of a color in the lower left or right of the picture, 0…255.
    static osg::Vec3d colorOf(const osg::Image& image, bool right)
    {
        osg::Vec3d sum;
        int count = 0;
        for (int y = HEIGHT / 8; y < HEIGHT / 2; ++y)
        {
            for (int x = WIDTH / 8; x < 3 * WIDTH / 8; ++x, ++count)
            {
                const unsigned char* bytes = image.data(
                    static_cast<unsigned int>(x + (right ? WIDTH / 2 : 0)), static_cast<unsigned int>(y));
                sum += osg::Vec3d(bytes[0], bytes[1], bytes[2]);
            }
        }
        return sum / count;
    }

    /// How many pixels differ.
    static int differing(const osg::Image& a, const osg::Image& b)
    {
        int count = 0;
        for (unsigned int y = 0; y < HEIGHT; ++y)
            for (unsigned int x = 0; x < WIDTH; ++x)
                count += std::memcmp(a.data(x, y), b.data(x, y), 3) != 0 ? 1 : 0;
        return count;
    }

private:
    osg::ref_ptr<EffectScene> _scene;
};

} // namespace

TEST_F(MaterialPicture, TheirSeaLooksAsOurs)
{
    const auto land = []
    {
        return makePlain("Forest", 0.0f, 40000.0f);
    };
    const auto sea = []
    {
        return makePlain("Ocean", -40000.0f, 0.0f);
    };
    const osg::ref_ptr<osg::Image> ours = draw({land()}, true);
    const osg::ref_ptr<osg::Image> theirs = draw({land(), sea()}, true);
    const osg::ref_ptr<osg::Image> unnamed = draw({land(), sea()}, false);
    EXPECT_GT(colorOf(*ours, false).z(), colorOf(*ours, false).x() + 20.0) << "a sea is blue";
    // The ripples are where the mesh is, not where the sky is: only the mean is the same.
    EXPECT_LT((colorOf(*theirs, false) - colorOf(*ours, false)).length(), 12.0);
    EXPECT_GT((colorOf(*unnamed, false) - colorOf(*ours, false)).length(), 40.0)
        << "a plain a metre high was land";
}

TEST_F(MaterialPicture, ForestsAndIceArePaintedByTheirNames)
{
    const osg::ref_ptr<osg::Image> both =
        draw({makePlain("Forest", -40000.0f, 0.0f), makePlain("Glacier", 0.0f, 40000.0f)}, true);
    const osg::ref_ptr<osg::Image> none =
        draw({makePlain("Forest", -40000.0f, 0.0f), makePlain("Glacier", 0.0f, 40000.0f)}, false);
    const osg::Vec3d forest = colorOf(*both, false), ice = colorOf(*both, true);
    EXPECT_GT(ice.length(), forest.length() + 60.0) << "ice is light and forest dark";
    EXPECT_GT(forest.y(), forest.x()) << "green";
    EXPECT_LT((colorOf(*none, false) - colorOf(*none, true)).length(), 20.0)
        << "without names both are fields";
}

TEST_F(MaterialPicture, TreesStandInAForestWhicheverNodeHasItsName)
{
    const auto picture = [&](bool above, bool strokes, bool painted)
    {
        const osg::ref_ptr<osg::Group> node = new osg::Group, ground = new osg::Group;
        node->addChild(makePlain(above ? "" : "Forest", -40000.0f, 40000.0f));
        ground->addChild(node);
        if (above) node->setName("Forest");
        makeCover()->apply(*ground);
        if (!painted) node->getOrCreateStateSet()->setDefine("GEOFX_PAINTED", osg::StateAttribute::OFF);
        return draw(*ground, strokes);
    };
    const osg::ref_ptr<osg::Image> own = picture(false, true, true), bare = picture(false, false, true);
    EXPECT_GT(differing(*own, *bare), 1000) << "trees";
    EXPECT_EQ(differing(*picture(true, true, true), *own), 0);
    EXPECT_EQ(differing(*picture(true, true, false), *picture(true, false, false)), 0)
        << "no trees on what keeps its look";
}

TEST_F(MaterialPicture, ObjectsKeepTheirLookWhereThatIsWanted)
{
    // A red wall on the ground, without a name.
    const auto picture = [&](bool keep)
    {
        const osg::ref_ptr<osg::Geometry> wall = makePlain("", -40000.0f, 0.0f);
        for (osg::Vec3& place : static_cast<osg::Vec3Array&>(*wall->getVertexArray()))
            place.z() = 2.0f;
        const osg::ref_ptr<osg::Vec4Array> red = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
        red->front().set(1.0f, 0.0f, 0.0f, 1.0f);
        wall->setColorArray(red);
        const osg::ref_ptr<osg::Group> ground = new osg::Group, objects = new osg::Group;
        ground->addChild(makePlain("Forest", -40000.0f, 40000.0f));
        ground->addChild(objects);
        objects->addChild(wall);
        objects->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        const osg::ref_ptr<MaterialCover> cover = makeCover();
        cover->setKeepsObjects(keep);
        cover->apply(*ground);
        return draw(*ground, false);
    };
    const osg::Vec3d kept = colorOf(*picture(true), false), painted = colorOf(*picture(false), false);
    EXPECT_LT((kept - osg::Vec3d(255.0, 0.0, 0.0)).length(), 1.0);
    EXPECT_GT(painted.y(), painted.x()) << "green";
}
