// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/viewer/PanelCursor.h>
#include <osgGeoFX/viewer/PanelPicture.h>

#include <osgGA/GUIEventHandler>

namespace osgGeoFX
{

/** What lists over a window's corner have in common, by which things of a scene are turned by hand: EffectPanel, MappingPanel.

    A key shows and hides the list; all else works while it is shown. Up, Down, Page Up, Page Down, Home and End or a click on a
    row select it; the wheel over the list scrolls it. What others change shows in the next frame. With nothing to list it is not
    shown. Serves one view, in its event traversal. */
class OSGGEOFX_EXPORT ListPanel : public osgGA::GUIEventHandler
{
public:
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    bool shown() const { return _shown; }

protected:
    using Event = osgGA::GUIEventAdapter;

    /// `font` for the texts; null: that of OSG's own handlers, fonts/arial.ttf or what stands for it.
    ListPanel(int toggleKey, const PanelWords& words, PanelPicture::Corner corner, osgText::Font* font);
    ~ListPanel() override;

    /// Whether there is something to list.
    virtual bool hasRows() const = 0;
    /// Whether what is listed is not what is there; asked at each event.
    virtual bool changed() = 0;
    /// Lists what is there, and keeps what is selected.
    virtual void list() = 0;
    /// Lets go of what is listed: what is removed while nothing is shown need not wait for this list.
    virtual void forget() = 0;
    /// What is listed.
    virtual std::size_t size() const = 0;
    virtual PanelPage::Row row(std::size_t number) const = 0;
    /// Selects a row, or the last one.
    virtual void choose(std::size_t number);
    /// What a key does to the selected row; false for other keys.
    virtual bool change(int code, int modifiers) = 0;
    /// A click on a row's box.
    virtual void pressBox(std::size_t number) = 0;
    /// A button beside the list; true where it was for the panel.
    virtual bool pushBeside(const Event& event, osgViewer::View& view);

    /// The rows that are shown.
    PanelPage page() const;

    PanelCursor _cursor;

private:
    void hide();
    bool key(int code, int modifiers);
    bool push(const Event& event, osgViewer::View* view);

    const int _toggleKey;
    const PanelWords _words;
    PanelPicture _picture;
    bool _shown = false;
    bool _held = false; ///< a button that went down on the list
};

} // namespace osgGeoFX
