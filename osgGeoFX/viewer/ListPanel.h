// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/viewer/PanelCursor.h>
#include <osgGeoFX/viewer/PanelPicture.h>

#include <osgGA/GUIEventHandler>

namespace osgGeoFX
{

/** The base class of the lists in a corner of the window with which the user changes a scene by hand: EffectPanel and
    MappingPanel.

    A key shows and hides the list; all other input works only while it is shown. Up, Down, Page Up, Page Down, Home
    and End or a click select a row. The wheel over the list scrolls it. Changes made by others show in the next frame.
    An empty list is not shown. One panel serves one view, in its event traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT ListPanel : public osgGA::GUIEventHandler
{
public:
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    bool shown() const { return _shown; }

protected:
    using Event = osgGA::GUIEventAdapter;

    /// `font` is for the texts. Null: the font of OSG's own handlers, fonts/arial.ttf or its substitute.
    ListPanel(int toggleKey, const PanelWords& words, PanelPicture::Corner corner, osgText::Font* font);
    ~ListPanel() override;

    /// Whether there is something to list.
    virtual bool hasRows() const = 0;
    /// Whether the list no longer matches the scene. Called at each event.
    virtual bool changed() = 0;
    /// Builds the list from the scene and keeps the selection.
    virtual void list() = 0;
    /// Releases the listed objects when the list is hidden, so that it does not keep removed objects alive.
    virtual void forget() = 0;
    /// The number of listed rows.
    virtual std::size_t size() const = 0;
    virtual PanelPage::Row row(std::size_t number) const = 0;
    /// Selects a row, or the last row if the number is too large.
    virtual void choose(std::size_t number);
    /// Applies a key to the selected row. Returns false for all other keys.
    virtual bool change(int code, int modifiers) = 0;
    /// Handles a click on a row's box.
    virtual void pressBox(std::size_t number) = 0;
    /// Handles a click beside the list. Returns true if the panel has used it.
    virtual bool pushBeside(const Event& event, osgViewer::View& view);

    /// The rows that are shown now.
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
    bool _held = false; ///< a button went down on the list and is still held
};

} // namespace osgGeoFX
