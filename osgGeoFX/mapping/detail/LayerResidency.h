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

/** The places of data layers in the pages of the texture array.

    A layer has a place while some mapping uses it and there is room. If there is not enough room, the most important
    layers stay. The others are left out until room is made. If a layer moves, its users are among the changes. For
    one thread at a time. */
class LayerResidency
{
public:
    /// One mapping's layers; null for none.
    struct Pair
    {
        osg::ref_ptr<DataLayer> layer, mask;
    };

    /// The changes must outlive this object. There are no pages before the first reset().
    explicit LayerResidency(MappingChanges& changes) : _changes(changes) {}

    /// Makes new pages. No layer has a place before the next update().
    void reset(int pageSide, int maxPages);
    /// A mapping replaces its layers. A layer that is in both pairs keeps its place and its texels.
    void use(ProjectiveMapping& user, const Pair& next, const Pair& former);
    /// Finds room for layers that are new, have another size, or were left out. Uploads what has changed.
    void update();

    /// The place of a layer. Nothing for null, for an unused layer, for one without a picture, and for one that is
    /// left out.
    std::optional<PlacedLayer> placed(const DataLayer* data) const;
    /// The number of layers in use, placed or not.
    std::size_t count() const { return _layers.size(); }
    /// The number of these that have a picture and no room.
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
        std::shared_ptr<const LayerPixels> pixels; ///< as they were uploaded
        bool leftOut = false;
    };

    void leave(DataLayer* data, ProjectiveMapping& user);
    bool isStale(const Layer& layer) const;
    struct Outcome
    {
        bool moved = false;
        bool painted = false; ///< its texels are others, or elsewhere
    };
    Outcome updateLayer(Layer& layer);
    std::shared_ptr<const LayerPixels> pixelsOf(const Layer& layer, LayerPixels::Rows& changed) const;
    std::shared_ptr<const LayerPixels> blankOf(const Layer& layer) const;
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
