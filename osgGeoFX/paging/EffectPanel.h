// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/MappingPanelPicture.h>
#include <osgGeoFX/mapping/PanelCursor.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osgGA/GUIEventHandler>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** A list of a scene's effects and all their properties over the window's upper left corner, to turn them by hand.

    F10 shows and hides it; all else works while it is shown. Up, Down, Page Up, Page Down, Home and End or a click on a row
    select a property; the wheel over the list scrolls it. Left and Right change it by a step (stepped()), with Shift
    by ten, `,` and `.` by a tenth. Return or a click on a row's box switches a flag or an effect and takes the next choice;
    Return gives a number its default. What does not fit the effect's other properties is left as it is.

    What others change shows in the next frame. Serves one view, in its event traversal. */
class OSGGEOFX_EXPORT EffectPanel : public osgGA::GUIEventHandler
{
public:
    /// `font` for the texts; null: that of OSG's own handlers, fonts/arial.ttf or what stands for it.
    explicit EffectPanel(EffectScene& scene, osgText::Font* font = nullptr);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// What a property's value becomes by steps of a size that suits it: 1, 2 or 5 times a power of ten as people type it, a tenth of
    /// its default or, where that tells nothing, of its range. It stays in the range; flags and choices go round.
    static double stepped(const Property& property, double value, double steps);

    bool shown() const { return _shown; }
    /// What is shown: "3 of 120", then for each row its name, value and unit with tabs between them; an effect's own row has its
    /// kind, and "true" or "false". Empty while nothing is shown.
    std::vector<std::string> lines() const;

protected:
    ~EffectPanel() override;

private:
    struct Entry
    {
        osg::ref_ptr<PropertyHolder> holder;
        const Property* property;
        std::string label;
        const Effect* effect;
    };

    bool changed() const;
    void list();
    void add(PropertyHolder& holder, const Effect& effect, const std::string& prefix);
    void hide();
    PanelPage page() const;
    bool key(int code, int modifiers);
    bool push(const osgGA::GUIEventAdapter& event);
    static void step(const Entry& entry, double steps);
    static void press(const Entry& entry);

    osg::ref_ptr<EffectScene> _scene;
    MappingPanelPicture _picture;
    bool _shown = false;
    bool _held = false; ///< a button that went down on the list
    std::vector<Entry> _entries;
    std::vector<osg::ref_ptr<const Effect>> _listed;
    PanelCursor _cursor;
};

} // namespace osgGeoFX
