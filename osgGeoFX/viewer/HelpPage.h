// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Camera>
#include <osgGA/GUIEventHandler>
#include <osgText/Font>
#include <osgViewer/View>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** The keys of a viewer over its picture, to be read: in groups, in columns, lines broken where they would not fit.

    h shows the keys of the program's own handlers, H those of all others: OSG's handlers and camera manipulators, as their
    getUsage() tells. The same key again goes on to the next page, where there is more than one, and hides the last one. It takes the
    place of osgViewer::HelpHandler, whose page shrinks until its longest line fits. The page follows the window's size. Serves one
    view, in its event traversal. */
class OSGGEOFX_EXPORT HelpPage : public osgGA::GUIEventHandler
{
public:
    /// Handlers whose keys stand below a title; UTF-8.
    struct Group
    {
        std::string title;
        std::vector<osg::ref_ptr<const osgGA::GUIEventHandler>> handlers;
    };

    /// The groups of the program's own, in their order; one without keys is left out. `font` for the texts; null: that of OSG's
    /// own handlers, fonts/arial.ttf or what stands for it.
    explicit HelpPage(std::vector<Group> own, osgText::Font* font = nullptr);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// Whether a page is shown, and how many there are of its kind, own or OSG's; 0 while none is shown.
    bool shown() const { return _chapter != NONE; }
    std::size_t pages() const { return _pages.size(); }

    /// What stands on the page: a group's title, or a key and what it does with a tab between them. Empty while nothing is shown.
    std::vector<std::string> lines() const;

protected:
    ~HelpPage() override;

private:
    enum Chapter
    {
        NONE,
        OWN,
        OTHERS
    };
    /// A title has no key.
    struct Item
    {
        std::string key, text;
    };
    /// An item, its lines, and where the first of them stands.
    struct Block
    {
        Item item;
        std::vector<std::string> keyLines, textLines;
        std::size_t column = 0, row = 0;

        std::size_t height() const { return std::max(keyLines.size(), textLines.size()); }
    };
    using Items = std::vector<Item>;
    struct Layout;

    void turn(Chapter chapter, osgViewer::View& view);
    void hide();
    void update(osgViewer::View& view);
    Items ownItems() const;
    Items otherItems(osgViewer::View& view) const;
    Layout layout() const;
    void arrange(const Layout& page);
    void draw(const Layout& page);

    std::vector<Group> _own;
    osg::ref_ptr<osgText::Font> _font;
    osg::ref_ptr<osg::Camera> _overlay;
    Chapter _chapter = NONE;
    Items _items;
    std::vector<std::vector<Block>> _pages;
    std::size_t _page = 0;
    bool _drawn = false;
};

} // namespace osgGeoFX
