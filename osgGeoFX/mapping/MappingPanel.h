// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/MappingPanelPicture.h>
#include <osgGeoFX/mapping/PanelCursor.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <osg/observer_ptr>
#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

class EffectScene;

/** A list of a scene's mappings over the window's upper right corner, the topmost first, to switch and change them by hand.

    F9 shows and hides it; all else works while it is shown. Up, Down, Page Up, Page Down, Home and End, a click on a row,
    or Alt and a click on the ground select a mapping (the topmost one there); the wheel over the list scrolls it. Return
    or a click on a row's box switches a mapping, Left and Right change its opacity, - and + its order, `,` and `.` its
    blending. A blending of none of the usual kinds is called "custom". Blending belongs to the mapping's color transfer:
    mappings that share one change together.

    A mapping is called by its name, else by that of its layer or the layer's picture, else by its number in its effect.

    What others change shows in the next frame; an order among more than some thousands of mappings a few frames later.
    Serves one view, in its event traversal. Without an effect ProjectiveMappings it does nothing. */
class OSGGEOFX_EXPORT MappingPanel : public osgGA::GUIEventHandler
{
public:
    /// `font` for the texts; null: that of OSG's own handlers, fonts/arial.ttf or what stands for it.
    explicit MappingPanel(EffectScene& scene, osgText::Font* font = nullptr);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// Whether the scene has an effect whose mappings can be listed.
    bool hasEffect() const;
    bool shown() const { return _shown; }
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

    std::vector<ProjectiveMappings*> effects() const;
    bool changed();
    void relist();
    void list();
    void choose(std::size_t row);
    void hide();
    PanelPage page() const;

    bool key(int code);
    bool change(int code, ProjectiveMapping& mapping);
    bool push(const osgGA::GUIEventAdapter& event, osgViewer::View& view);
    bool pick(const osgGA::GUIEventAdapter& event, osgViewer::View& view);
    bool scroll(const osgGA::GUIEventAdapter& event);

    osg::ref_ptr<EffectScene> _scene;
    MappingPanelPicture _picture;
    bool _shown = false;
    bool _held = false; ///< a button that went down on the list

    std::vector<Entry> _entries;                                                    ///< topmost first
    std::vector<std::pair<osg::ref_ptr<ProjectiveMappings>, unsigned int>> _listed; ///< with their revisions
    std::size_t _checked = 0;
    PanelCursor _cursor;
    osg::observer_ptr<ProjectiveMapping> _selected;
};

} // namespace osgGeoFX
