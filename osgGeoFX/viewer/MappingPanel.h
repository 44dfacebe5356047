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

/** A list of a scene's mappings in the upper right corner of the window, the topmost mapping first. The user switches
    and changes them by keys and clicks.

    F9 shows and hides the list. Alt and a click on the ground select the topmost mapping there. Return, or a click on
    a row's box, switches a mapping on or off. Left and Right change its opacity, - and + its order, `,` and `.` its
    blending. A blending that is none of the usual kinds is named "custom". The blending belongs to the mapping's
    ColorTransfer, so mappings that share one change together.

    A route (RouteMapping) is one row, of the note "route" in the place of the blending. A mapping is listed by its name, else by the name of its layer or the file name of the layer's image, else by its
    number in its effect.

    If there are thousands of mappings and a program changes an order, the list shows the new order some frames later.
    @ingroup viewer */
class OSGGEOFX_EXPORT MappingPanel : public ListPanel
{
public:
    /// `font` is for the texts. Null: the font of OSG's own handlers, fonts/arial.ttf or its substitute.
    explicit MappingPanel(EffectScene& scene, osgText::Font* font = nullptr);

    void getUsage(osg::ApplicationUsage& usage) const override;

    /// Whether the scene has a ProjectiveMappings effect.
    bool hasEffect() const;
    /// The selected mapping. Null if there is none or a route, and while the list is hidden.
    ProjectiveMapping* selected();
    /// The text shown, UTF-8: "3 of 120", then for each row "on" or "off", name, order, opacity and blending,
    /// separated by tabs. Names are not shortened here. Empty while the list is hidden.
    std::vector<std::string> lines() const;

protected:
    ~MappingPanel() override;

private:
    struct Entry
    {
        osg::ref_ptr<PropertyHolder> item; ///< a mapping or a route
        ProjectiveMapping* mapping;        ///< null for a route
        const ProjectiveMappings* effect;
        unsigned int number; ///< index in the effect
        int order;           ///< when the list was sorted

        int orderNow() const { return static_cast<int>(item->getProperty("order")); }
        bool enabled() const { return item->getProperty("enabled") > 0.0; }
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

    static void set(const Entry& entry, const char* property, double value);
    std::vector<ProjectiveMappings*> effects() const;
    void collect();

    osg::ref_ptr<EffectScene> _scene;

    std::vector<Entry> _entries;                                                    ///< topmost first
    std::vector<std::pair<osg::ref_ptr<ProjectiveMappings>, unsigned int>> _listed; ///< with their revisions
    std::size_t _checked = 0;
    osg::observer_ptr<PropertyHolder> _selected;
};

} // namespace osgGeoFX
