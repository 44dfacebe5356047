// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/DataLayer.h>
#include <osgGeoFX/mapping/detail/LayerAtlas.h>
#include <osgGeoFX/mapping/detail/MappingChanges.h>
#include <osgGeoFX/mapping/detail/MappingRecord.h>

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <unordered_set>

namespace osgGeoFX
{

/** Which data layers lie where in the pages of the texture array.

    A layer has a place for as long as some mapping uses it and there is room. Where there is not, the most important layers
    stay, and the others are left out until room is made. Users of a layer that moves are among the changes. For one thread at
    a time. */
class LayerResidency
{
public:
    /// One mapping's layers; null where it has none.
    struct Pair
    {
        osg::ref_ptr<DataLayer> layer, mask;
    };

    /// The changes must outlive it. There are no pages before the first reset().
    explicit LayerResidency(MappingChanges& changes) : _changes(changes) {}

    /// Pages anew: no layer has a place before the next update().
    void reset(int pageSide, int maxPages);
    /// A mapping has some layers in the place of others. One that is among both keeps its place, and its texels there.
    void use(ProjectiveMapping& user, const Pair& next, const Pair& former);
    /// Finds room for what is new, has another size, or was left out, and uploads what has changed.
    void update();

    /// Nothing for null, for a layer that no mapping uses, without a picture, and for one that is left out.
    std::optional<PlacedLayer> placed(const DataLayer* data) const;
    /// Layers that are in use, placed or not.
    std::size_t count() const { return _layers.size(); }
    /// Those of them with a picture that has no room.
    int leftOut() const { return _leftOut; }
    int pagesUsed() const { return _atlas.pages(); }

private:
    struct Layer
    {
        osg::ref_ptr<DataLayer> data; ///< the layer lives while it has users
        std::unordered_set<ProjectiveMapping*> users;
        bool seen = false;
        unsigned int revision = 0;
        unsigned int imageCount = 0;
        std::optional<PlacedLayer> placed;
        bool leftOut = false;
    };

    void leave(DataLayer* data, ProjectiveMapping& user);
    bool isStale(const Layer& layer) const;
    bool updateLayer(Layer& layer);
    std::shared_ptr<LayerPixels> pixelsOf(const Layer& layer) const;
    std::optional<LayerAtlas::Slot> findRoom(int side, const DataLayer& data);
    bool makeRoomFor(const DataLayer& data);
    void unplace(Layer& layer);

    MappingChanges& _changes;
    LayerAtlas _atlas{0, 0};
    int _pageSide = 0;
    std::map<const DataLayer*, Layer> _layers;
    int _leftOut = 0;
};

} // namespace osgGeoFX
