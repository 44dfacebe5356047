// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/GpuStore.h>

#include <osgGeoFX/mapping/detail/SlotCopy.h>

#include <osg/ContextData>
#include <osg/GLExtensions>
#include <osg/GLObjects>
#include <osg/Image>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

/// The length of the journal. A context that is further behind uploads everything.
constexpr std::size_t mostEntries = 256;
constexpr std::size_t mostBytes = 64u << 20u;

constexpr GLenum textureBuffer = 0x8C2A;
constexpr GLenum rgba32ui = 0x8D70;
constexpr GLenum maxTextureBufferSize = 0x8C2B;
constexpr GLenum texture2DArray = 0x8C1A;
constexpr GLenum maxArrayTextureLayers = 0x88FF;
constexpr GLenum reversedBytes = 0x8367; // GL_UNSIGNED_INT_8_8_8_8_REV

/// Deletes buffers. OSG calls it in the context's own thread, when there is time.
class BufferDeletion : public osg::GLObjectManager
{
public:
    explicit BufferDeletion(unsigned int context) : osg::GLObjectManager("osgGeoFX buffers", context) {}
    void deleteGLObject(GLuint name) override
    {
        const osg::GLExtensions* gl = osg::GLExtensions::Get(_contextID, true);
        if (gl && gl->glDeleteBuffers) gl->glDeleteBuffers(1, &name);
    }
};

class TextureDeletion : public osg::GLObjectManager
{
public:
    explicit TextureDeletion(unsigned int context) : osg::GLObjectManager("osgGeoFX textures", context) {}
    void deleteGLObject(GLuint name) override { glDeleteTextures(1, &name); }
};

int levelsOf(int side)
{
    int levels = 1;
    while (side >> levels)
        ++levels;
    return levels;
}

void setFilter(GLenum target, GLenum minification, GLenum magnification)
{
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minification));
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnification));
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

int powerOfTwo(int least)
{
    int result = 1;
    while (result < least)
        result *= 2;
    return result;
}

} // namespace

GpuStore::~GpuStore()
{
    releaseGLObjects(nullptr);
}

std::uint64_t GpuStore::commit(TexelArena& arena, Commit changes)
{
    const TexelArena::Changes texels = arena.takeChanges();
    const std::lock_guard<std::mutex> lock(_mutex);
    if (texels.ranges.empty() && changes.layers.empty() && changes.tables.empty()) return _number;
    Entry entry;
    entry.number = ++_number;
    if (texels.all)
    {
        _texels = arena.texels();
        entry.all = std::make_shared<const Texels>(_texels);
        entry.bytes += _texels.size() * sizeof(TexelArena::Texel);
    }
    else
    {
        for (const TexelArena::Range& range : texels.ranges)
        {
            const auto first = arena.texels().begin() + range.first;
            entry.patches.push_back({range.first, {first, first + range.count}});
            std::copy(first, first + range.count, _texels.begin() + range.first);
            entry.bytes += range.count * sizeof(TexelArena::Texel);
        }
    }
    for (const Layer& layer : changes.layers)
    {
        const SlotKey key(layer.slot.page, {layer.slot.x, layer.slot.y});
        if (layer.pixels)
        {
            _layers[key] = layer;
            _layers[key].rows.reset();
            // All of it is kept, whatever part of it is uploaded.
            entry.bytes += 4 * layer.pixels->levels[0].size() * 4 / 3;
            _pages = std::max(_pages, powerOfTwo(layer.slot.page + 1));
        }
        else
        {
            _layers.erase(key);
        }
    }
    for (const Table& table : changes.tables)
    {
        _tables[table.row] = table;
        _rows = std::max(_rows, powerOfTwo(table.row + 1));
        entry.bytes += table.texels.size() * sizeof(std::uint16_t);
    }
    entry.changes = std::move(changes);
    _journalBytes += entry.bytes;
    _journal.push_back(std::move(entry));
    while (_journal.size() > mostEntries || (_journal.size() > 1 && _journalBytes > mostBytes))
    {
        _journalBytes -= _journal.front().bytes;
        _journal.pop_front();
    }
    return _number;
}

void GpuStore::reserve(int pages)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _pages = std::max(_pages, powerOfTwo(pages));
}

GpuStore::Limits GpuStore::limits() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _limits;
}

std::uint64_t GpuStore::uploadedBytes() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _uploaded;
}

void GpuStore::askLimits()
{
    if (_limits.texels > 0) return;
    GLint value = 0;
    glGetIntegerv(maxTextureBufferSize, &value);
    _limits.texels = value;
    glGetIntegerv(maxArrayTextureLayers, &value);
    _limits.pages = value;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &value);
    _limits.pageSide = value;
}

void GpuStore::uploadTexels(Context& context, osg::State& state, const Texels& texels)
{
    const auto* gl = state.get<osg::GLExtensions>();
    // There is at least one texel, so that shaders always have something to fetch.
    const std::size_t count = std::max<std::size_t>(texels.size(), 1);
    const auto bytes = static_cast<GLsizeiptr>(count * sizeof(TexelArena::Texel));
    const TexelArena::Texel nothing = {};
    gl->glBindBuffer(textureBuffer, context.buffer);
    gl->glBufferData(textureBuffer, bytes, texels.empty() ? nothing.data() : texels.data()->data(),
                     GL_DYNAMIC_DRAW);
    glBindTexture(textureBuffer, context.data);
    gl->glTexBuffer(textureBuffer, rgba32ui, context.buffer);
    _uploaded += static_cast<std::uint64_t>(bytes);
}

void GpuStore::uploadLayers(Context& context, osg::State& state, const std::vector<Layer>& layers)
{
    const auto* gl = state.get<osg::GLExtensions>();
    glBindTexture(texture2DArray, context.layers);
    for (const Layer& layer : layers)
    {
        if (!layer.pixels || layer.slot.page >= context.pages) continue;
        // Blank pixels now: the texture is copied again, in this frame, too.
        if (layer.texture) context.copied.reset();
        LayerPixels::Rows rows = layer.rows.value_or(LayerPixels::Rows{0, layer.slot.side});
        for (std::size_t level = 0; level < layer.pixels->levels.size(); ++level)
        {
            const auto shift = static_cast<int>(level);
            const int side = layer.slot.side >> shift;
            const int count = rows.end - rows.first;
            gl->glTexSubImage3D(
                texture2DArray, shift, layer.slot.x >> shift, (layer.slot.y >> shift) + rows.first,
                layer.slot.page, side, count, 1, GL_RGBA, reversedBytes,
                layer.pixels->levels[level].data() + static_cast<std::ptrdiff_t>(rows.first) * side);
            _uploaded += 4u * static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(count);
            rows = {rows.first / 2, (rows.end + 1) / 2};
        }
    }
}

void GpuStore::uploadAllLayers(Context& context, osg::State& state)
{
    const auto* gl = state.get<osg::GLExtensions>();
    glBindTexture(texture2DArray, context.layers);
    setFilter(texture2DArray, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
    const int levels = levelsOf(_pageSide);
    glTexParameteri(texture2DArray, GL_TEXTURE_MAX_LEVEL, levels - 1);
    context.pages = std::min(_pages, _limits.pages);
    for (int level = 0; level < levels; ++level)
    {
        const int side = _pageSide >> level;
        gl->glTexImage3D(texture2DArray, level, GL_RGBA8, side, side, context.pages, 0, GL_RGBA,
                         GL_UNSIGNED_BYTE, nullptr);
    }
    std::vector<Layer> layers;
    for (const auto& [key, layer] : _layers)
        layers.push_back(layer);
    uploadLayers(context, state, layers);
}

void GpuStore::uploadTable(const Table& table)
{
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, table.row, tableWidth, 1, GL_RGBA, GL_UNSIGNED_SHORT,
                    table.texels.data());
    _uploaded += table.texels.size() * sizeof(std::uint16_t);
}

void GpuStore::uploadAllTables(Context& context)
{
    context.rows = _rows;
    glBindTexture(GL_TEXTURE_2D, context.tables);
    setFilter(GL_TEXTURE_2D, GL_LINEAR, GL_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16, tableWidth, _rows, 0, GL_RGBA, GL_UNSIGNED_SHORT, nullptr);
    for (const auto& [row, table] : _tables)
        uploadTable(table);
}

void GpuStore::uploadAll(Context& context, osg::State& state)
{
    if (!context.buffer)
    {
        const auto* gl = state.get<osg::GLExtensions>();
        context.life = osg::get<BufferDeletion>(state.getContextID());
        gl->glGenBuffers(1, &context.buffer);
        GLuint names[3] = {};
        glGenTextures(3, names);
        context.data = names[0];
        context.layers = names[1];
        context.tables = names[2];
    }
    uploadTexels(context, state, _texels);
    uploadAllLayers(context, state);
    uploadAllTables(context);
    context.number = _number;
}

void GpuStore::replay(Context& context, osg::State& state, const Entry& entry)
{
    const auto* gl = state.get<osg::GLExtensions>();
    if (entry.all) uploadTexels(context, state, *entry.all);
    if (!entry.patches.empty()) gl->glBindBuffer(textureBuffer, context.buffer);
    for (const Patch& patch : entry.patches)
    {
        const std::size_t bytes = patch.texels.size() * sizeof(TexelArena::Texel);
        gl->glBufferSubData(textureBuffer, static_cast<GLintptr>(patch.first * sizeof(TexelArena::Texel)),
                            static_cast<GLsizeiptr>(bytes), patch.texels.data());
        _uploaded += bytes;
    }
    if (!entry.changes.layers.empty())
    {
        if (context.pages < std::min(_pages, _limits.pages))
            uploadAllLayers(context, state);
        else
            uploadLayers(context, state, entry.changes.layers);
    }
    if (!entry.changes.tables.empty())
    {
        glBindTexture(GL_TEXTURE_2D, context.tables);
        if (context.rows < _rows) uploadAllTables(context);
        for (const Table& table : entry.changes.tables)
            uploadTable(table);
    }
    context.number = entry.number;
}

void GpuStore::update(Context& context, osg::State& state, std::uint64_t upTo)
{
    if (context.buffer && context.number >= upTo) return;
    // Pixels come straight from memory, in rows without gaps.
    state.unbindPixelBufferObject();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    const bool behind = !_journal.empty() && _journal.front().number > context.number + 1;
    if (!context.buffer || behind) uploadAll(context, state);
    for (const Entry& entry : _journal)
    {
        if (entry.number > context.number && entry.number <= upTo) replay(context, state, entry);
    }
    state.get<osg::GLExtensions>()->glBindBuffer(textureBuffer, 0);
}

/// Once in each frame.
void GpuStore::copyTextures(Context& context, osg::State& state)
{
    const osg::FrameStamp* stamp = state.getFrameStamp();
    const unsigned int frame = stamp ? stamp->getFrameNumber() : 0;
    if (stamp && context.copied == frame) return;
    context.copied = frame;
    std::optional<SlotCopy> copy;
    for (const auto& [key, layer] : _layers)
    {
        const osg::Texture* texture = layer.texture;
        if (!texture || layer.slot.page >= context.pages) continue;
        // What this context has not drawn yet has nothing to copy.
        const osg::Texture::TextureObject* object = texture->getTextureObject(state.getContextID());
        if (!object) continue;
        if (!copy) copy.emplace(*state.get<osg::GLExtensions>());
        copy->copy(object->id(), layer.pixels->width, layer.pixels->height, context.layers, layer.slot);
    }
}

void GpuStore::bind(Part part, osg::State& state, std::uint64_t upTo)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    askLimits();
    Context& context = _contexts[state.getContextID()];
    if (!context.life.valid()) context = {};
    update(context, state, upTo);
    switch (part)
    {
    case Part::Data:
        glBindTexture(textureBuffer, context.data);
        break;
    case Part::Layers:
        copyTextures(context, state);
        glBindTexture(texture2DArray, context.layers);
        break;
    case Part::Tables:
        glBindTexture(GL_TEXTURE_2D, context.tables);
        break;
    }
}

void GpuStore::releaseGLObjects(osg::State* state)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    for (auto entry = _contexts.begin(); entry != _contexts.end();)
    {
        const auto& [id, context] = *entry;
        if (state && state->getContextID() != id)
        {
            ++entry;
            continue;
        }
        if (context.life.valid())
        {
            osg::get<BufferDeletion>(id)->scheduleGLObjectForDeletion(context.buffer);
            for (const unsigned int name : {context.data, context.layers, context.tables})
                osg::get<TextureDeletion>(id)->scheduleGLObjectForDeletion(name);
        }
        entry = _contexts.erase(entry);
    }
}

int StoreTexture::compare(const osg::StateAttribute& other) const
{
    COMPARE_StateAttribute_Types(StoreTexture, other);
    COMPARE_StateAttribute_Parameter(_store);
    COMPARE_StateAttribute_Parameter(_part);
    COMPARE_StateAttribute_Parameter(_upTo);
    return 0;
}

void StoreTexture::apply(osg::State& state) const
{
    if (_store) _store->bind(_part, state, _upTo);
}

} // namespace osgGeoFX
