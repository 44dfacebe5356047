// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/ValueLegend.h>

namespace osgGeoFX
{

/** Numbers as colours over the terrain: noise, concentrations, heights, classes; with lines at round values where wanted, and
    a legend in the same colours (Trapp and Döllner 2009, Section 5 and Figure 3.A).

    @code
    osg::ref_ptr<osgGeoFX::ValueMap> map = new osgGeoFX::ValueMap(mappings, noise, colors);
    map->mapping().setRectangle({0.0, 0.0}, 5000.0, 4000.0);
    map->setRange(40.0, 80.0);
    map->setLines(5.0, 30.0);
    hud->addChild(map->legend({"Noise", "dB(A)"}));
    @endcode
    Place, opacity, fades and order are those of its mapping; the lines follow it. Changed between frames by the thread of the frame loop; the
    destructor takes it away. */
class OSGGEOFX_EXPORT ValueMap : public osg::Referenced, private PropertyListener
{
public:
    /// A layer of values or classes, and a table that is shared and may be changed: refresh() then. Values below the
    /// range take the colour of its lower end, those above that of the upper one. The range is the table's at first.
    ValueMap(ProjectiveMappings& mappings, DataLayer* values, ColorTable* colors, int order = 0);

    ProjectiveMapping& mapping() { return *_mapping; }
    /// Null is refused.
    bool setColors(ColorTable* colors);
    ColorTable& colors() { return *_colors; }
    /// The values at the ends of the colours, in the layer's unit; the first is the lower one.
    bool setRange(double low, double high);
    double getLow() const { return _low; }
    double getHigh() const { return _high; }
    /// Lines of equal value at the multiples of `step` within the range, in the layer's unit; 0 for none. Their width is
    /// in metres. They are a mapping of their own that lies where the map does. Values only; classes have none.
    bool setLines(double step, double width = 40.0, const osg::Vec4& color = {0.0f, 0.0f, 0.0f, 0.6f});
    /// To be called after the table or the layer's picture changed.
    void refresh();

    /// Null without lines.
    const ProjectiveMapping* lines() const { return _lines.get(); }
    /// A legend with the colours of the map as they are now. Null where it makes no sense; see makeLegend().
    osg::ref_ptr<osg::Group> legend(const LegendStyle& style) const;

protected:
    ~ValueMap() override;

private:
    void propertyChanged(PropertyHolder& mapping) override;
    void makeLines();
    void placeLines();

    osg::ref_ptr<ProjectiveMappings> _host;
    osg::ref_ptr<ProjectiveMapping> _mapping, _lines;
    osg::ref_ptr<ColorTable> _colors;
    double _low, _high;
    double _step = 0.0, _lineWidth = 40.0;
    osg::Vec4 _lineColor;
    osg::Vec2d _lineScale; ///< size of the raster that the lines were made for, metres
};

} // namespace osgGeoFX
