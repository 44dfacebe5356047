// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/TerrainInfo.h>
#include <tools/PagedScene.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/Image>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/Texture2D>
#include <osg/ValueObject>
#include <osgDB/Options>
#include <osgDB/WriteFile>

#include <cfloat>
#include <cstring>
#include <stdexcept>
#include <string>

namespace geofx::test
{

namespace
{

struct Tile
{
    int level;
    int x;
    int y;

    double size() const { return 4000.0 / (1 << level); }
    osg::Vec3d center() const { return {-2000.0 + (x + 0.5) * size(), -2000.0 + (y + 0.5) * size(), 0.0}; }
    std::string name() const
    {
        return std::to_string(level) + "_" + std::to_string(x) + "_" + std::to_string(y) + ".osgb";
    }
};

osg::ref_ptr<osg::MatrixTransform> makeGeometry(const Tile& tile, const osg::Matrixd& placement)
{
    const osg::Vec4 colors[] = {osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f), osg::Vec4(0.0f, 1.0f, 0.0f, 1.0f),
                                osg::Vec4(0.0f, 0.0f, 1.0f, 1.0f)};
    const auto half = static_cast<float>(tile.size() / 2.0);
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    for (const auto& corner :
         {osg::Vec2(-half, -half), osg::Vec2(half, -half), osg::Vec2(half, half), osg::Vec2(-half, half)})
    {
        vertices->push_back(osg::Vec3(corner, 0.0f));
        // Of two texels, whose middles lie on the border.
        coordinates->push_back(
            osg::Vec2(corner.x() < 0.0f ? 0.25f : 0.75f, corner.y() < 0.0f ? 0.25f : 0.75f));
    }
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::memset(image->data(), 255, image->getTotalSizeInBytes());
    osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    color->push_back(colors[tile.level]);
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (const unsigned short index : {0, 1, 2, 0, 2, 3})
        triangles->push_back(index);
    geometry->setVertexArray(vertices);
    geometry->setColorArray(color);
    geometry->setTexCoordArray(0, coordinates);
    geometry->addPrimitiveSet(triangles);
    geometry->setUseVertexBufferObjects(true);
    geometry->getOrCreateStateSet()->setTextureAttribute(0, new osg::Texture2D(image));
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);

    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(osg::Matrixd::translate(tile.center()) * placement);
    transform->setName("tile " + std::to_string(tile.level) + "/" + std::to_string(tile.x) + "/" +
                       std::to_string(tile.y));
    transform->setUserValue("geofx.boxMin", osg::Vec3d(-tile.size() / 2.0, -tile.size() / 2.0, 0.0));
    transform->setUserValue("geofx.boxMax", osg::Vec3d(tile.size() / 2.0, tile.size() / 2.0, 0.0));
    transform->setUserValue("geofx.cells", 1);
    transform->addChild(geometry);
    return transform;
}

osg::ref_ptr<osg::Node> makeNode(const Tile& tile, const osg::Matrixd& placement)
{
    const osg::ref_ptr<osg::MatrixTransform> geometry = makeGeometry(tile, placement);
    if (tile.level == 2)
    {
        return geometry;
    }
    const float range = tile.level == 0 ? 100000.0f : 20000.0f;
    osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
    lod->setRangeMode(osg::LOD::DISTANCE_FROM_EYE_POINT);
    lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    lod->setCenter(tile.center() * placement);
    lod->setRadius(static_cast<float>(tile.size()));
    lod->addChild(geometry, range, FLT_MAX);
    lod->setFileName(1, (tile.level == 0 ? "tiles/" : "") + tile.name());
    lod->setRange(1, 0.0f, range);
    return lod;
}

void writeFile(const osg::Node& node, const std::filesystem::path& file)
{
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("Compressor=zlib WriteImageHint=IncludeData");
    if (!osgDB::writeNodeFile(node, file.string(), options.get()))
    {
        throw std::runtime_error("cannot write " + file.string());
    }
}

void writeBelow(const Tile& parent, const std::filesystem::path& folder, const osg::Matrixd& placement)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int i = 0; i < 4; ++i)
    {
        const Tile tile = {parent.level + 1, 2 * parent.x + i % 2, 2 * parent.y + i / 2};
        group->addChild(makeNode(tile, placement));
        if (tile.level < 2) writeBelow(tile, folder, placement);
    }
    writeFile(*group, folder / parent.name());
}

void describe(osg::CoordinateSystemNode& root)
{
    root.setName("osgGeoFX terrain");
    root.setUserValue("geofx.format", osgGeoFX::TerrainInfo::newestFormat);
    root.setUserValue("geofx.kind", std::string("geocentric"));
    root.setUserValue("geofx.west", -157.82);
    root.setUserValue("geofx.south", 21.38);
    root.setUserValue("geofx.east", -157.78);
    root.setUserValue("geofx.north", 21.42);
    root.setUserValue("geofx.minHeight", 100.0);
    root.setUserValue("geofx.maxHeight", 100.0);
    root.setUserValue("geofx.pixelsPerRadian", 2077.0);
    root.setUserValue("geofx.pixelError", 1.0);
    root.setUserValue("geofx.levels", 3);
    root.setUserValue("geofx.vertical", std::string("none"));
}

} // namespace

osg::Matrixd PagedScene::placement(Kind kind)
{
    osg::Matrixd matrix;
    if (kind == Kind::Geocentric)
    {
        const osg::ref_ptr<osg::EllipsoidModel> ellipsoid = new osg::EllipsoidModel;
        ellipsoid->computeLocalToWorldTransformFromLatLongHeight(
            osg::DegreesToRadians(21.4), osg::DegreesToRadians(-157.8), 100.0, matrix);
    }
    return matrix;
}

std::filesystem::path PagedScene::write(const std::filesystem::path& folder, Kind kind)
{
    std::filesystem::create_directories(folder / "tiles");
    const Tile whole = {0, 0, 0};
    writeBelow(whole, folder / "tiles", placement(kind));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    if (kind == Kind::Geocentric)
    {
        osg::ref_ptr<osg::CoordinateSystemNode> system = new osg::CoordinateSystemNode("WKT", "");
        system->setEllipsoidModel(new osg::EllipsoidModel);
        describe(*system);
        root = system;
    }
    root->addChild(makeNode(whole, placement(kind)));
    writeFile(*root, folder / "terrain.osgb");
    return folder / "terrain.osgb";
}

} // namespace geofx::test
