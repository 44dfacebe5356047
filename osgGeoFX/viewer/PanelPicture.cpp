// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/PanelPicture.h>

#include <osgGeoFX/viewer/Overlay.h>

#include <osg/Geometry>
#include <osgText/Text>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

using Alignment = osgText::Text::AlignmentType;

const osg::Vec4 background(0.06f, 0.07f, 0.09f, 0.85f);
const osg::Vec4 marked(0.20f, 0.42f, 0.70f, 0.9f);
const osg::Vec4 bright(0.95f, 0.95f, 0.95f, 1.0f);
const osg::Vec4 dim(0.58f, 0.60f, 0.63f, 1.0f);
const osg::Vec4 brightOnMarked(1.0f, 1.0f, 1.0f, 1.0f);
const osg::Vec4 dimOnMarked(0.78f, 0.80f, 0.83f, 1.0f);

/// A title, the columns' names, and the two lines of keys below a gap.
constexpr double otherLines = 4.4;

// Columns, in heights of the text from the list's left edge.
constexpr double boxLeft = 0.3;
constexpr double nameLeft = 1.8;
constexpr double nameRight = 18.0;
constexpr double orderRight = 21.8;
constexpr double valueRight = 27.0;
constexpr double noteLeft = 28.2;
constexpr double listWidth = 34.0;

} // namespace

std::string PanelPage::count() const
{
    return std::to_string(total == 0 ? 0 : selected + 1) + " of " + std::to_string(total);
}

/// Collects boxes and texts, and gives them out as one group.
class PanelPicture::Painter
{
public:
    Painter(const Layout& layout, osgText::Font* font) : _layout(layout), _font(font)
    {
        _boxes->setVertexArray(_corners);
        _boxes->setColorArray(_colors, osg::Array::BIND_PER_VERTEX);
        _boxes->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
        _group->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
        _group->addChild(_boxes);
    }

    void box(double left, double bottom, double width, double height, const osg::Vec4& color)
    {
        const osg::Vec3d corner(std::round(left), std::round(bottom), 0.0);
        const double w = std::max(std::round(width), 1.0);
        const double h = std::max(std::round(height), 1.0);
        for (const osg::Vec3d& offset : {osg::Vec3d(), {w, 0.0, 0.0}, {w, h, 0.0}, {0.0, h, 0.0}})
        {
            _corners->push_back(osg::Vec3(corner + offset));
            _colors->push_back(color);
        }
    }

    /// An outline, with a square in it where it is on.
    void check(double x, double y, double side, double thin, bool on, const osg::Vec4& color)
    {
        box(x, y, side, thin, color);
        box(x, y + side - thin, side, thin, color);
        box(x, y, thin, side, color);
        box(x + side - thin, y, thin, side, color);
        if (on) box(x + 2.0 * thin, y + 2.0 * thin, side - 4.0 * thin, side - 4.0 * thin, color);
    }

    /// `column` in heights of the text; shortened to `room` pixels where that is above 0. `bottom` is the line's.
    void text(const std::string& words, double column, double bottom, Alignment alignment,
              const osg::Vec4& color, double room = 0.0)
    {
        if (words.empty()) return;
        osg::ref_ptr<osgText::Text> text = new osgText::Text;
        if (_font) text->setFont(_font);
        text->setCharacterSize(static_cast<float>(_layout.text));
        const auto resolution = static_cast<unsigned int>(std::clamp(_layout.text * 1.5, 16.0, 96.0));
        text->setFontResolution(resolution, resolution);
        text->setAlignment(alignment);
        text->setColor(color);
        const double x = _layout.left + _layout.margin + column * _layout.text;
        const double y = bottom + 0.5 * (_layout.line - 0.72 * _layout.text);
        text->setPosition(osg::Vec3(osg::Vec3d(std::round(x), std::round(y), 0.0)));
        osgText::String string(words, osgText::String::ENCODING_UTF8);
        text->setText(string);
        if (room > 0.0) shorten(*text, string, room);
        _group->addChild(text);
    }

    osg::ref_ptr<osg::Group> take()
    {
        _boxes->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, static_cast<int>(_corners->size())));
        return _group;
    }

private:
    static void shorten(osgText::Text& text, const osgText::String& string, double room)
    {
        // Names may be as long as a path, of which a hundred letters never fit.
        std::size_t kept = std::min<std::size_t>(string.size(), 100);
        const auto width = [&text]
        {
            const osg::BoundingBox& bound = text.getBoundingBox();
            return static_cast<double>(bound.xMax() - bound.xMin());
        };
        bool cut = kept < string.size();
        while (kept > 1)
        {
            if (cut)
            {
                osgText::String shorter(string);
                shorter.resize(kept);
                shorter.insert(shorter.end(), 3, '.');
                text.setText(shorter);
            }
            const double now = width();
            if (now <= room) return;
            cut = true;
            const auto guess = static_cast<std::size_t>(static_cast<double>(kept) * room / now);
            kept = std::clamp<std::size_t>(guess, 1, kept - 1);
        }
    }

    const Layout& _layout;
    osgText::Font* _font;
    osg::ref_ptr<osg::Group> _group = new osg::Group;
    osg::ref_ptr<osg::Geometry> _boxes = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> _corners = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> _colors = new osg::Vec4Array;
};

PanelPicture::PanelPicture(osgText::Font* font, Corner corner) : _font(font), _corner(corner) {}

PanelPicture::Layout PanelPicture::layout() const
{
    const double width = _overlay->getViewport()->width();
    const double height = _overlay->getViewport()->height();
    Layout layout{};
    layout.text = std::round(std::clamp(std::min(height / 52.0, width / 64.0), 8.0, 48.0));
    layout.line = std::round(layout.text * 1.5);
    layout.margin = std::round(layout.text * 0.7);
    layout.width = std::round(listWidth * layout.text) + 2.0 * layout.margin;
    layout.height = (static_cast<double>(rows) + otherLines) * layout.line + 2.0 * layout.margin;
    layout.left = _corner == LEFT ? layout.margin : width - layout.width - layout.margin;
    layout.bottom = height - layout.height - layout.margin;
    layout.rowsTop = layout.bottom + layout.height - layout.margin - 2.0 * layout.line;
    return layout;
}

void PanelPicture::show(osgViewer::View& view, const PanelPage& page, const PanelWords& words)
{
    if (!view.getCamera()->getViewport()) return;
    // As OSG's own handlers; where there is none, null is OSG's coarse built-in font.
    if (!_overlay && !_font) _font = osgText::readRefFontFile("fonts/arial.ttf");
    if (showOverlay(view, _overlay, 9)) _drawn = false;
    _visible = true;
    if (_drawn && page == _page) return;
    _page = page;
    draw(words);
    _drawn = true;
}

void PanelPicture::hide()
{
    _visible = false;
    if (_overlay) _overlay->setNodeMask(0u);
}

std::optional<PanelPicture::Spot> PanelPicture::spotAt(double x, double y) const
{
    if (!_visible) return std::nullopt;
    const osg::Viewport& port = *_overlay->getViewport();
    const Layout list = layout();
    const double across = x - port.x() - list.left;
    const double above = y - port.y() - list.bottom;
    if (across < 0.0 || above < 0.0 || across >= list.width || above >= list.height) return std::nullopt;
    Spot spot;
    const double line = std::floor((list.rowsTop - list.bottom - above) / list.line);
    if (line >= 0.0 && line < static_cast<double>(_page.rows.size()))
    {
        spot.row = _page.first + static_cast<std::size_t>(line);
        spot.onBox = across < list.margin + (nameLeft - 0.2) * list.text;
    }
    return spot;
}

void PanelPicture::draw(const PanelWords& words)
{
    const Layout list = layout();
    Painter painter(list, _font);
    const auto left = osgText::Text::LEFT_BASE_LINE;
    const auto right = osgText::Text::RIGHT_BASE_LINE;
    painter.box(list.left, list.bottom, list.width, list.height, background);
    painter.text(words.title, boxLeft, list.rowsTop + list.line, left, bright);
    painter.text(_page.count(), listWidth - boxLeft, list.rowsTop + list.line, right, bright);
    painter.text(words.name, nameLeft, list.rowsTop, left, dim);
    painter.text(words.order, orderRight, list.rowsTop, right, dim);
    painter.text(words.value, valueRight, list.rowsTop, right, dim);
    painter.text(words.note, noteLeft, list.rowsTop, left, dim);

    const double inner = list.left + list.margin;
    const double thin = std::max(std::round(list.text / 12.0), 1.0);
    for (std::size_t i = 0; i < _page.rows.size(); ++i)
    {
        const PanelPage::Row& row = _page.rows[i];
        const double bottom = list.rowBottom(i);
        const bool selected = _page.first + i == _page.selected;
        if (selected) painter.box(inner, bottom, listWidth * list.text, list.line, marked);
        const osg::Vec4 color =
            selected ? (row.inForce ? brightOnMarked : dimOnMarked) : (row.inForce ? bright : dim);
        const double side = std::round(0.8 * list.text);
        const double x = std::round(inner + boxLeft * list.text);
        if (row.box)
            painter.check(x, std::round(bottom + 0.5 * (list.line - side)), side, thin, row.on, color);
        painter.text(row.name, nameLeft, bottom, left, color, (nameRight - nameLeft) * list.text);
        painter.text(row.order, orderRight, bottom, right, color);
        painter.text(row.value, valueRight, bottom, right, color);
        painter.text(row.note, noteLeft, bottom, left, color);
    }
    if (_page.total > rows)
    {
        // Where these rows are in the whole list.
        const double height = static_cast<double>(rows) * list.line;
        const auto share = static_cast<double>(rows) / static_cast<double>(_page.total);
        const double bar = std::max(share * height, list.text);
        const double way = static_cast<double>(_page.first) / static_cast<double>(_page.total - rows);
        painter.box(inner + listWidth * list.text + thin, list.rowsTop - bar - way * (height - bar),
                    3.0 * thin, bar, dim);
    }
    painter.text(words.keysAbove, boxLeft, list.bottom + list.margin + list.line, left, dim);
    painter.text(words.keysBelow, boxLeft, list.bottom + list.margin, left, dim);
    _overlay->removeChildren(0, _overlay->getNumChildren());
    _overlay->addChild(painter.take());
}

} // namespace osgGeoFX
