// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/viewer/ListPanel.h>

#include <osg/observer_ptr>

#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

class EffectScene;

/** A list of a scene's mappings over the window's upper right corner, the topmost first, to switch and change them by hand.

    F9 shows and hides it. Alt and a click on the ground select a mapping, too (the topmost one there). Return or a click on a row's
    box switches a mapping, Left and Right change its opacity, - and + its order, `,` and `.` its blending. A blending of none of
    the usual kinds is called "custom". Blending belongs to the mapping's color transfer: mappings that share one change together.

    A mapping is called by its name, else by that of its layer or the layer's picture, else by its number in its effect.

    An order that others change among more than some thousands of mappings shows a few frames later. */
class OSGGEOFX_EXPORT MappingPanel : public ListPanel
{
public:
    /// `font` for the texts; null: that of OSG's own handlers, fonts/arial.ttf or what stands for it.
    explicit MappingPanel(EffectScene& scene, osgText::Font* font = nullptr);

    void getUsage(osg::ApplicationUsage& usage) const override;

    /// Whether the scene has an effect whose mappings can be listed.
    bool hasEffect() const;
    /// Null where there is none, and while nothing is shown.
    ProjectiveMapping* selected();
    /// What is shown, UTF-8: "3 of 120", then for each row "on" or "off", name, order, opacity and blending with tabs
    /// between them. Names are whole here. Empty while nothing is shown.
    std::vector<std::string> lines() const;

protected:
    ~MappingPanel() override;

private:
    struct Entry
    {
        osg::ref_ptr<ProjectiveMapping> mapping;
        const ProjectiveMappings* effect;
        unsigned int number; ///< among the effect's
        int order;           ///< as sorted
    };

    bool hasRows() const override { return hasEffect(); }
    bool changed() override;
    void list() override;
    void forget() override;
    std::size_t size() const override { return _entries.size(); }
    PanelPage::Row row(std::size_t number) const override;
    void choose(std::size_t number) override;
    bool change(int code, int modifiers) override;
    void pressBox(std::size_t number) override;
    bool pushBeside(const Event& event, osgViewer::View& view) override;

    std::vector<ProjectiveMappings*> effects() const;
    void collect();

    osg::ref_ptr<EffectScene> _scene;

    std::vector<Entry> _entries;                                                    ///< topmost first
    std::vector<std::pair<osg::ref_ptr<ProjectiveMappings>, unsigned int>> _listed; ///< with their revisions
    std::size_t _checked = 0;
    osg::observer_ptr<ProjectiveMapping> _selected;
};

} // namespace osgGeoFX
