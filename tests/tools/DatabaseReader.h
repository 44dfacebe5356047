// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/Image>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/ValueObject>

#include <array>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace geofx::test
{

/// One tile of a built database as plain osgDB reads it.
struct DatabaseTile
{
    using Triangle = std::array<unsigned int, 3>;

    /// A piece of a wall, below one edge of the ground's border, in the tile's frame.
    struct Wall
    {
        std::array<osg::Vec3d, 2> top, bottom;
        unsigned int side = 0; ///< of its block: 0 south, 1 east, 2 north, 3 west
        bool border = false;   ///< along the tile's border, not between two of its blocks
    };

    /// A mesh of one of its blocks.
    struct Mesh
    {
        osg::ref_ptr<osg::LOD> block;
        osg::ref_ptr<osg::Geometry> geometry;
        double from = 0.0, to = 0.0; ///< metres from the block's center
        bool smallest = false;       ///< of a block that no finer ones stand in for
        std::vector<Triangle> ground;
        std::vector<Wall> walls;
        /// The cap between its ground and a pole, which is among the indices of the ground, and the walls of the cap.
        std::vector<Triangle> cap, capWalls;
        osg::Vec2 low, high; ///< texture coordinates of its ground's corners
    };

    int level = 0, x = 0, y = 0; ///< from the transform's name "tile level/x/y"
    std::string file;            ///< that it was read from
    osg::ref_ptr<osg::MatrixTransform> transform;
    osg::ref_ptr<osg::PagedLOD> lod; ///< null on the finest level
    osg::ref_ptr<osg::Geometry>
        geometry; ///< one of its meshes; null where a tile has ground on finer levels only
    std::vector<Mesh> meshes;
    std::vector<Triangle> surface;   ///< its finest meshes together, without walls
    std::vector<Wall> skirt;         ///< theirs
    std::vector<Triangle> cap;       ///< theirs
    std::vector<osg::Vec3> vertices; ///< of all its arrays, one after the other: triangles count in these
    std::vector<osg::Vec2> places;   ///< their texture coordinates

    osg::Vec3d local(unsigned int vertex) const { return vertices[vertex]; }
    /// In the world, multiplied in double.
    osg::Vec3d world(unsigned int vertex) const { return local(vertex) * transform->getMatrix(); }
    osg::Vec3d world(const osg::Vec3d& place) const { return place * transform->getMatrix(); }
    /// Where a texture coordinate lies on the tile, 0 to 1 from its south-west; nothing without a texture.
    osg::Vec2d share(const osg::Vec2& place) const;
    /// Image of a texture unit: 0 color, 1 land cover, 2 normals, 7 what lies on the ground; null without.
    const osg::Image* image(unsigned int unit) const;
};

/// A database's root file: what it says of itself.
class DatabaseRoot
{
public:
    explicit DatabaseRoot(const std::string& folder);

    template<typename T>
    T value(const std::string& name) const
    {
        T result{};
        if (!_node->getUserValue(name, result)) throw std::runtime_error("the root has no value " + name);
        return result;
    }
    double west() const { return value<double>("geofx.west"); }
    double south() const { return value<double>("geofx.south"); }
    double east() const { return value<double>("geofx.east"); }
    double north() const { return value<double>("geofx.north"); }
    int finestLevel() const { return value<int>("geofx.levels") - 1; }
    bool geocentric() const { return value<std::string>("geofx.kind") == "geocentric"; }

    /// Longitude and latitude (degrees, the longitude turned as the database has it) or easting and northing
    /// (metres), and height, of a place in the world; and back.
    osg::Vec3d fromWorld(const osg::Vec3d& world) const;
    osg::Vec3d toWorld(const osg::Vec3d& place) const;

private:
    osg::ref_ptr<osg::Node> _node;
};

/// Reads a whole database from DIR/terrain.osgb down, one file at a time, and calls for each tile, parents
/// before children. Throws std::runtime_error where a file is missing, unreadable or not as it should be.
void readDatabase(const std::string& folder, const std::function<void(const DatabaseTile&)>& visit);

/// All tiles of a small database.
std::vector<DatabaseTile> readTiles(const std::string& folder);

/// The finest level as one lattice over the extent, row 0 the southernmost.
struct FinestLevel
{
    explicit FinestLevel(const std::string& folder);

    int tileIntervals = 0;                         ///< of a finest tile
    int columns = 0, rows = 0;                     ///< posts
    double x0 = 0.0, y0 = 0.0, dx = 0.0, dy = 0.0; ///< as DatabaseRoot::fromWorld has it
    /// On the triangles; those of a plain leave posts out.
    std::vector<osg::Vec3d> world;
    std::vector<double> rounding; ///< by how much the place may be rounded, metres
    std::vector<bool> used;

    std::size_t index(int column, int row) const
    {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
};

} // namespace geofx::test
