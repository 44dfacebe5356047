// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/ValueLegend.h>

namespace osgGeoFX
{

/** Shows numbers as colors on the terrain: noise, concentrations, heights, classes. Lines of equal value and a legend
    in the same colors are optional (Trapp and Döllner 2009, Section 5 and Figure 3.A).

    @code
    osg::ref_ptr<osgGeoFX::ValueMap> map = new osgGeoFX::ValueMap(mappings, noise, colors);
    map->mapping().setRectangle({0.0, 0.0}, 5000.0, 4000.0);
    map->setRange(40.0, 80.0);
    map->setLines(5.0, 30.0);
    hud->addChild(map->legend({"Noise", "dB(A)"}));
    @endcode

    A program sets place, opacity, fades and order on mapping(). The lines follow these settings. The thread of the
    frame loop changes a map, between frames. The destructor removes it. Setters refuse values that they cannot use:
    they return false, warn and change nothing.
    @ingroup mapping */
class OSGGEOFX_EXPORT ValueMap : public osg::Referenced, private PropertyListener
{
public:
    /// `values` is a layer of values or classes. The table may be shared and changed; refresh() then applies the
    /// change. Values below the range have the color of its lower end, values above it the color of the upper end.
    /// With a table of the mode EXACT they are transparent. The range at first is the table's.
    ValueMap(ProjectiveMappings& mappings, DataLayer* values, ColorTable* colors, int order = 0);

    ProjectiveMapping& mapping() { return *_mapping; }
    /// A null pointer is refused.
    bool setColors(ColorTable* colors);
    ColorTable& colors() { return *_colors; }
    /// The values at the two ends of the colors, in the layer's unit. `low` must be less than `high`.
    bool setRange(double low, double high);
    double getLow() const { return _low; }
    double getHigh() const { return _high; }
    /// Lines of equal value at the multiples of `step` within the range, in the layer's unit. 0 means no lines.
    /// `width` is in metres, up to 1e6. The lines are a mapping of their own at the map's place. Only a layer of
    /// values has lines. If there would be more than 1000 lines, none is drawn.
    bool setLines(double step, double width = 40.0, const osg::Vec4& color = {0.0f, 0.0f, 0.0f, 0.6f});
    /// A program calls this after it has changed the table or the layer's image.
    void refresh();

    /// The mapping of the lines, or null without lines.
    const ProjectiveMapping* lines() const { return _lines.get(); }
    /// A legend with the present colors of the map. Null if makeLegend() cannot make it.
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
