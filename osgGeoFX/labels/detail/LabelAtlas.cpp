// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/detail/LabelAtlas.h>

#include <osg/State>

#include <algorithm>
#include <cstring>

namespace osgGeoFX
{

/// The texels, and which of them a context does not have yet: each change is a number, and a context remembers the last one.
class LabelAtlas::Upload : public osg::Texture2D::SubloadCallback
{
public:
    explicit Upload(int side)
        : _side(side), _texels(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 4)
    {
    }

    void put(const Place& place, const unsigned char* rows, int rowBytes)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (int row = 0; row < place.height; ++row)
            std::memcpy(&_texels[index(place.x, place.y + row)],
                        rows + static_cast<std::ptrdiff_t>(row) * rowBytes,
                        4 * static_cast<std::size_t>(place.width));
        _changes.push_back(place);
    }

    osg::ref_ptr<osg::Texture::TextureObject> generateTextureObject(const osg::Texture2D& texture,
                                                                    osg::State& state) const override
    {
        return osg::Texture::generateTextureObject(&texture, state.getContextID(), GL_TEXTURE_2D, 1, GL_RGBA8,
                                                   _side, _side, 1, 0);
    }
    void load(const osg::Texture2D&, osg::State& state) const override
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        state.unbindPixelBufferObject();
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, _side, _side, 0, GL_RGBA, GL_UNSIGNED_BYTE, _texels.data());
        _done[state.getContextID()] = _changes.size();
    }
    void subload(const osg::Texture2D&, osg::State& state) const override
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        std::size_t& done = _done[state.getContextID()];
        if (done >= _changes.size()) return;
        state.unbindPixelBufferObject();
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, _side);
        for (; done < _changes.size(); ++done)
        {
            const Place& place = _changes[done];
            glTexSubImage2D(GL_TEXTURE_2D, 0, place.x, place.y, place.width, place.height, GL_RGBA,
                            GL_UNSIGNED_BYTE, &_texels[index(place.x, place.y)]);
        }
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    }

private:
    std::size_t index(int x, int y) const
    {
        return 4 *
               (static_cast<std::size_t>(y) * static_cast<std::size_t>(_side) + static_cast<std::size_t>(x));
    }

    const int _side;
    mutable std::mutex _mutex;
    std::vector<unsigned char> _texels;
    std::vector<Place> _changes;
    mutable std::map<unsigned int, std::size_t> _done; ///< changes, by context
};

LabelAtlas::LabelAtlas(int side) : _side(side), _upload(new Upload(side)), _texture(new osg::Texture2D)
{
    _texture->setTextureSize(side, side);
    _texture->setInternalFormat(GL_RGBA8);
    _texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    _texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    _texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    _texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    _texture->setSubloadCallback(_upload);
    begin();
}

LabelAtlas::~LabelAtlas() = default;

void LabelAtlas::begin()
{
    const std::vector<unsigned char> white(3 * 3 * 4, 255);
    _upload->put({0, 0, 3, 3}, white.data(), 3 * 4);
    _shelves = {{0, 3, 3}};
}

std::optional<LabelAtlas::Place> LabelAtlas::find(std::size_t name) const
{
    const auto found = _places.find(name);
    return found == _places.end() ? std::nullopt : std::optional<Place>(found->second);
}

bool LabelAtlas::add(std::size_t name, const osg::Image& picture)
{
    const int wide = picture.s(), high = picture.t();
    if (wide > _side || high > _side) return false;
    Shelf* best = nullptr;
    for (Shelf& shelf : _shelves)
        if (shelf.height >= high && shelf.height <= high + high / 4 + 2 && shelf.used + wide <= _side &&
            (!best || shelf.height < best->height))
            best = &shelf;
    if (!best)
    {
        const int y = _shelves.back().y + _shelves.back().height;
        if (y + high > _side) return false;
        _shelves.push_back({y, high, 0});
        best = &_shelves.back();
    }
    const Place place = {best->used, best->y, wide, high};
    best->used += wide;
    _upload->put(place, picture.data(), static_cast<int>(picture.getRowStepInBytes()));
    _places[name] = place;
    return true;
}

void LabelAtlas::clear()
{
    _places.clear();
    begin();
}

} // namespace osgGeoFX
