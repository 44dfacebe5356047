// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/LayerProbe.h>
#include <osgGeoFX/mapping/LayerSeries.h>

#include <osgGA/GUIEventHandler>
#include <osgText/Font>
#include <osgViewer/View>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

class EffectScene;

/** Shows the values of all layers below the pointer (LayerProbe), and plots those of a layer in time at a place (LayerSeries).

    The key v shows the values beside the pointer, or hides them; with layers in time they follow the clock. The key V plots the topmost
    sequence below the pointer over all of its time, with the clock's time marked; where there is none it hides the plot. In the plot, the left
    button sets the clock's time, "Save" writes a table (CSV) and "×" closes it. The steps are read beside the drawing; what is known so
    far shows. One panel serves one view, in its event traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT ProbePanel : public osgGA::GUIEventHandler
{
public:
    /// `font` is for the texts. Null: the font of OSG's own handlers, fonts/arial.ttf or its substitute.
    explicit ProbePanel(EffectScene& scene, osgText::Font* font = nullptr);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// Whether values are shown beside the pointer.
    bool shown() const { return _shown; }
    /// The texts shown there, UTF-8, the topmost layer first. Empty while they are hidden, and over the sky.
    std::vector<std::string> lines() const;

    /// What is plotted; null without a plot.
    const LayerSeries* series() const { return _series; }
    /// The title of the plot and what it says of the clock's time, or of a table that was written; empty without a plot.
    std::vector<std::string> plotLines() const;
    /// The folder of tables. They have the layer's name, and a number where there is such a file. Default: the present folder.
    void setFolder(const std::string& folder) { _folder = folder; }

protected:
    ~ProbePanel() override;

private:
    struct Content;
    osg::Vec2d pointer(const osg::Viewport& port) const;
    void plot(osgViewer::View& view);
    void closePlot();
    void save();
    void follow(osgViewer::View& view);
    void show(osgViewer::View& view);

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<osgText::Font> _font;
    osg::ref_ptr<osg::Camera> _overlay;
    std::string _folder = ".";
    bool _shown = false;
    bool _held = false;
    double _x = 0.0, _y = 0.0; ///< of the pointer in the window
    bool _moved = false;
    std::chrono::steady_clock::time_point _lastMove;
    osg::Matrixd _view; ///< the camera's, when the ground below the pointer was looked for
    std::optional<LayerProbe> _probe;
    osg::ref_ptr<LayerSeries> _series; ///< what is plotted
    std::map<const LayerSequence*, osg::ref_ptr<LayerSeries>> _all;
    std::string _title, _name, _unit, _note;
    std::unique_ptr<Content> _drawn;
};

} // namespace osgGeoFX
