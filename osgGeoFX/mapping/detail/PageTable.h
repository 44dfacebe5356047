// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/PageResidency.h>

#include <osg/Texture2D>
#include <osg/Vec2d>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** Tells fragments which page shows their place: a texture with a word for each square of the finest page. Around what a cut
    covers, and between its pages, words are 0, which is the blank slot.

    A word has three bytes: the slot's column and row, and the exponent of a float, which is the side of a square over the side
    of the page. (Bytes, since CPUs filter them in less time than other formats.) For one thread at a time; drawing counts as
    one. */
class PageTable
{
public:
    static constexpr int mostCells = 2048;

    PageTable();
    ~PageTable();
    PageTable(const PageTable&) = delete;
    PageTable& operator=(const PageTable&) = delete;

    /// Writes what the sources of a cut say. `columns`: the slots in a row of the texture of pages. False if the cut spans
    /// too many squares.
    bool write(const std::vector<PageResidency::Source>& sources, int columns);

    /// What a shader must know: the place where the squares begin to count, metres, and one over their side.
    const osg::Vec2d& anchor() const { return _anchor; }
    double inverseCell() const { return 1.0 / MappingPage::sideOf(_level); }
    /// The table's first square, counted from there; and the number of squares along its sides.
    std::pair<int, int> corner() const { return _corner; }
    int cells() const { return _image->cells; }
    /// The word of a square, for tests.
    std::uint32_t word(int column, int row) const
    {
        return _image->words[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells()) +
                             static_cast<std::size_t>(column)];
    }

    /// The texture with what was written last. Another one after each change, since OSG does not apply anew what it has
    /// applied last.
    osg::Texture2D* texture() const { return _textures[_turn]; }
    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int size);

private:
    class Upload;
    /// The textures keep it: a frame that is still being drawn may outlive the table.
    struct Image
    {
        int cells = 0; ///< along the sides
        std::vector<std::uint32_t> words;
    };
    struct Rectangle
    {
        std::int64_t x = 0, y = 0; ///< squares of the finest page
        int size = 0;
        std::uint32_t word = 0;
        bool operator==(const Rectangle& other) const
        {
            return x == other.x && y == other.y && size == other.size && word == other.word;
        }
    };
    void set(const Rectangle& rectangle, std::uint32_t word);
    void markRows(int first, int last);

    int _level = 0;
    std::int64_t _x = 0, _y = 0; ///< of the table's first square
    osg::Vec2d _anchor;
    std::pair<int, int> _corner;
    std::map<std::pair<std::int64_t, std::int64_t>, Rectangle> _rectangles;
    std::shared_ptr<Image> _image;
    std::array<osg::ref_ptr<osg::Texture2D>, 2> _textures;
    std::array<osg::ref_ptr<Upload>, 2> _uploads;
    std::size_t _turn = 0;
};

} // namespace osgGeoFX
