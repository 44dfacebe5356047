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

/** Shows the keys of a viewer over its picture: in groups and columns, with long lines broken.

    h shows the keys of the program's own handlers. H shows the keys of all other handlers and of the camera
    manipulator, as their getUsage() tells. The same key again shows the next page; after the last page it hides the
    help. It replaces osgViewer::HelpHandler, which shrinks its page until the longest line fits. The page follows the
    window's size. One handler serves one view, in its event traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT HelpPage : public osgGA::GUIEventHandler
{
public:
    /// Handlers whose keys stand below one title; UTF-8.
    struct Group
    {
        std::string title;
        std::vector<osg::ref_ptr<const osgGA::GUIEventHandler>> handlers;
    };

    /// `own`: the groups of the program's own handlers, in their order; groups without keys are left out. `font` is
    /// for the texts. Null: the font of OSG's own handlers, fonts/arial.ttf or its substitute.
    explicit HelpPage(std::vector<Group> own, osgText::Font* font = nullptr);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// Whether a page is shown; and the number of pages, own or OSG's, 0 while none is shown.
    bool shown() const { return _chapter != NONE; }
    std::size_t pages() const { return _pages.size(); }

    /// The texts on the page: a group's title, or a key and its action separated by a tab. Empty while no page is
    /// shown.
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
    /// A key and its action, or a title, which has no key.
    struct Item
    {
        std::string key, text;
    };
    /// An item, its broken lines, and the column and row of the first line.
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
    Layout layout(double spacing) const; ///< from line to line, in sizes of letters
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
