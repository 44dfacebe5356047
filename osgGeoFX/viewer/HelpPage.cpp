// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/HelpPage.h>

#include <osgGeoFX/viewer/Overlay.h>

#include <osg/Geometry>
#include <osgGA/CameraManipulator>
#include <osgText/Text>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <tuple>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;

constexpr int ownKey = 'h';
constexpr int othersKey = 'H';
const char* const ownTitle = "Keys";
const char* const othersTitle = "Keys of OpenSceneGraph";

const osg::Vec4 background(0.06f, 0.07f, 0.09f, 0.92f);
const osg::Vec4 bright(0.95f, 0.95f, 0.95f, 1.0f);
const osg::Vec4 keyColor(1.0f, 0.83f, 0.45f, 1.0f);
const osg::Vec4 titleColor(0.55f, 0.78f, 1.0f, 1.0f);
const osg::Vec4 dim(0.66f, 0.68f, 0.71f, 1.0f);

/// Of a column's width, for the keys.
constexpr double keyShare = 0.31;

/// Lines above and below the columns: title and keys of the page itself, with a gap each.
constexpr double otherLines = 3.6;

/// F2 before F10, function keys before all else, small letters beside large ones.
std::tuple<int, int, std::string, std::string> orderOf(const std::string& key)
{
    const bool isFunction =
        key.size() > 1 && key[0] == 'F' && std::isdigit(static_cast<unsigned char>(key[1]));
    std::string small = key;
    for (char& letter : small)
        letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return {isFunction ? 0 : 1, isFunction ? std::stoi(key.substr(1)) : 0, small, key};
}

using Bindings = std::vector<std::pair<std::string, std::string>>;

Bindings sorted(const osg::ApplicationUsage& usage)
{
    const auto& map = usage.getKeyboardMouseBindings();
    Bindings result(map.begin(), map.end());
    std::sort(result.begin(), result.end(),
              [](const auto& a, const auto& b) { return orderOf(a.first) < orderOf(b.first); });
    return result;
}

osg::ref_ptr<osgText::Text> makeText(osgText::Font* font, double size)
{
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    if (font) text->setFont(font);
    text->setCharacterSize(static_cast<float>(size));
    const auto resolution = static_cast<unsigned int>(std::clamp(size * 1.5, 16.0, 96.0));
    text->setFontResolution(resolution, resolution);
    text->setAlignment(osgText::Text::LEFT_BASE_LINE);
    return text;
}

/// Breaks texts into lines by the widths that they have on the screen.
class Breaker
{
public:
    Breaker(osgText::Font* font, double size) : _text(makeText(font, size)) {}

    double width(const std::string& words)
    {
        _text->setText(osgText::String(words, osgText::String::ENCODING_UTF8));
        const osg::BoundingBox& bound = _text->getBoundingBox();
        return bound.valid() ? static_cast<double>(bound.xMax()) : 0.0;
    }

    std::vector<std::string> lines(const std::string& words, double room)
    {
        std::vector<std::string> result;
        std::string line;
        std::size_t begin = 0;
        while (begin < words.size())
        {
            const std::size_t end = std::min(words.find_first_of(" \n", begin), words.size());
            std::string word = words.substr(begin, end - begin);
            begin = end + 1;
            if (word.empty()) continue;
            std::string longer = line;
            if (!longer.empty()) longer += " ";
            longer += word;
            if (width(longer) <= room)
            {
                line = longer;
                continue;
            }
            if (!line.empty()) result.push_back(line);
            line = cut(word, room, result);
        }
        if (!line.empty() || result.empty()) result.push_back(line);
        return result;
    }

private:
    /// A word that is wider than a line is cut; what is left of it.
    std::string cut(std::string word, double room, std::vector<std::string>& lines)
    {
        while (width(word) > room)
        {
            std::size_t kept = word.size() - 1;
            while (kept > 1 && (isWithinLetter(word[kept]) || width(word.substr(0, kept)) > room))
                --kept;
            if (kept == 0) break;
            lines.push_back(word.substr(0, kept));
            word.erase(0, kept);
        }
        return word;
    }
    /// UTF-8 has letters of several bytes.
    static bool isWithinLetter(char byte) { return (static_cast<unsigned char>(byte) & 0xc0u) == 0x80u; }

    osg::ref_ptr<osgText::Text> _text;
};

} // namespace

/// Pixels of the viewport.
struct HelpPage::Layout
{
    double text = 0.0, line = 0.0, margin = 0.0;
    double left = 0.0, bottom = 0.0, width = 0.0, height = 0.0;
    std::size_t columns = 1, rows = 1;
    double columnWidth = 0.0, gap = 0.0;

    double x(std::size_t column) const
    {
        return left + margin + static_cast<double>(column) * (columnWidth + gap);
    }
    /// Of a line's foot; row 0 is the first below the title.
    double y(double row) const { return bottom + height - margin - line * (row + 2.8); }
};

HelpPage::HelpPage(std::vector<Group> own, osgText::Font* font) : _own(std::move(own)), _font(font) {}

HelpPage::~HelpPage() = default;

void HelpPage::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("h", "Show the program's keys, the next page of them, or none");
    usage.addKeyboardMouseBinding("H", "Show the keys of OpenSceneGraph, the next page of them, or none");
}

std::vector<std::string> HelpPage::lines() const
{
    std::vector<std::string> result;
    if (!shown() || _page >= _pages.size()) return result;
    for (const Block& block : _pages[_page])
        result.push_back(block.item.key.empty() ? block.item.text : block.item.key + "\t" + block.item.text);
    return result;
}

HelpPage::Items HelpPage::ownItems() const
{
    Items items;
    for (const Group& group : _own)
    {
        const osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
        for (const auto& handler : group.handlers)
            handler->getUsage(*usage);
        const Bindings bindings = sorted(*usage);
        if (bindings.empty()) continue;
        items.push_back({"", group.title});
        for (const auto& [key, text] : bindings)
        {
            // "Panorama: left button" says below the title "Panorama map" what is said already.
            const std::size_t colon = key.find(": ");
            const bool isSaid = colon != std::string::npos && group.title.rfind(key.substr(0, colon), 0) == 0;
            items.push_back({isSaid ? key.substr(colon + 2) : key, text});
        }
    }
    return items;
}

HelpPage::Items HelpPage::otherItems(osgViewer::View& view) const
{
    std::set<const osgGA::EventHandler*> own{this};
    std::set<std::pair<std::string, std::string>> known;
    for (const Group& group : _own)
    {
        const osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
        for (const auto& handler : group.handlers)
        {
            own.insert(handler);
            handler->getUsage(*usage);
        }
        known.insert(usage->getKeyboardMouseBindings().begin(), usage->getKeyboardMouseBindings().end());
    }
    const osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
    for (const auto& handler : view.getEventHandlers())
        if (own.count(handler.get()) == 0) handler->getUsage(*usage);
    Items items;
    const auto add = [&](const std::string& title, const osg::ApplicationUsage& from)
    {
        const std::size_t first = items.size();
        for (const auto& [key, text] : sorted(from))
            if (known.count({key, text}) == 0) items.push_back({key, text});
        if (items.size() > first)
            items.insert(items.begin() + static_cast<std::ptrdiff_t>(first), {"", title});
    };
    add("Window and picture", *usage);
    const osg::ref_ptr<osg::ApplicationUsage> camera = new osg::ApplicationUsage;
    if (view.getCameraManipulator()) view.getCameraManipulator()->getUsage(*camera);
    add("Camera", *camera);
    return items;
}

HelpPage::Layout HelpPage::layout(double spacing) const
{
    const double width = _overlay->getViewport()->width();
    const double height = _overlay->getViewport()->height();
    Layout page;
    page.text = std::round(std::clamp(std::min(height / 45.0, width / 60.0), 9.0, 40.0));
    page.line = std::round(page.text * spacing);
    page.margin = std::round(page.text);
    page.gap = 2.0 * page.text;
    page.left = page.margin;
    page.bottom = page.margin;
    page.width = std::max(width - 2.0 * page.left, 1.0);
    page.height = std::max(height - 2.0 * page.bottom, 1.0);
    page.columns =
        static_cast<std::size_t>(std::clamp(std::floor(page.width / (32.0 * page.text)), 1.0, 3.0));
    const auto columns = static_cast<double>(page.columns);
    page.columnWidth =
        std::max((page.width - 2.0 * page.margin - (columns - 1.0) * page.gap) / columns, 4.0 * page.text);
    page.rows = static_cast<std::size_t>(
        std::max(std::floor((page.height - 2.0 * page.margin) / page.line - otherLines), 1.0));
    return page;
}

void HelpPage::arrange(const Layout& page)
{
    _pages.clear();
    Breaker breaker(_font, page.text);
    const double keyRoom = keyShare * page.columnWidth - page.text;
    std::vector<Block> blocks;
    for (const Item& item : _items)
    {
        Block block{item, {}, {}, 0, 0};
        if (!item.key.empty()) block.keyLines = breaker.lines(item.key, keyRoom);
        block.textLines = breaker.lines(item.text, item.key.empty() ? page.columnWidth
                                                                    : (1.0 - keyShare) * page.columnWidth);
        blocks.push_back(block);
    }
    std::size_t column = page.columns;
    std::size_t row = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i)
    {
        Block& block = blocks[i];
        const bool isTitle = block.item.key.empty();
        // A title is set off, and stays with the first of its keys.
        if (isTitle && row > 0) ++row;
        std::size_t needed = block.height();
        if (isTitle && i + 1 < blocks.size()) needed += blocks[i + 1].height();
        if (column >= page.columns || (row > 0 && row + needed > page.rows))
        {
            ++column;
            row = 0;
            if (column >= page.columns)
            {
                _pages.emplace_back();
                column = 0;
            }
        }
        block.column = column;
        block.row = row;
        row += block.height();
        _pages.back().push_back(block);
    }
    if (_pages.empty()) _pages.emplace_back();
    _page = std::min(_page, _pages.size() - 1);
}

void HelpPage::draw(const Layout& page)
{
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
    const osg::ref_ptr<osg::Geometry> box = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (const osg::Vec2d& share : {osg::Vec2d(0.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
        corners->push_back(osg::Vec3(
            osg::Vec3d(page.left + share.x() * page.width, page.bottom + share.y() * page.height, 0.0)));
    box->setVertexArray(corners);
    box->setColorArray(new osg::Vec4Array(1, &background), osg::Array::BIND_OVERALL);
    box->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, 4));
    box->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    group->addChild(box);
    const auto add = [&](const std::string& words, double x, double y, const osg::Vec4& color)
    {
        if (words.empty()) return;
        const osg::ref_ptr<osgText::Text> text = makeText(_font, page.text);
        text->setColor(color);
        text->setPosition(osg::Vec3(osg::Vec3d(std::round(x), std::round(y), 0.0)));
        text->setText(osgText::String(words, osgText::String::ENCODING_UTF8));
        group->addChild(text);
    };
    std::string title = _chapter == OWN ? ownTitle : othersTitle;
    if (_pages.size() > 1)
        title += "   " + std::to_string(_page + 1) + " of " + std::to_string(_pages.size());
    add(title, page.x(0), page.y(-1.8), bright);
    for (const Block& block : _pages[_page])
    {
        const bool isTitle = block.item.key.empty();
        const auto row = static_cast<double>(block.row);
        for (std::size_t i = 0; i < block.keyLines.size(); ++i)
            add(block.keyLines[i], page.x(block.column), page.y(row + static_cast<double>(i)), keyColor);
        const double x = page.x(block.column) + (isTitle ? 0.0 : keyShare * page.columnWidth);
        for (std::size_t i = 0; i < block.textLines.size(); ++i)
            add(block.textLines[i], x, page.y(row + static_cast<double>(i)), isTitle ? titleColor : bright);
    }
    const bool isLast = _page + 1 == _pages.size();
    const std::string same = isLast ? "close" : "next page";
    add(_chapter == OWN ? "h  " + same + "      H  keys of OpenSceneGraph"
                        : "H  " + same + "      h  the program's keys",
        page.x(0), page.bottom + page.margin, dim);
    // New objects, so that a frame that is still being drawn keeps its own.
    _overlay->removeChildren(0, _overlay->getNumChildren());
    _overlay->addChild(group);
}

void HelpPage::turn(Chapter chapter, osgViewer::View& view)
{
    if (_chapter == chapter && _page + 1 >= _pages.size()) return hide();
    if (_chapter == chapter)
    {
        ++_page;
    }
    else
    {
        _chapter = chapter;
        _page = 0;
        _items = chapter == OWN ? ownItems() : otherItems(view);
    }
    _drawn = false;
    update(view);
}

void HelpPage::hide()
{
    _chapter = NONE;
    _pages.clear();
    _page = 0;
    if (_overlay) _overlay->setNodeMask(0u);
}

void HelpPage::update(osgViewer::View& view)
{
    if (!view.getCamera()->getViewport()) return;
    // As OSG's own handlers; where there is none, null is OSG's coarse built-in font.
    if (!_overlay && !_font) _font = osgText::readRefFontFile("fonts/arial.ttf");
    // Over the lists of effects and mappings.
    if (showOverlay(view, _overlay, 11)) _drawn = false;
    if (_drawn) return;
    // Some fonts are wide: lines nearer to each other are better than a second page.
    constexpr double wide = 1.25, narrow = 1.13; // from line to line, in sizes of letters
    Layout page = layout(wide);
    arrange(page);
    if (_pages.size() > 1)
    {
        const Layout denser = layout(narrow);
        arrange(denser);
        if (_pages.size() == 1)
            page = denser;
        else
            arrange(page);
    }
    draw(page);
    _drawn = true;
}

bool HelpPage::handle(const Event& event, osgGA::GUIActionAdapter& action)
{
    auto* view = dynamic_cast<osgViewer::View*>(&action);
    if (!view) return false;
    if (event.getEventType() == Event::FRAME && shown()) update(*view);
    if (event.getEventType() != Event::KEYDOWN) return false;
    if (event.getKey() != ownKey && event.getKey() != othersKey) return false;
    turn(event.getKey() == ownKey ? OWN : OTHERS, *view);
    action.requestRedraw();
    return true;
}

} // namespace osgGeoFX
