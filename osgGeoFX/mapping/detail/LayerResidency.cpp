// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/LayerResidency.h>

#include <osg/Notify>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

unsigned int imageCountOf(const DataLayer& data)
{
    return data.getImage() ? data.getImage()->getModifiedCount() : 0;
}

bool isSame(const std::optional<PlacedLayer>& a, const std::optional<PlacedLayer>& b)
{
    if (!a || !b) return a.has_value() == b.has_value();
    return a->slot.page == b->slot.page && a->slot.x == b->slot.x && a->slot.y == b->slot.y &&
           a->slot.side == b->slot.side && a->width == b->width && a->height == b->height;
}

} // namespace

void LayerResidency::reset(int pageSide, int maxPages)
{
    for (auto& [data, layer] : _layers)
    {
        layer.placed.reset();
        layer.pixels.reset();
        layer.seen = false;
    }
    _pageSide = pageSide;
    _atlas = LayerAtlas(pageSide, maxPages);
}

void LayerResidency::use(ProjectiveMapping& user, const Pair& next, const Pair& former)
{
    for (DataLayer* data : {former.layer.get(), former.mask.get()})
    {
        if (data != next.layer && data != next.mask) leave(data, user);
    }
    for (DataLayer* data : {next.layer.get(), next.mask.get()})
    {
        if (!data) continue;
        Layer& layer = _layers[data];
        layer.data = data;
        layer.users.insert(&user);
    }
}

void LayerResidency::leave(DataLayer* data, ProjectiveMapping& user)
{
    const auto found = _layers.find(data);
    if (found == _layers.end()) return;
    found->second.users.erase(&user);
    if (!found->second.users.empty()) return;
    unplace(found->second);
    if (found->second.leftOut) --_leftOut;
    _layers.erase(found);
}

bool LayerResidency::isStale(const Layer& layer) const
{
    const osg::Texture* const texture = layer.data->getTexture();
    if (texture && layer.pixels &&
        (texture->getTextureWidth() != layer.pixels->width ||
         texture->getTextureHeight() != layer.pixels->height))
        return true;
    return !layer.seen || layer.revision != layer.data->revision() ||
           layer.imageCount != imageCountOf(*layer.data) || (layer.leftOut && _changes.roomMade);
}

void LayerResidency::update()
{
    if (std::none_of(_layers.begin(), _layers.end(),
                     [&](const auto& entry) { return isStale(entry.second); }))
        return;
    // The most important layers come first. Less important ones make room for them, and share what is left.
    std::vector<Layer*> layers;
    for (auto& [data, layer] : _layers)
        layers.push_back(&layer);
    std::stable_sort(layers.begin(), layers.end(),
                     [](const Layer* a, const Layer* b)
                     { return a->data->getImportance() > b->data->getImportance(); });
    for (Layer* layer : layers)
    {
        if (!isStale(*layer)) continue;
        const DataLayer& data = *layer->data;
        const bool differs = layer->revision != data.revision();
        const Outcome outcome = updateLayer(*layer);
        if (outcome.moved || differs || !layer->seen)
            _changes.mappings.insert(layer->users.begin(), layer->users.end());
        if (outcome.painted || differs) _changes.repainted.insert(layer->users.begin(), layer->users.end());
        layer->seen = true;
        layer->revision = data.revision();
        layer->imageCount = imageCountOf(data);
    }
}

LayerResidency::Outcome LayerResidency::updateLayer(Layer& layer)
{
    Outcome outcome;
    LayerPixels::Rows changed;
    const std::shared_ptr<const LayerPixels> pixels = pixelsOf(layer, changed);
    const std::optional<PlacedLayer> former = layer.placed;
    if (layer.placed && (!pixels || pixels->side != layer.placed->slot.side)) unplace(layer);
    if (pixels && !layer.placed)
    {
        const std::optional<LayerAtlas::Slot> slot = findRoom(pixels->side, *layer.data);
        if (slot) layer.placed = PlacedLayer{*slot, 0, 0};
    }
    const bool leftOut = pixels && !layer.placed;
    _leftOut += static_cast<int>(leftOut) - static_cast<int>(layer.leftOut);
    layer.leftOut = leftOut;
    if (layer.placed)
    {
        layer.placed->width = pixels->width;
        layer.placed->height = pixels->height;
        GpuStore::Layer upload{layer.placed->slot, pixels};
        // What lies in another place, or nowhere yet, is not there at all.
        if (isSame(former, layer.placed)) upload.rows = changed;
        upload.texture = layer.data->getTexture();
        const bool same = upload.rows && upload.rows->first == upload.rows->end && !upload.texture;
        if (!same) _changes.uploads.layers.push_back(upload);
        outcome.painted = !same;
    }
    layer.pixels = layer.placed ? pixels : nullptr;
    outcome.moved = !isSame(former, layer.placed);
    outcome.painted = outcome.painted || outcome.moved;
    return outcome;
}

/// Transparent, of a texture's size: what shows until it is copied. Null for one that cannot be.
std::shared_ptr<const LayerPixels> LayerResidency::blankOf(const Layer& layer) const
{
    const DataLayer& data = *layer.data;
    const int width = data.getTexture()->getTextureWidth(), height = data.getTexture()->getTextureHeight();
    std::string fault;
    if (data.getKind() != DataLayer::COLOR)
        fault = "a texture has colors, not values; set its kind to COLOR.";
    if (width < 1 || height < 1) fault = "its texture has no size; call setTextureSize().";
    if (std::max(width, height) > _pageSide)
        fault = "its texture is larger than pages of " + std::to_string(_pageSide) +
                "; raise ProjectiveMappings' pageSide.";
    if (!fault.empty())
    {
        if (!layer.seen || layer.revision != data.revision())
            OSG_WARN << "osgGeoFX: DataLayer \"" << data.getName() << "\": " << fault << " It is not drawn."
                     << std::endl;
        return nullptr;
    }
    auto pixels = std::make_shared<LayerPixels>();
    pixels->width = width;
    pixels->height = height;
    pixels->side = 1;
    while (pixels->side < std::max(width, height))
        pixels->side *= 2;
    for (auto side = static_cast<std::size_t>(pixels->side); side > 0; side /= 2)
        pixels->levels.emplace_back(side * side);
    return pixels;
}

/// Null for a layer without a picture, and for one that cannot be drawn. `changed`: the rows that differ from the former ones.
std::shared_ptr<const LayerPixels> LayerResidency::pixelsOf(const Layer& layer,
                                                            LayerPixels::Rows& changed) const
{
    const DataLayer& data = *layer.data;
    if (data.getTexture()) return blankOf(layer);
    const osg::Image* image = data.getImage();
    if (!image || image->s() <= 0) return nullptr;
    LayerPixels::Options options;
    options.kind = static_cast<LayerPixels::Kind>(data.getKind());
    options.sRGB = data.getSRgb();
    if (data.getHasNoData()) options.noData = data.getNoData();
    options.maxSide = _pageSide;
    std::string error;
    // Of an image that changes again and again most is often the same.
    const bool live = layer.pixels && layer.revision == data.revision();
    std::optional<LayerPixels> made =
        live ? LayerPixels::remake(*image, options, *layer.pixels, changed, error)
             : LayerPixels::make(*image, options, error);
    if (made && !live) changed = {0, made->side};
    if (!made)
    {
        OSG_WARN << "osgGeoFX: DataLayer \"" << data.getName() << "\": " << error << " It is not drawn."
                 << std::endl;
        return nullptr;
    }
    if (made->reduced && layer.revision != data.revision())
    {
        OSG_WARN << "osgGeoFX: DataLayer \"" << data.getName() << "\" has " << image->s() << " x "
                 << image->t() << " texels, and is reduced to pages of " << _pageSide
                 << "; raise ProjectiveMappings' pageSide to see all of it." << std::endl;
    }
    return std::make_shared<LayerPixels>(std::move(*made));
}

std::optional<LayerAtlas::Slot> LayerResidency::findRoom(int side, const DataLayer& data)
{
    std::optional<LayerAtlas::Slot> slot = _atlas.add(side);
    while (!slot && makeRoomFor(data))
        slot = _atlas.add(side);
    return slot;
}

/// False if all layers with a place are at least as important.
bool LayerResidency::makeRoomFor(const DataLayer& data)
{
    Layer* least = nullptr;
    for (auto& [other, layer] : _layers)
    {
        const bool better = !least || other->getImportance() < least->data->getImportance();
        if (layer.placed && better) least = &layer;
    }
    if (!least || least->data->getImportance() >= data.getImportance()) return false;
    unplace(*least);
    least->leftOut = true;
    ++_leftOut;
    _changes.mappings.insert(least->users.begin(), least->users.end());
    return true;
}

void LayerResidency::unplace(Layer& layer)
{
    if (!layer.placed) return;
    _atlas.release(layer.placed->slot);
    _changes.uploads.layers.push_back({layer.placed->slot, nullptr});
    layer.placed.reset();
    layer.pixels.reset();
    _changes.roomMade = true;
}

std::optional<PlacedLayer> LayerResidency::placed(const DataLayer* data) const
{
    const auto found = _layers.find(data);
    return found != _layers.end() ? found->second.placed : std::nullopt;
}

} // namespace osgGeoFX
