// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/LayerAtlas.h>
#include <osgGeoFX/mapping/detail/TexelArena.h>
#include <osgGeoFX/raster/LayerPixels.h>

#include <osg/Referenced>
#include <osg/State>
#include <osg/StateAttribute>
#include <osg/Texture2D>
#include <osg/observer_ptr>

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace osgGeoFX
{

/** The GPUs' data for a set of mappings: a texture buffer, a texture array of data layers, and a texture of color
    tables. It carries each change to all graphics contexts.

    commit() writes changes once, under a number. When a context draws a frame, it takes over the changes up to the
    number that the frame was culled with. So a frame that is drawn late does not see later changes, and only changes
    are uploaded. Thread-safe. (osg::TextureBuffer and osg::Texture2DArray upload whole buffers and lose changes. OSG
    has no means for parts.) */
class GpuStore : public osg::Referenced
{
public:
    /// The width of the color tables' texture.
    static constexpr int tableWidth = 1024;

    explicit GpuStore(int pageSide) : _pageSide(pageSide) {}

    int pageSide() const { return _pageSide; }

    /// A layer that is put into a slot, or taken out of it.
    struct Layer
    {
        LayerAtlas::Slot slot;
        std::shared_ptr<const LayerPixels> pixels; ///< null: the slot is free
        /// Of level 0, those that differ from what was in the slot before; nothing for all.
        std::optional<LayerPixels::Rows> rows = std::nullopt;
        /// What each frame copies over the pixels; null for none.
        osg::ref_ptr<osg::Texture2D> texture = nullptr;
    };
    struct Table
    {
        int row = 0;
        std::vector<std::uint16_t> texels; ///< RGBA; finer than bytes, since blending may square them
    };
    struct Commit
    {
        std::vector<Layer> layers;
        std::vector<Table> tables;
    };
    /// Takes over the arena's changes and these. The result is the number for the frame to cull.
    std::uint64_t commit(TexelArena& arena, Commit changes);
    /// So many pages are there from a context's next upload of all on, or from the next time it needs more.
    void reserve(int pages);

    /// The limits of the GPU; 0 before it has drawn anything.
    struct Limits
    {
        int texels = 0; ///< of the texture buffer
        int pages = 0;
        int pageSide = 0;
    };
    Limits limits() const;
    /// The bytes uploaded so far, in all contexts together.
    std::uint64_t uploadedBytes() const;

    enum class Part
    {
        Data,
        Layers,
        Tables
    };
    /// Binds a part on the active texture unit, with all changes up to a number.
    void bind(Part part, osg::State& state, std::uint64_t upTo);
    /// Null: those of all contexts.
    void releaseGLObjects(osg::State* state);

protected:
    ~GpuStore() override;

private:
    using Texels = std::vector<TexelArena::Texel>;
    struct Patch
    {
        std::uint32_t first = 0;
        Texels texels;
    };
    struct Entry
    {
        std::uint64_t number = 0;
        std::shared_ptr<const Texels> all; ///< set instead of patches, if much or the size has changed
        std::vector<Patch> patches;
        Commit changes;
        std::size_t bytes = 0;
    };
    struct Context
    {
        /// An object of the context, which dies with it. Without it these names are invalid: the next context with
        /// the same number does not have them.
        osg::observer_ptr<osg::Referenced> life;
        std::uint64_t number = 0;
        unsigned int buffer = 0, data = 0, layers = 0, tables = 0;
        int pages = 0;
        int rows = 0;
        /// The number of the frame that textures were copied for last.
        std::optional<unsigned int> copied;
    };
    using SlotKey = std::pair<int, std::pair<int, int>>;

    void update(Context& context, osg::State& state, std::uint64_t upTo);
    void uploadAll(Context& context, osg::State& state);
    void replay(Context& context, osg::State& state, const Entry& entry);
    void uploadTexels(Context& context, osg::State& state, const Texels& texels);
    void uploadLayers(Context& context, osg::State& state, const std::vector<Layer>& layers);
    void uploadAllLayers(Context& context, osg::State& state);
    void copyTextures(Context& context, osg::State& state);
    void uploadTable(const Table& table);
    void uploadAllTables(Context& context);
    void askLimits();

    const int _pageSide;
    mutable std::mutex _mutex;
    std::uint64_t _number = 0;
    Texels _texels;
    std::map<SlotKey, Layer> _layers;
    std::map<int, Table> _tables;
    int _pages = 1;
    int _rows = 1;
    std::deque<Entry> _journal;
    std::size_t _journalBytes = 0;
    std::map<unsigned int, Context> _contexts;
    Limits _limits;
    std::uint64_t _uploaded = 0;
};

/// One of the store's textures in a state set, with the changes up to a frame.
class StoreTexture : public osg::StateAttribute
{
public:
    StoreTexture() = default;
    StoreTexture(GpuStore* store, GpuStore::Part part) : _store(store), _part(part) {}
    StoreTexture(const StoreTexture& other, const osg::CopyOp& copy)
        : osg::StateAttribute(other, copy), _store(other._store), _part(other._part), _upTo(other._upTo)
    {
    }
    META_StateAttribute(osgGeoFX, StoreTexture, TEXTURE);

    void show(std::uint64_t upTo) { _upTo = upTo; }

    bool isTextureAttribute() const override { return true; }
    int compare(const osg::StateAttribute& other) const override;
    void apply(osg::State& state) const override;

protected:
    ~StoreTexture() override = default;

private:
    osg::ref_ptr<GpuStore> _store;
    GpuStore::Part _part = GpuStore::Part::Data;
    std::uint64_t _upTo = 0;
};

} // namespace osgGeoFX
