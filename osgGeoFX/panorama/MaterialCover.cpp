// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/MaterialCover.h>

#include <osgGeoFX/effect/GlslFunctions.h>

#include <osg/Image>
#include <osg/Material>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/PagedLOD>
#include <osg/ProxyNode>

#include <algorithm>
#include <cmath>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// One texel, which stays the same at any coordinates.
osg::ref_ptr<osg::Texture2D> makeTexture(const GroundCover& cover)
{
    // As deep as the sea that the map paints where no terrain is, or far inland.
    const double farthest = 1e9;
    const double shore = cover.water ? farthest : -glsl::GEOFX_SHORE_SCALE;
    const glsl::Rgba texel = glsl::geofx_coverTexel({cover.trees, cover.town, cover.bare, shore});
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 4; ++i)
        image->data()[i] = static_cast<unsigned char>(std::lround(255.0 * texel[i]));
    const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture->setUnRefImageDataAfterApply(false);
    return texture;
}

bool isShare(double value)
{
    return value >= 0.0 && value <= 1.0;
}

} // namespace

/// Gives covers to what has a name, and tells what else holds no ground.
class MaterialCover::Visitor : public osg::NodeVisitor
{
public:
    explicit Visitor(MaterialCover& cover) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _cover(cover)
    {
        setNodeMaskOverride(~0u);
    }

    void apply(osg::Node& node) override { visit(node, false); }
    // What is not there yet may be ground.
    void apply(osg::PagedLOD& node) override { visit(node, true); }
    void apply(osg::ProxyNode& node) override { visit(node, true); }

    /// Objects beside ground, each the topmost node that has none; to be called after the traversal.
    const std::vector<osg::ref_ptr<osg::Node>>& objects() const { return _objects; }

    static osg::StateSet& ownState(osg::Node& node)
    {
        const osg::StateSet* shared = node.getStateSet();
        if (shared && shared->getNumParents() > 1)
            node.setStateSet(osg::clone(shared, osg::CopyOp::SHALLOW_COPY));
        return *node.getOrCreateStateSet();
    }

private:
    void visit(osg::Node& node, bool mayHoldGround)
    {
        bool ground = false;
        if (const Entry* entry = _cover.entryOf(node, ground))
            ownState(node).setTextureAttribute(_cover._unit, entry->texture);
        const bool former = _ground;
        const std::size_t first = _objects.size();
        _ground = ground || mayHoldGround;
        traverse(node);
        // All below what has a name is ground, and where there is none below it, the node is one object.
        if (ground || !_ground) _objects.resize(first);
        if (!_ground) _objects.emplace_back(&node);
        _ground = _ground || former;
    }

    MaterialCover& _cover;
    bool _ground = false; ///< whether the current node, or what has been seen beside it, holds ground
    std::vector<osg::ref_ptr<osg::Node>> _objects;
};

MaterialCover::~MaterialCover() = default;

bool MaterialCover::setCover(const std::string& material, const GroundCover& cover)
{
    if (material.empty() || !isShare(cover.trees) || !isShare(cover.town) || !isShare(cover.bare))
    {
        OSG_WARN << "osgGeoFX: MaterialCover::setCover: the material \"" << material
                 << "\" needs a name, and trees, town and bare from 0 to 1. What was known of it stays."
                 << std::endl;
        return false;
    }
    _entries[material] = {cover, makeTexture(cover)};
    return true;
}

const GroundCover* MaterialCover::getCover(const std::string& material) const
{
    const auto found = _entries.find(material);
    return found == _entries.end() ? nullptr : &found->second.cover;
}

const MaterialCover::Entry* MaterialCover::entryOf(const osg::Node& node, bool& ground)
{
    const auto known = [&](const std::string& name)
    {
        const auto found = _entries.find(name);
        ground = ground || found != _entries.end();
        return found == _entries.end() ? nullptr : &found->second;
    };
    if (_naming)
    {
        const std::string name = _naming(node);
        ground = !name.empty();
        const Entry* entry = name.empty() ? nullptr : known(name);
        if (entry || name.empty()) return entry;
        const std::lock_guard<std::mutex> lock(_mutex);
        _unknown.insert(name);
        return nullptr;
    }
    if (const Entry* entry = known(node.getName())) return entry;
    const osg::StateSet* state = node.getStateSet();
    if (!state) return nullptr;
    if (const Entry* entry = known(state->getName())) return entry;
    const osg::StateAttribute* material = state->getAttribute(osg::StateAttribute::MATERIAL);
    return material ? known(material->getName()) : nullptr;
}

void MaterialCover::apply(osg::Node& node)
{
    Visitor visitor(*this);
    node.accept(visitor);
    if (!_keepsObjects) return;
    for (const osg::ref_ptr<osg::Node>& each : visitor.objects())
        Visitor::ownState(*each).setDefine("GEOFX_PAINTED", osg::StateAttribute::OFF);
}

std::set<std::string> MaterialCover::unknownMaterials() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _unknown;
}

} // namespace osgGeoFX
