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

/// The fixed texts around the rows of a panel, UTF-8.
/// @ingroup viewer
struct PanelWords
{
    std::string title, name, order, value, note; ///< of the list and its columns
    std::string keysAbove, keysBelow;            ///< two lines below the rows
};

/// The part of a list that a panel shows; texts are UTF-8.
/// @ingroup viewer
struct PanelPage
{
    struct Row
    {
        bool on;
        bool inForce; ///< drawn bright, else dim
        std::string name, order, value, note;
        bool box = true; ///< whether the row has a box that switches it

        bool operator==(const Row& other) const
        {
            return on == other.on && inForce == other.inForce && name == other.name && order == other.order &&
                   value == other.value && note == other.note && box == other.box;
        }
    };
    std::vector<Row> rows;
    std::size_t first = 0; ///< index of the first shown row in the list
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

/** Draws a panel: a dark box in an upper corner of a view, by a slave camera of that view. The box grows with the
    window. New objects replace the drawing only when its content has changed, so that a frame still being drawn keeps
    its own objects. For the event traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT PanelPicture
{
public:
    static constexpr std::size_t rows = 12; ///< shown at once

    enum Corner
    {
        LEFT,
        RIGHT
    };
    explicit PanelPicture(osgText::Font* font, Corner corner = RIGHT);

    /// Shows a page. `words` must be the same each time.
    void show(osgViewer::View& view, const PanelPage& page, const PanelWords& words);
    void hide();

    /// The part of the panel at a pixel of the window.
    struct Spot
    {
        std::optional<std::size_t> row; ///< index in the list
        bool onBox = false;             ///< on the box that switches the row
    };
    /// Returns nothing for pixels beside the panel, and while it is hidden.
    std::optional<Spot> spotAt(double x, double y) const;

private:
    /// Sizes and places in pixels of the viewport.
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
