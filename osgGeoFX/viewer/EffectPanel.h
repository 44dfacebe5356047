// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/ListPanel.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** A list of a scene's effects and all their properties over the window's upper left corner, to turn them by hand.

    F10 shows and hides it. Left and Right change the selected property by a step (stepped()), with Shift by ten, `,` and `.` by a
    tenth. Return or a click on a row's box switches a flag or an effect and takes the next choice; Return gives a number its
    default. What does not fit the effect's other properties is left as it is. */
class OSGGEOFX_EXPORT EffectPanel : public ListPanel
{
public:
    /// `font` for the texts; null: that of OSG's own handlers, fonts/arial.ttf or what stands for it.
    explicit EffectPanel(EffectScene& scene, osgText::Font* font = nullptr);

    void getUsage(osg::ApplicationUsage& usage) const override;

    /// What a property's value becomes by steps of a size that suits it: 1, 2 or 5 times a power of ten as people type it, a tenth of
    /// its default or, where that tells nothing, of its range. It stays in the range; flags and choices go round.
    static double stepped(const Property& property, double value, double steps);

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

    bool hasRows() const override { return _scene->getNumEffects() > 0; }
    bool changed() override;
    void list() override;
    void forget() override;
    std::size_t size() const override { return _entries.size(); }
    PanelPage::Row row(std::size_t number) const override;
    bool change(int code, int modifiers) override;
    void pressBox(std::size_t number) override;
    void add(PropertyHolder& holder, const Effect& effect, const std::string& prefix);
    static void step(const Entry& entry, double steps);
    static void press(const Entry& entry);

    osg::ref_ptr<EffectScene> _scene;
    std::vector<Entry> _entries;
    std::vector<osg::ref_ptr<const Effect>> _listed;
};

} // namespace osgGeoFX
