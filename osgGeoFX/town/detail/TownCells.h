// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/detail/Building.h>
#include <osgGeoFX/town/detail/BuildingSpool.h>
#include <osgGeoFX/town/detail/ContactShade.h>
#include <osgGeoFX/town/detail/DrawnGround.h>
#include <osgGeoFX/town/detail/Openness.h>
#include <osgGeoFX/town/detail/TownFrame.h>

#include <osg/BoundingBox>
#include <osg/Geometry>
#include <osg/Group>

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** The files of a town: three grids of cells, each four times as wide as the one before.

    The smallest cells have their buildings in detail (`buildings/detail/X/Y.osgb`). A cell of the middle grid has a file with
    the single buildings of its 16 cells (`buildings/single`), each cell with its own range for the detail. A cell of the large
    grid has the blocks of its 16 (`buildings/blocks`). The root has a node for each large cell. A building belongs to the cell
    of its middle.

    First add() and finishReading() on one thread; then build() for each unit on any threads, with a worker's number each; then
    finish(). */
class TownCells
{
public:
    /// `folder`: of the database, whose ground is read; the town's files are written below `output`.
    TownCells(const TownGrid& grid, const TerrainInfo& terrain, const osg::Node& root, std::string folder,
              std::string output, bool ambientOcclusion);
    ~TownCells();

    /// False if it stands outside of the terrain's extent.
    bool add(const Building& building);
    void finishReading();
    std::size_t units() const { return _units.size(); }
    void build(int worker, std::size_t unit);
    /// The node of the whole town, which refers to the files of the large cells.
    osg::ref_ptr<osg::Group> finish();

    std::uint64_t buildings() const { return _buildings; }
    /// How many of them have a note (Building::Note).
    std::uint64_t noted(Building::Note note) const;
    std::uint64_t outside() const { return _outside; }

private:
    /// Where a building is: in which of the smallest cells there can be, and in the spool.
    struct Entry
    {
        std::int32_t x, y;
        std::uint64_t place;
    };
    /// The buildings of a cell of the middle grid.
    struct Unit
    {
        int x, y;
        std::size_t first, last;
    };
    /// What a level of cells is drawn like.
    struct Level
    {
        double range = 0.0; ///< from which distance to a cell's border on it is not drawn, metres
        double depth = 0.0; ///< of walls below the ground
    };
    struct Standing;
    /// What a level of a cell consists of. Null: nothing of it.
    struct Drawn
    {
        osg::ref_ptr<osg::Geometry> buildings, shade;
        void expand(osg::BoundingBoxd& box, const osg::Matrixd& matrix) const;
        void addTo(osg::Group& group) const;
    };

    /// A large cell, by its y and x.
    using LargeKey = std::pair<int, int>;
    struct LargeCell
    {
        std::vector<std::size_t> units;
        std::size_t left = 0;         ///< units that are not done
        osg::ref_ptr<osg::Node> node; ///< that refers to its file; null until then, and if it is empty
    };

    LargeKey largeOf(const Unit& unit) const;
    /// Writes the file of a unit's large cell if it was the last one of it, and lets its blocks go.
    void finishUnit(std::size_t index);
    osg::Vec2d middleOf(int x, int y, int size) const;
    /// The ground in a local frame, metres.
    ContactShade::Ground groundIn(DrawnGround& ground, const osg::Matrixd& frame) const;
    /// Adds the buildings of other units that may stand within the openness' reach.
    void addNeighbours(DrawnGround& ground, std::size_t index, const osg::Matrixd& toUnit,
                       Openness& openness) const;
    bool stand(DrawnGround& ground, const Building& building, Standing& standing) const;
    PlacedBuilding place(const Building& building, const Standing& standing,
                         const osg::Matrixd& toLocal) const;
    osg::ref_ptr<osg::Node> cellNode(const osg::Matrixd& frame, const Drawn& drawn,
                                     const osg::BoundingBoxd& box, const std::string& finer,
                                     double range) const;
    void write(const osg::Node& node, const std::string& kind, int x, int y) const;

    const TownGrid& _grid;
    const osg::ref_ptr<const osg::Node> _root;
    const std::string _folder, _output;
    const bool _ambientOcclusion;
    osg::Vec2d _cell; ///< the size of the smallest cells that there can be, in the grid's units
    int _across = 1;  ///< of these, along a cell of the smallest grid that there is
    Level _detail, _single, _blocks;
    std::unique_ptr<BuildingSpool> _spool;
    std::vector<Entry> _entries;
    std::vector<Unit> _units;
    std::mutex _mutex;
    std::map<int, std::unique_ptr<DrawnGround>> _grounds; ///< by worker
    std::vector<osg::ref_ptr<osg::Node>>
        _made; ///< by unit: its node in the file of its large cell, until that is written
    std::map<LargeKey, LargeCell> _large;
    std::atomic<std::uint64_t> _buildings{0}, _outside{0};
    std::array<std::atomic<std::uint64_t>, 8> _notes{}; ///< by their bits
};

} // namespace osgGeoFX
