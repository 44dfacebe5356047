// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osg/ValueObject>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <typeinfo>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

class FindTerrain : public osg::NodeVisitor
{
public:
    FindTerrain() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Node& node) override
    {
        if (!found) traverse(node);
    }
    void apply(osg::CoordinateSystemNode& node) override
    {
        if (!found && node.getName() == "osgGeoFX terrain") found = &node;
        apply(static_cast<osg::Node&>(node));
    }

    void apply(osg::LOD&) override
    {
        // No terrain's root is below one, and a whole terrain may be.
    }

    const osg::Node* found = nullptr;
};

/// A vertex of a mesh.
struct Vertex
{
    const osg::Geometry* mesh;
    unsigned int index;
};

/// The values that vertices have in one of their meshes' arrays, which `of` finds.
template<typename Of>
osg::ref_ptr<osg::Array> gathered(const std::vector<Vertex>& vertices, const Of& of)
{
    const osg::Array* first = of(*vertices.front().mesh);
    if (!first || first->getBinding() == osg::Array::BIND_OVERALL) return const_cast<osg::Array*>(first);
    osg::ref_ptr<osg::Array> result = static_cast<osg::Array*>(first->cloneType());
    result->setBinding(first->getBinding());
    result->setNormalize(first->getNormalize());
    result->resizeArray(static_cast<unsigned int>(vertices.size()));
    const std::size_t size = first->getElementSize();
    auto* to = static_cast<unsigned char*>(const_cast<GLvoid*>(result->getDataPointer()));
    for (const Vertex& vertex : vertices)
    {
        const osg::Array* source = of(*vertex.mesh);
        if (source && source->getType() == first->getType() && vertex.index < source->getNumElements())
            std::memcpy(to, source->getDataPointer(vertex.index), size);
        to += size;
    }
    return result;
}

/// The finest meshes of a tile's blocks.
class FindGround : public osg::NodeVisitor
{
public:
    FindGround() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::LOD& block) override
    {
        const osg::Vec2Array* meshes = TileInfo::meshesOf(block);
        if (!meshes || meshes->empty()) return;
        // The nearest one comes first.
        if (const osg::Geometry* mesh = block.getChild(0)->asGeometry())
            _meshes.emplace_back(mesh, static_cast<unsigned int>(meshes->front().y()));
        else
            block.getChild(0)->accept(*this);
    }

    void apply(osg::Geometry& mesh) override
    {
        // A tile that is one mesh.
        if (!_single) _single = &mesh;
    }

    osg::ref_ptr<osg::Geometry> ground() const
    {
        if (_meshes.empty()) return _single;
        std::vector<Vertex> vertices;
        std::unordered_map<const osg::Array*, std::unordered_map<unsigned int, unsigned int>> newIndices;
        osg::ref_ptr<osg::DrawElementsUInt> all = new osg::DrawElementsUInt(osg::PrimitiveSet::TRIANGLES);
        for (const auto& [mesh, indices] : _meshes)
        {
            auto& newIndex = newIndices[mesh->getVertexArray()];
            const osg::PrimitiveSet& set = *mesh->getPrimitiveSet(0);
            for (unsigned int i = 0; i < std::min(indices, set.getNumIndices()); ++i)
            {
                const auto [entry, isNew] =
                    newIndex.try_emplace(set.index(i), static_cast<unsigned int>(vertices.size()));
                if (isNew) vertices.push_back({mesh, set.index(i)});
                all->push_back(entry->second);
            }
        }
        osg::ref_ptr<osg::Geometry> result = new osg::Geometry;
        result->setUseDisplayList(false);
        result->setUseVertexBufferObjects(true);
        result->setStateSet(const_cast<osg::StateSet*>(_meshes.front().first->getStateSet()));
        result->addPrimitiveSet(all);
        if (vertices.empty()) return result;
        using Mesh = const osg::Geometry&;
        result->setVertexArray(gathered(vertices, [](Mesh mesh) { return mesh.getVertexArray(); }));
        result->setNormalArray(gathered(vertices, [](Mesh mesh) { return mesh.getNormalArray(); }));
        result->setColorArray(gathered(vertices, [](Mesh mesh) { return mesh.getColorArray(); }));
        for (unsigned int unit = 0; unit < _meshes.front().first->getNumTexCoordArrays(); ++unit)
            result->setTexCoordArray(
                unit, gathered(vertices, [unit](Mesh mesh) { return mesh.getTexCoordArray(unit); }));
        return result;
    }

private:
    std::vector<std::pair<const osg::Geometry*, unsigned int>>
        _meshes; ///< and how many indices the ground has
    osg::ref_ptr<osg::Geometry> _single;
};

} // namespace

std::optional<TerrainInfo> TerrainInfo::read(const osg::Node* node, std::string& error)
{
    FindTerrain finder;
    if (node) const_cast<osg::Node*>(node)->accept(finder);
    if (!finder.found)
    {
        return std::nullopt;
    }
    const osg::Node& root = *finder.found;
    TerrainInfo info;
    std::string kind;
    if (root.getUserValue("geofx.format", info.format) && info.format > newestFormat)
    {
        error = "The terrain database is of format " + std::to_string(info.format) +
                ", which is newer than this program; use a newer osgGeoFX.";
        return std::nullopt;
    }
    if (info.format >= 1 && info.format < newestFormat)
    {
        error = "The terrain database is of format " + std::to_string(info.format) +
                ", which older versions of osgGeoFX built; build it again with osggeofx_build.";
        return std::nullopt;
    }
    const bool complete =
        info.format >= 1 && root.getUserValue("geofx.kind", kind) &&
        root.getUserValue("geofx.west", info.west) && root.getUserValue("geofx.south", info.south) &&
        root.getUserValue("geofx.east", info.east) && root.getUserValue("geofx.north", info.north) &&
        root.getUserValue("geofx.minHeight", info.minHeight) &&
        root.getUserValue("geofx.maxHeight", info.maxHeight) &&
        root.getUserValue("geofx.pixelsPerRadian", info.pixelsPerRadian) &&
        root.getUserValue("geofx.pixelError", info.pixelError) &&
        root.getUserValue("geofx.levels", info.levels) && root.getUserValue("geofx.vertical", info.vertical);
    if (!complete || (kind != "geocentric" && kind != "projected"))
    {
        error = "The terrain database's description of itself is incomplete; build it again.";
        return std::nullopt;
    }
    root.getUserValue("geofx.tileCells", info.tileCells);
    root.getUserValue("geofx.filledShare", info.filledShare);
    const osg::UserDataContainer* data = root.getUserDataContainer();
    const auto* mask =
        dynamic_cast<const osg::UByteArray*>(data ? data->getUserObject("geofx.filledMask") : nullptr);
    if (mask && root.getUserValue("geofx.filledMaskColumns", info.filledMaskColumns) &&
        info.filledMaskColumns > 0 && mask->size() >= static_cast<std::size_t>(info.filledMaskColumns))
        info.filledMask = mask;
    info.root = finder.found;
    info.geocentric = kind == "geocentric";
    return info;
}

double TerrainInfo::filledAt(double x, double y) const
{
    if (!filledMask || !(x >= west && x <= east && y >= south && y <= north)) return 0.0;
    const auto cell = [](double share, std::size_t cells)
    {
        return std::min(static_cast<std::size_t>(share * static_cast<double>(cells)), cells - 1);
    };
    const auto columns = static_cast<std::size_t>(filledMaskColumns), rows = filledMask->size() / columns;
    return (*filledMask)[cell((y - south) / (north - south), rows) * columns +
                         cell((x - west) / (east - west), columns)] /
           255.0;
}

bool TileInfo::isTile(const osg::Node& node)
{
    return node.getName().compare(0, 5, "tile ") == 0 && node.asTransform() != nullptr;
}

const osg::Transform* TileInfo::coarseOf(const osg::LOD& node)
{
    if (node.getNumChildren() == 0 || node.getNumRanges() < 2) return nullptr;
    const osg::Transform* tile = node.getChild(0)->asTransform();
    return tile && isTile(*tile) ? tile : nullptr;
}

std::optional<TileInfo> TileInfo::read(const osg::Node& node)
{
    TileInfo info;
    int used = 0;
    const std::string& name = node.getName();
    if (!isTile(node) ||
        std::sscanf(name.c_str(), "tile %d/%d/%d%n", &info.level, &info.x, &info.y, &used) != 3 ||
        static_cast<std::size_t>(used) != name.size() || !node.getUserValue("geofx.boxMin", info.boxMin) ||
        !node.getUserValue("geofx.boxMax", info.boxMax))
    {
        return std::nullopt;
    }
    node.getUserValue("geofx.cells", info.cells);
    return info;
}

bool TileInfo::readBox(const osg::Transform& tile, osg::BoundingBoxd& box)
{
    const osg::UserDataContainer* data = tile.getUserDataContainer();
    if (!data || data->getNumUserObjects() < 2) return false;
    // The builder writes these two first.
    const auto* low = dynamic_cast<const osg::Vec3dValueObject*>(data->getUserObject(0));
    const auto* high = dynamic_cast<const osg::Vec3dValueObject*>(data->getUserObject(1));
    if (!low || !high) return false;
    box._min = low->getValue();
    box._max = high->getValue();
    return box.valid();
}

const osg::Vec2Array* TileInfo::meshesOf(const osg::LOD& block)
{
    // Asked for each block in each cull: a dynamic_cast takes several times as long.
    const osg::Referenced* data = block.getUserData();
    const auto* meshes =
        data && typeid(*data) == typeid(osg::Vec2Array) ? static_cast<const osg::Vec2Array*>(data) : nullptr;
    return meshes && meshes->size() == block.getNumChildren() ? meshes : nullptr;
}

unsigned int TileInfo::groundIndices(const osg::Geometry& geometry)
{
    constexpr unsigned int all = std::numeric_limits<unsigned int>::max();
    const osg::LOD* block =
        geometry.getNumParents() > 0 ? dynamic_cast<const osg::LOD*>(geometry.getParent(0)) : nullptr;
    const osg::Vec2Array* meshes = block ? meshesOf(*block) : nullptr;
    return meshes ? static_cast<unsigned int>((*meshes)[block->getChildIndex(&geometry)].y()) : all;
}

const osg::Transform* TileInfo::tileOf(const osg::Geometry& mesh)
{
    const osg::LOD* block =
        mesh.getNumParents() > 0 ? dynamic_cast<const osg::LOD*>(mesh.getParent(0)) : nullptr;
    if (!block || !meshesOf(*block)) return nullptr;
    for (const osg::Node* node = block; node; node = node->getNumParents() > 0 ? node->getParent(0) : nullptr)
        if (isTile(*node)) return node->asTransform();
    return nullptr;
}

osg::ref_ptr<osg::Geometry> TileInfo::ground(const osg::Transform& tile)
{
    FindGround finder;
    for (unsigned int i = 0; i < tile.getNumChildren(); ++i)
        const_cast<osg::Node*>(tile.getChild(i))->accept(finder);
    return finder.ground();
}

const osg::Geometry* TileInfo::firstMesh(const osg::Transform& tile)
{
    const osg::Node* node = &tile;
    while (node && !node->asGeometry())
    {
        const osg::Group* group = node->asGroup();
        const auto* block = dynamic_cast<const osg::LOD*>(group);
        if (!group || group->getNumChildren() == 0) return nullptr;
        // The last one of a block is a mesh of its own.
        node = group->getChild(block ? group->getNumChildren() - 1 : 0);
    }
    return node ? node->asGeometry() : nullptr;
}

float lodScaleFor(const TerrainInfo& info, double pixelsPerRadian)
{
    return static_cast<float>(std::min(1.0, info.pixelsPerRadian / pixelsPerRadian));
}

double pixelsPerRadian(double height, double fieldOfView)
{
    return height / (2.0 * std::tan(fieldOfView / 2.0));
}

} // namespace osgGeoFX
