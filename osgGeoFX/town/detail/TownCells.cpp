// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/TownCells.h>

#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/terrain/detail/TileFile.h>
#include <osgGeoFX/town/detail/BlockMaker.h>
#include <osgGeoFX/town/detail/BuildingMesh.h>

#include <osg/MatrixTransform>
#include <osg/PagedLOD>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace osgGeoFX
{

namespace
{

// Metres.
constexpr double SMALLEST_CELL = 128.0;
constexpr int WIDEST = 4; ///< times this: the smallest grid where there are not too many buildings
constexpr std::size_t MOST_IN_CELL = 1200;
/// What a level must show, metres, and how many pixels it has from where the level is drawn on.
constexpr double WINDOW = 1.5, WINDOW_PIXELS = 2.0;
constexpr double HOUSE = 10.0, HOUSE_PIXELS = 4.0;
constexpr double BLOCK = 60.0, BLOCK_PIXELS = 4.0;
/// Walls reach so far below the drawn ground in any case.
constexpr double LEAST_DEPTH = 0.5;
/// Of a middle cell's cells along its side, and a large cell's middle ones.
constexpr int FINER = 4;
/// Of the shade around buildings. What a level is off by is less than a pixel from where it is drawn.
constexpr ContactShade::Fineness DETAIL_SHADE = {12.0, 1.0 / 32.0}, SINGLE_SHADE = {40.0, 1.0 / 8.0},
                                 BLOCKS_SHADE = {40.0, 0.5};
/// Bounds are floats in the world.
constexpr double ROUNDING = 2.0;

std::string nameOf(int x, int y)
{
    return std::to_string(x) + "/" + std::to_string(y);
}

std::string fileOf(const std::string& kind, int x, int y)
{
    return kind + "/" + nameOf(x, y) + ".osgb";
}

} // namespace

/// How a building stands on the drawn ground, heights of the database.
struct TownCells::Standing
{
    osg::Vec2d reference;
    double base = 0.0, lowest = 0.0, top = 0.0;
};

TownCells::TownCells(const TownGrid& grid, const TerrainInfo& terrain, const osg::Node& root,
                     std::string folder, std::string output, bool ambientOcclusion)
    : _grid(grid), _root(&root), _folder(std::move(folder)), _output(std::move(output)),
      _ambientOcclusion(ambientOcclusion), _spool(std::make_unique<BuildingSpool>(_output + "/outlines"))
{
    const osg::Vec2d metres = grid.metres(0.5 * (grid.south() + grid.north()));
    _cell.set(SMALLEST_CELL / metres.x(), SMALLEST_CELL / metres.y());
    const double pixels = std::max(terrain.pixelsPerRadian, 1.0);
    const auto level = [&](double size, double wanted, double cells)
    {
        Level result;
        result.range = size * pixels / wanted;
        // The ground that is drawn at this distance and at the cell's far side is off by a pixel error at most.
        result.depth =
            LEAST_DEPTH + (result.range + cells * SMALLEST_CELL * WIDEST * 1.5) * terrain.pixelError / pixels;
        return result;
    };
    _detail = level(WINDOW, WINDOW_PIXELS, 1.0);
    _single = level(HOUSE, HOUSE_PIXELS, FINER);
    _blocks = level(BLOCK, BLOCK_PIXELS, FINER * FINER);
}

TownCells::~TownCells() = default;

bool TownCells::add(const Building& building)
{
    const osg::Vec2d middle = ringMiddle(building.rings.front());
    if (!_grid.contains(middle)) return false;
    const auto cell = [](double from, double size)
    {
        return static_cast<std::int32_t>(std::floor(from / size));
    };
    _entries.push_back({cell(middle.x() - _grid.west(), _cell.x()),
                        cell(middle.y() - _grid.south(), _cell.y()), _spool->add(building)});
    return true;
}

void TownCells::finishReading()
{
    _spool->finish();
    // Wide cells, unless they would have too many buildings.
    for (_across = WIDEST; _across > 1; _across /= 2)
    {
        std::map<std::pair<int, int>, std::size_t> counts;
        std::size_t most = 0;
        for (const Entry& each : _entries)
            most = std::max(most, ++counts[{each.x / _across, each.y / _across}]);
        if (most <= MOST_IN_CELL) break;
    }
    const auto key = [this](const Entry& each)
    {
        const int x = each.x / _across, y = each.y / _across;
        return std::make_tuple(y / FINER, x / FINER, y, x, each.place);
    };
    std::sort(_entries.begin(), _entries.end(),
              [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
    for (std::size_t i = 0; i < _entries.size(); ++i)
    {
        const int x = _entries[i].x / _across / FINER, y = _entries[i].y / _across / FINER;
        if (_units.empty() || _units.back().x != x || _units.back().y != y) _units.push_back({x, y, i, i});
        _units.back().last = i + 1;
    }
    _made.resize(_units.size());
    for (std::size_t i = 0; i < _units.size(); ++i)
    {
        LargeCell& cell = _large[largeOf(_units[i])];
        cell.units.push_back(i);
        ++cell.left;
    }
}

/// The middle of a cell that is `size` of the smallest grid's wide, in the grid's coordinates.
osg::Vec2d TownCells::middleOf(int x, int y, int size) const
{
    const double width = size * _across;
    return {_grid.west() + (x + 0.5) * width * _cell.x(), _grid.south() + (y + 0.5) * width * _cell.y()};
}

bool TownCells::stand(DrawnGround& ground, const Building& building, Standing& standing) const
{
    const Ring& outline = building.rings.front();
    standing.reference = ringMiddle(outline);
    const std::optional<double> middle = ground.at(standing.reference);
    const osg::Vec2d metres = _grid.metres(standing.reference.y());
    constexpr double step = 12.0; // metres; the ground is coarser
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
        const osg::Vec2d side = outline[(i + 1) % outline.size()] - outline[i];
        const double length = osg::componentMultiply(side, metres).length();
        const int parts = std::clamp(static_cast<int>(std::ceil(length / step)), 1, 1000);
        for (int part = 0; part < parts; ++part)
        {
            const std::optional<double> height =
                ground.at(outline[i] + side * (static_cast<double>(part) / parts));
            if (!height) continue;
            lowest = std::min(lowest, *height);
            highest = std::max(highest, *height);
        }
    }
    if (!middle && !(lowest <= highest)) return false;
    standing.base = middle.value_or(0.5 * (lowest + highest));
    standing.lowest = std::min(lowest, standing.base);
    // On a steep slope a low roof would be in the ground.
    constexpr double above = 2.0;
    standing.top = std::max(standing.base + building.height,
                            highest > -HUGE_VAL ? highest + std::min(above, building.height) : -HUGE_VAL);
    return true;
}

PlacedBuilding TownCells::place(const Building& building, const Standing& standing,
                                const osg::Matrixd& toLocal) const
{
    PlacedBuilding result;
    result.reference = _grid.toWorld(standing.reference, standing.base) * toLocal;
    for (const Ring& ring : building.rings)
    {
        Ring local;
        for (const osg::Vec2d& place : ring)
        {
            const osg::Vec3d here = _grid.toWorld(place, standing.base) * toLocal;
            local.emplace_back(here.x(), here.y());
        }
        result.area += ringArea(local);
        result.rings.push_back(std::move(local));
    }
    result.raised = building.bottom > 0.0;
    result.foot = result.reference.z() + standing.lowest - standing.base + building.bottom;
    result.top = result.reference.z() + standing.top - standing.base;
    result.use = building.use;
    result.gabled = building.gabled;
    // From its place, so that it looks the same whatever else there is. A centimetre is a hundred-millionth of a degree or so.
    const double scale = _grid.geocentric() ? 1e7 : 1e2;
    const auto x = static_cast<std::uint64_t>(std::llround(standing.reference.x() * scale));
    const auto y = static_cast<std::uint64_t>(std::llround(standing.reference.y() * scale));
    result.seed = static_cast<std::uint32_t>((x * 0x9e3779b97f4a7c15ull ^ y * 0xc2b2ae3d27d4eb4full) >> 32);
    return result;
}

void TownCells::Drawn::expand(osg::BoundingBoxd& box, const osg::Matrixd& matrix) const
{
    for (const auto& each : {buildings, shade})
        for (unsigned int i = 0; each && i < 8; ++i)
            box.expandBy(osg::Vec3d(each->getBoundingBox().corner(i)) * matrix);
}

void TownCells::Drawn::addTo(osg::Group& group) const
{
    for (const auto& each : {buildings, shade})
        if (each) group.addChild(each);
}

ContactShade::Ground TownCells::groundIn(DrawnGround& ground, const osg::Matrixd& frame) const
{
    return [this, &ground, frame, back = osg::Matrixd::inverse(frame)](const osg::Vec2d& at, double otherwise)
    {
        const osg::Vec3d place = _grid.fromWorld(osg::Vec3d(at, otherwise) * frame);
        const std::optional<double> height = ground.at({place.x(), place.y()});
        return height ? (_grid.toWorld({place.x(), place.y()}, *height) * back).z() : otherwise;
    };
}

/// A cell's node: what it draws from a range on, and the finer file within it. The box is around both, in the frame.
osg::ref_ptr<osg::Node> TownCells::cellNode(const osg::Matrixd& frame, const Drawn& drawn,
                                            const osg::BoundingBoxd& box, const std::string& finer,
                                            double range) const
{
    osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
    lod->setRangeMode(osg::LOD::DISTANCE_FROM_EYE_POINT);
    lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    lod->setCenter(osg::Vec3(box.center() * frame));
    const double radius = box.radius() + ROUNDING;
    lod->setRadius(static_cast<float>(radius));
    const auto within = static_cast<float>(range + radius);
    unsigned int number = 0;
    if (drawn.buildings)
    {
        osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(frame);
        drawn.addTo(*transform);
        lod->addChild(transform, within, std::numeric_limits<float>::max());
        lod->setNumChildrenThatCannotBeExpired(1);
        number = 1;
    }
    lod->setFileName(number, finer);
    lod->setRange(number, 0.0f, within);
    return lod;
}

void TownCells::addNeighbours(DrawnGround& ground, std::size_t index, const osg::Matrixd& toUnit,
                              Openness& openness) const
{
    const Unit& unit = _units[index];
    // One of the smallest cells around the unit's: the reach, and half of a building.
    const int side = FINER * _across, west = unit.x * side - 1, south = unit.y * side - 1;
    static_assert(SMALLEST_CELL > 2.0 * Openness::reach);
    for (int y = unit.y - 1; y <= unit.y + 1; ++y)
        for (int x = unit.x - 1; x <= unit.x + 1; ++x)
        {
            if (x == unit.x && y == unit.y) continue;
            const auto found = std::find_if(_units.begin(), _units.end(),
                                            [&](const Unit& each) { return each.x == x && each.y == y; });
            if (found == _units.end()) continue;
            for (std::size_t i = found->first; i < found->last; ++i)
            {
                const Entry& entry = _entries[i];
                if (entry.x < west || entry.x > west + side + 1 || entry.y < south ||
                    entry.y > south + side + 1)
                    continue;
                const Building building = _spool->read(entry.place);
                Standing standing;
                standing.reference = ringMiddle(building.rings.front());
                const std::optional<double> height = ground.at(standing.reference);
                if (!height) continue;
                standing.base = standing.lowest = *height;
                standing.top = *height + building.height;
                openness.add(place(building, standing, toUnit));
            }
        }
}

void TownCells::write(const osg::Node& node, const std::string& kind, int x, int y) const
{
    writeNodeAtomically(node, _output + "/buildings/" + fileOf(kind, x, y));
}

void TownCells::build(int worker, std::size_t index)
{
    DrawnGround* ground = nullptr;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        auto& own = _grounds[worker];
        if (!own) own = std::make_unique<DrawnGround>(_grid, *_root, _folder);
        ground = own.get();
    }
    const Unit& unit = _units[index];
    const osg::Matrixd frame = _grid.frameAt(middleOf(unit.x, unit.y, FINER));
    const osg::Matrixd toUnit = osg::Matrixd::inverse(frame);
    std::vector<PlacedBuilding> all;
    // All of the unit stand before any is drawn, for one darkens another.
    std::vector<std::optional<Standing>> standings(unit.last - unit.first);
    Openness openness;
    for (std::size_t i = unit.first; i < unit.last; ++i)
    {
        const Building building = _spool->read(_entries[i].place);
        Standing standing;
        if (!stand(*ground, building, standing))
        {
            ++_outside;
            continue;
        }
        ++_buildings;
        for (std::size_t bit = 0; bit < _notes.size(); ++bit)
            if (building.notes & (1u << bit)) ++_notes[bit];
        standings[i - unit.first] = standing;
        all.push_back(place(building, standing, toUnit));
        if (_ambientOcclusion) openness.add(all.back());
    }
    if (_ambientOcclusion) addNeighbours(*ground, index, toUnit, openness);
    // One for the files of this unit: whoever writes a state set is no other thread.
    const osg::ref_ptr<osg::StateSet> shadeState = GroundShade::createState();
    std::size_t number = 0;
    osg::BoundingBoxd box;
    osg::ref_ptr<osg::Group> singles = new osg::Group;
    for (std::size_t first = unit.first; first < unit.last;)
    {
        const int x = _entries[first].x / _across, y = _entries[first].y / _across;
        std::size_t last = first;
        while (last < unit.last && _entries[last].x / _across == x && _entries[last].y / _across == y)
            ++last;
        const osg::Matrixd cellFrame = _grid.frameAt(middleOf(x, y, 1)),
                           toCell = osg::Matrixd::inverse(cellFrame);
        const osg::Matrixd fromCell = cellFrame * toUnit;
        const Openness* around = _ambientOcclusion ? &openness : nullptr;
        BuildingMesh detail(_detail.depth, around, fromCell), single(_single.depth, around, fromCell);
        const ContactShade::Ground onGround = groundIn(*ground, cellFrame);
        ContactShade nearShade(onGround, DETAIL_SHADE), farShade(onGround, SINGLE_SHADE);
        for (std::size_t i = first; i < last; ++i)
        {
            const std::optional<Standing>& standing = standings[i - unit.first];
            if (!standing) continue;
            const PlacedBuilding placed = place(_spool->read(_entries[i].place), *standing, toCell);
            detail.add(placed, BuildingLevel::DETAIL, number);
            const PlacedBuilding simple = simplified(placed, 1.0);
            single.add(simple, BuildingLevel::SINGLE, number);
            ++number;
            if (!_ambientOcclusion || placed.raised) continue;
            nearShade.add(placed);
            farShade.add(simple);
        }
        first = last;
        const Drawn fine = {detail.create(), nearShade.create(shadeState)},
                    coarse = {single.create(), farShade.create(shadeState)};
        if (!fine.buildings || !coarse.buildings) continue;
        osg::BoundingBoxd cellBox;
        for (const Drawn& each : {fine, coarse})
        {
            each.expand(cellBox, osg::Matrixd());
            each.expand(box, cellFrame * toUnit);
        }
        osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(cellFrame);
        transform->setName("buildings " + nameOf(x, y));
        fine.addTo(*transform);
        write(*transform, "detail", x, y);
        singles->addChild(
            cellNode(cellFrame, coarse, cellBox, "../../" + fileOf("detail", x, y), _detail.range));
    }
    if (singles->getNumChildren() == 0)
    {
        finishUnit(index);
        return;
    }
    write(*singles, "single", unit.x, unit.y);
    const std::vector<PlacedBuilding> blocks = makeBlocks(all);
    Openness ofBlocks;
    if (_ambientOcclusion)
        for (const PlacedBuilding& block : blocks)
            ofBlocks.add(block);
    BuildingMesh mesh(_blocks.depth, _ambientOcclusion ? &ofBlocks : nullptr);
    ContactShade shade(groundIn(*ground, frame), BLOCKS_SHADE);
    for (std::size_t i = 0; i < blocks.size(); ++i)
    {
        mesh.add(blocks[i], BuildingLevel::SINGLE, i);
        if (_ambientOcclusion) shade.add(blocks[i]);
    }
    const Drawn drawn = {mesh.create(), shade.create(shadeState)};
    drawn.expand(box, osg::Matrixd());
    const osg::ref_ptr<osg::Node> node =
        cellNode(frame, drawn, box, "../../" + fileOf("single", unit.x, unit.y), _single.range);
    _made[index] = node;
    finishUnit(index);
}

TownCells::LargeKey TownCells::largeOf(const Unit& unit) const
{
    return {unit.y / FINER, unit.x / FINER};
}

void TownCells::finishUnit(std::size_t index)
{
    const LargeKey key = largeOf(_units[index]);
    LargeCell* large = nullptr;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        large = &_large[key];
        if (--large->left > 0) return;
    }
    // No other unit looks at this cell any more.
    const auto& [y, x] = key;
    const osg::Matrixd frame = _grid.frameAt(middleOf(x, y, FINER * FINER)),
                       toCell = osg::Matrixd::inverse(frame);
    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::BoundingBoxd box;
    for (const std::size_t unit : large->units)
    {
        if (!_made[unit]) continue;
        group->addChild(_made[unit]);
        const osg::BoundingSphere ball = _made[unit]->getBound();
        const osg::Vec3d middle = osg::Vec3d(ball.center()) * toCell;
        const double radius = static_cast<double>(ball.radius());
        box.expandBy(middle - osg::Vec3d(radius, radius, radius));
        box.expandBy(middle + osg::Vec3d(radius, radius, radius));
        _made[unit] = nullptr;
    }
    if (group->getNumChildren() == 0) return;
    write(*group, "blocks", x, y);
    large->node = cellNode(frame, {}, box, "buildings/" + fileOf("blocks", x, y), _blocks.range);
}

std::uint64_t TownCells::noted(Building::Note note) const
{
    std::size_t bit = 0;
    while ((1u << bit) != static_cast<unsigned int>(note))
        ++bit;
    return _notes[bit];
}

osg::ref_ptr<osg::Group> TownCells::finish()
{
    osg::ref_ptr<osg::Group> town = new osg::Group;
    for (const auto& [key, cell] : _large)
        if (cell.node) town->addChild(cell.node);
    return town;
}

} // namespace osgGeoFX
