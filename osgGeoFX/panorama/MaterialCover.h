// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/TileGuard.h>

#include <osg/Node>
#include <osg/Texture2D>
#include <osg/ref_ptr>

#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>

namespace osgGeoFX
{

/// What lies on ground of one material.
/// @ingroup panorama
struct GroundCover
{
    double trees = 0.0; ///< share of the ground under trees, 0…1
    double town = 0.0;  ///< share of the ground under buildings, 0…1
    double bare = 0.0;  ///< 0 fields, 0.5 bare ground, 1 permanent ice
    bool water = false;
};

/** Tells a PanoramaMap what lies on the ground of other engines, by the names of their materials.

    The kit's tiles have a texture that says so. Other engines cut their ground by materials, with names such as
    "EvergreenForest". Each node with a known name gets a texture of one texel, on the unit of PanoramaMap::coverUnit. Forests,
    towns, ice and water are then painted as such; water is as deep as the sea that the map paints where
    no terrain is. Ground with unknown names is painted by its height and slope, as before.

    A node's name is, by default, the first known one of: its own name, that of its state set, and that of its osg::Material.
    Nodes below it inherit, and may have names of their own. Engines that keep materials elsewhere need setNaming(). SimGear
    has them in its EffectGeode.

    @code
    osg::ref_ptr<osgGeoFX::MaterialCover> cover = osgGeoFX::readMaterialCover("flightgear"); // of osgGeoFXData
    cover->apply(*terrain);                                      // what is loaded
    osgGeoFX::TileGuard::install(terrain)->addListener(cover);   // and what a pager reads from now on
    @endcode

    **Threads.** apply() changes state sets, so no other thread may draw or read the subgraph meanwhile. As a TileListener it
    works on the threads of pagers. A state set that several nodes share is copied for the node. Settings are made before.

    @ingroup panorama */
class OSGGEOFX_EXPORT MaterialCover : public TileListener
{
public:
    explicit MaterialCover(unsigned int unit = 7) : _unit(unit) {}

    /// Sets what lies on a material. False, with a warning, where a share is not from 0 to 1 or the name is empty.
    bool setCover(const std::string& material, const GroundCover& cover);
    /// Null where the material is not known.
    const GroundCover* getCover(const std::string& material) const;

    /// The name of a node's material; empty where it has none. It is called on the threads of pagers.
    using Naming = std::function<std::string(const osg::Node& node)>;
    /// Sets how names are found; null is the default way.
    void setNaming(Naming naming) { _naming = std::move(naming); }

    /// Whether objects, such as trees, houses and lamps, keep their look in panorama maps; false by default: they are
    /// painted, too, as if they were ground. An object is what has no name, holds nothing that has one, and is not below
    /// one. With setNaming(), names that are not known are names, too, so ground of unknown kind is painted.
    void setKeepsObjects(bool on) { _keepsObjects = on; }
    bool getKeepsObjects() const { return _keepsObjects; }

    /// Gives a node and all below it their covers.
    void apply(osg::Node& node);
    void tileRead(osg::Node& tile) override { apply(tile); }

    /// The names that a naming told and that are not known. The default way tells none, as names may be of anything.
    std::set<std::string> unknownMaterials() const;

protected:
    ~MaterialCover() override;

private:
    class Visitor;
    struct Entry
    {
        GroundCover cover;
        osg::ref_ptr<osg::Texture2D> texture;
    };
    /// `ground`: becomes true where the node is ground, of whatever kind.
    const Entry* entryOf(const osg::Node& node, bool& ground);

    const unsigned int _unit;
    bool _keepsObjects = false;
    Naming _naming;
    std::map<std::string, Entry> _entries;
    mutable std::mutex _mutex;
    std::set<std::string> _unknown;
};

} // namespace osgGeoFX
