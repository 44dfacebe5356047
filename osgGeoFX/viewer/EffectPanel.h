// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/ListPanel.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** A list of a scene's effects and all their properties in the upper left corner of the window. The user changes them
    by keys and clicks.

    F10 shows and hides the list. Left and Right change the selected property by one step (stepped()), with Shift by
    ten; `,` and `.` change it by a tenth. Return, or a click on the row's box, switches a flag or an effect, or
    selects the next choice. Return resets a number to its default. A value that contradicts the effect's other
    properties is rejected, and the property stays as it is.
    @ingroup viewer */
class OSGGEOFX_EXPORT EffectPanel : public ListPanel
{
public:
    /// `font` is for the texts. Null: the font of OSG's own handlers, fonts/arial.ttf or its substitute.
    explicit EffectPanel(EffectScene& scene, osgText::Font* font = nullptr);

    void getUsage(osg::ApplicationUsage& usage) const override;

    /// Adds a button at the end of the list: a row with a text, UTF-8, that a click on its box or Return presses.
    /// `press` runs in the event traversal. With a button the list is shown even where the scene has no effects.
    void addButton(const std::string& text, std::function<void()> press);

    /// A property's value after some steps. The step is 1, 2 or 5 times a power of ten in the unit that people type
    /// (angles: degrees): about a tenth of the default value or, if that is near 0, of the range. A fraction of a step
    /// counts as a tenth of a step; integers change by at least 1. The value stays in the range; flags and choices
    /// wrap around.
    static double stepped(const Property& property, double value, double steps);

    /// The text shown: "3 of 120", then for each row its name, value and unit, separated by tabs. The row of an effect
    /// has its kind, and "true" or "false". Empty while the list is hidden.
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

    struct Button
    {
        std::string text;
        std::function<void()> press;
    };

    bool hasRows() const override { return _scene->getNumEffects() > 0 || !_buttons.empty(); }
    bool changed() override;
    void list() override;
    void forget() override;
    std::size_t size() const override { return _entries.size() + _buttons.size(); }
    PanelPage::Row row(std::size_t number) const override;
    bool change(int code, int modifiers) override;
    void pressBox(std::size_t number) override;
    void add(PropertyHolder& holder, const Effect& effect, const std::string& prefix);
    static void step(const Entry& entry, double steps);
    static void press(const Entry& entry);

    osg::ref_ptr<EffectScene> _scene;
    std::vector<Entry> _entries;
    std::vector<Button> _buttons;          ///< their rows follow those of the entries
    std::optional<std::size_t> _rowsAbove; ///< of the buttons, while the list is shown
    std::vector<osg::ref_ptr<const Effect>> _listed;
};

} // namespace osgGeoFX
