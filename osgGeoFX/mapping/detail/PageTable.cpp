// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/PageTable.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr GLenum reversedBytes = 0x8367; // GL_UNSIGNED_INT_8_8_8_8_REV

int powerOfTwo(std::int64_t least)
{
    int result = 16;
    while (result < least)
        result *= 2;
    return result;
}

std::int64_t floorTo(std::int64_t value, int bits)
{
    return (value >> bits) * (std::int64_t{1} << bits);
}

} // namespace

/// Uploads the rows that have changed, when OSG applies the texture.
class PageTable::Upload : public osg::Texture2D::SubloadCallback
{
public:
    explicit Upload(std::shared_ptr<const Image> image) : _image(std::move(image)) {}

    void load(const osg::Texture2D&, osg::State& state) const override
    {
        begin(state);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, _image->cells, _image->cells, 0, GL_RGBA, reversedBytes,
                     _image->words.data());
        _first = _last = 0;
        _loaded = _image->cells;
    }
    void subload(const osg::Texture2D& texture, osg::State& state) const override
    {
        if (_loaded != _image->cells)
        {
            load(texture, state);
            return;
        }
        if (_first >= _last) return;
        begin(state);
        const auto width = static_cast<std::size_t>(_image->cells);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, _first, _image->cells, _last - _first, GL_RGBA, reversedBytes,
                        _image->words.data() + static_cast<std::size_t>(_first) * width);
        _first = _last = 0;
    }

    void mark(int first, int last)
    {
        if (_first >= _last)
            _first = first, _last = last;
        else
            _first = std::min(_first, first), _last = std::max(_last, last);
    }

private:
    static void begin(osg::State& state)
    {
        state.unbindPixelBufferObject();
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    }

    const std::shared_ptr<const Image> _image;
    mutable int _first = 0, _last = 0; ///< rows
    mutable int _loaded = 0;           ///< cells along the sides
};

PageTable::PageTable() : _image(std::make_shared<Image>())
{
    for (std::size_t i = 0; i < _textures.size(); ++i)
    {
        _uploads[i] = new Upload(_image);
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
        texture->setInternalFormat(GL_RGBA8);
        texture->setSourceFormat(GL_RGBA);
        texture->setSourceType(reversedBytes);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
        texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
        texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
        texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
        texture->setResizeNonPowerOfTwoHint(false);
        texture->setSubloadCallback(_uploads[i]);
        _textures[i] = texture;
    }
}

PageTable::~PageTable() = default;

void PageTable::markRows(int first, int last)
{
    for (const osg::ref_ptr<Upload>& upload : _uploads)
        upload->mark(first, last);
}

void PageTable::set(const Rectangle& rectangle, std::uint32_t word)
{
    const auto column = static_cast<std::ptrdiff_t>(rectangle.x - _x);
    const auto row = static_cast<std::ptrdiff_t>(rectangle.y - _y);
    for (std::ptrdiff_t y = row; y < row + rectangle.size; ++y)
        std::fill_n(_image->words.begin() + y * _image->cells + column, rectangle.size, word);
    markRows(static_cast<int>(row), static_cast<int>(row) + rectangle.size);
}

bool PageTable::write(const std::vector<PageResidency::Source>& sources, int columns)
{
    int finest = MappingPage::coarsest, coarsest = MappingPage::finest;
    for (const PageResidency::Source& source : sources)
    {
        finest = std::min(finest, source.wanted.level);
        coarsest = std::max(coarsest, source.page.level);
    }
    if (sources.empty()) finest = coarsest = _level;
    std::map<std::pair<std::int64_t, std::int64_t>, Rectangle> rectangles;
    std::int64_t lowX = 0, lowY = 0, highX = 0, highY = 0;
    for (const PageResidency::Source& source : sources)
    {
        const int shift = source.wanted.level - finest;
        if (shift > 30) return false;
        const std::int64_t size = std::int64_t{1} << shift;
        if (size > mostCells) return false;
        Rectangle rectangle;
        rectangle.x = source.wanted.x * size;
        rectangle.y = source.wanted.y * size;
        rectangle.size = static_cast<int>(size);
        const auto exponent = static_cast<std::uint32_t>(127 - (source.page.level - finest));
        rectangle.word = static_cast<std::uint32_t>(source.slot % columns) |
                         static_cast<std::uint32_t>(source.slot / columns) << 8u | exponent << 16u;
        const bool first = rectangles.empty();
        lowX = first ? rectangle.x : std::min(lowX, rectangle.x);
        lowY = first ? rectangle.y : std::min(lowY, rectangle.y);
        highX = first ? rectangle.x + size : std::max(highX, rectangle.x + size);
        highY = first ? rectangle.y + size : std::max(highY, rectangle.y + size);
        rectangles[{rectangle.x, rectangle.y}] = rectangle;
    }
    // A ring of blank squares, for what lies beyond.
    const std::int64_t least = std::max(highX - lowX, highY - lowY) + 2;
    if (least > mostCells) return false;
    const bool fits = _image->cells > 0 && _level == finest && lowX > _x && lowY > _y &&
                      highX < _x + _image->cells && highY < _y + _image->cells &&
                      powerOfTwo(least) * 4 >= _image->cells;
    bool changes = !fits;
    if (!fits)
    {
        // Room for moves to all sides.
        _level = finest;
        _image->cells = std::min(mostCells, powerOfTwo(least + least / 2));
        _x = (lowX + highX - _image->cells) / 2;
        _y = (lowY + highY - _image->cells) / 2;
        _image->words.assign(
            static_cast<std::size_t>(_image->cells) * static_cast<std::size_t>(_image->cells), 0);
        _rectangles.clear();
        markRows(0, _image->cells);
    }
    for (const auto& [place, rectangle] : _rectangles)
    {
        const auto found = rectangles.find(place);
        if (found != rectangles.end() && found->second == rectangle) continue;
        set(rectangle, 0);
        changes = true;
    }
    for (const auto& [place, rectangle] : rectangles)
    {
        const auto found = _rectangles.find(place);
        if (found != _rectangles.end() && found->second == rectangle) continue;
        set(rectangle, rectangle.word);
        changes = true;
    }
    _rectangles = std::move(rectangles);
    // Where the squares of all pages begin, so that their sides are whole numbers there. It depends on the cut alone.
    const int bits = std::max(coarsest - finest, 0);
    const std::int64_t anchorX = floorTo(lowX, bits), anchorY = floorTo(lowY, bits);
    const double side = MappingPage::sideOf(_level);
    _anchor.set(static_cast<double>(anchorX) * side, static_cast<double>(anchorY) * side);
    _corner = {static_cast<int>(_x - anchorX), static_cast<int>(_y - anchorY)};
    if (changes) _turn = 1 - _turn;
    return true;
}

void PageTable::releaseGLObjects(osg::State* state) const
{
    for (const osg::ref_ptr<osg::Texture2D>& texture : _textures)
        texture->releaseGLObjects(state);
}

void PageTable::resizeGLObjectBuffers(unsigned int size)
{
    for (const osg::ref_ptr<osg::Texture2D>& texture : _textures)
        texture->resizeGLObjectBuffers(size);
}

} // namespace osgGeoFX
