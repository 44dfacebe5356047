// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Camera>
#include <osgText/Font>
#include <osgViewer/View>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// What stands around the rows of a panel; texts are UTF-8.
struct PanelWords
{
    std::string title, name, order, value, note; ///< of the list and its columns
    std::string keysAbove, keysBelow;            ///< two lines below the rows
};

/// What a panel shows at a time; texts are UTF-8.
struct PanelPage
{
    struct Row
    {
        bool on;
        bool inForce; ///< drawn bright
        std::string name, order, value, note;
        bool box = true; ///< whether it has a box that switches it

        bool operator==(const Row& other) const
        {
            return on == other.on && inForce == other.inForce && name == other.name && order == other.order &&
                   value == other.value && note == other.note && box == other.box;
        }
    };
    std::vector<Row> rows;
    std::size_t first = 0; ///< the uppermost row's place in the list
    std::size_t selected = 0;
    std::size_t total = 0;

    /// "3 of 120".
    std::string count() const;
    bool operator==(const PanelPage& other) const
    {
        return rows == other.rows && first == other.first && selected == other.selected &&
               total == other.total;
    }
};

/** The picture of a panel: a dark box in an upper corner of a view, by a slave camera of that view. It grows
    with the window, and is made anew only when what it shows has changed, from new objects, so that a frame that is still
    being drawn keeps its own. For the event traversal. */
class OSGGEOFX_EXPORT PanelPicture
{
public:
    static constexpr std::size_t rows = 12; ///< at a time

    enum Corner
    {
        LEFT,
        RIGHT
    };
    explicit PanelPicture(osgText::Font* font, Corner corner = RIGHT);

    /// The words are the same each time.
    void show(osgViewer::View& view, const PanelPage& page, const PanelWords& words);
    void hide();

    /// Where a pixel of the window lies on the picture.
    struct Spot
    {
        std::optional<std::size_t> row; ///< of the list
        bool onBox = false;             ///< the row's box that switches it
    };
    /// Nothing beside the picture, and while there is none.
    std::optional<Spot> spotAt(double x, double y) const;

private:
    /// Pixels of the viewport.
    struct Layout
    {
        double text, line, margin;
        double left, bottom, width, height;
        double rowsTop;

        double rowBottom(std::size_t row) const { return rowsTop - line * static_cast<double>(row + 1); }
    };
    class Painter;
    Layout layout() const;
    void draw(const PanelWords& words);

    osg::ref_ptr<osgText::Font> _font;
    Corner _corner;
    osg::ref_ptr<osg::Camera> _overlay;
    PanelPage _page;
    bool _visible = false;
    bool _drawn = false;
};

} // namespace osgGeoFX
