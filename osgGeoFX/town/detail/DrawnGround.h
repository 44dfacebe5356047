// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/detail/TownFrame.h>

#include <osg/Node>

#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The ground of a finished database as it is drawn from nearby: the triangles of its finest tiles. It reads tiles when they are
    asked for and keeps a few of them. For one thread at a time. */
class DrawnGround
{
public:
    /// `root`: that of the database in `folder`.
    DrawnGround(const TownGrid& grid, const osg::Node& root, std::string folder);
    ~DrawnGround();

    /// The height of the ground at a place of the grid, metres; nothing where there is none. Throws BuildError if a tile cannot be
    /// read.
    std::optional<double> at(const osg::Vec2d& place);

private:
    class Surface;
    /// A tile of one of the database's files.
    struct Tile
    {
        osg::Vec3d center; ///< of a ball around it and all below it, in the world
        double radius = 0.0;
        std::string finer;                ///< the file of the finer tiles; empty for a finest one
        std::shared_ptr<Surface> surface; ///< of a finest one, while it is kept
    };
    using Tiles = std::vector<Tile>;

    static Tiles tilesOf(const osg::Node& node, const std::string& folder);
    Tiles& tilesIn(const std::string& file);
    std::optional<double> find(Tiles& tiles, const std::string& file, const osg::Vec2d& place,
                               const osg::Vec3d& low, const osg::Vec3d& up);
    const Surface& surfaceOf(Tiles& tiles, const std::string& file, std::size_t index);
    void makeSurfaces(Tiles& tiles, const osg::Node& node);

    const TownGrid& _grid;
    const osg::ref_ptr<const osg::Node> _root;
    const std::string _folder;
    Tiles _top;
    std::map<std::string, Tiles> _files;
    std::list<Tiles*> _kept; ///< whose surfaces are there; those asked for last come first
};

} // namespace osgGeoFX
