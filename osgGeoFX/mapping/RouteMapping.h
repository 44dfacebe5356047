// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/MappingPool.h>

#include <osg/Vec4>

#include <array>
#include <optional>
#include <string>

namespace osgGeoFX
{

/** Shows a route over the terrain (Trapp and Döllner 2009, Section 5 and Figure 3.B): a line with an outline and round
    joins along the way points, and a mark at each way point. Everything away from the route loses brightness and
    saturation.

    Each leg is a strip and each way point a disc. Both are mappings. A dashed leg has a mapping for each dash. The
    context is a mapping of the scene's own colors. Its mask holds the distance to the route, metres, so its edges are
    smooth. Four more mappings extend the context to `contextReach`. The mappings use the orders from `order` to
    `order` + 5.

    Places are in the mappings' frame, metres. The thread of the frame loop may change everything, between frames.
    Unchanged mappings are not uploaded again. The destructor removes all mappings. Setters refuse values out of range:
    they return false, warn once and change nothing.
    @ingroup mapping */
class OSGGEOFX_EXPORT RouteMapping : public osg::Referenced
{
public:
    explicit RouteMapping(ProjectiveMappings& mappings, int order = 0);

    /// The way points, metres, ±5e7. Neighbours at the same place (within 1 mm) count once. A single way point is a
    /// mark without a line.
    bool setWayPoints(const std::vector<osg::Vec2d>& places);
    const std::vector<osg::Vec2d>& getWayPoints() const { return _points; }
    /// The number of legs.
    std::size_t legs() const { return _points.empty() ? 0 : _points.size() - 1; }
    /// The length of the route on the reference plane, metres.
    double length() const;

    /// The look of a route. Colors are sRGB-coded, 0…1. A translucent color shows where strips and discs overlap.
    struct Style
    {
        double halfWidth = 12.0; ///< half the width of the line, metres, 0…1e7; 0: no line
        double casing = 5.0;     ///< width of the outline on each side, metres, 0…1e7; 0: none
        osg::Vec4 color = {0.13f, 0.45f, 0.95f, 1.0f};
        osg::Vec4 casingColor = {1.0f, 1.0f, 1.0f, 1.0f};
        osg::Vec4 highlightColor = {1.0f, 0.55f, 0.0f, 1.0f};
        double dash = 0.0;         ///< length of a dash, metres, 0…1e7; dashes lie on a continuous outline
        double gap = 0.0;          ///< length of a gap, metres, 0…1e7; dash or gap 0: no gaps
        double pointRadius = 35.0; ///< radius of the marks, metres, 0…1e7; 0: no marks
        double pointPixels = 0.0; ///< 0…1e4: size of marks in pixels, limited by `pointRadius`; 0: in metres

        bool context = true;         ///< whether the surroundings lose brightness and saturation
        double surroundings = 250.0; ///< up to this distance from the route nothing changes, metres, 0…1e7
        double softness = 250.0;     ///< width of the transition beyond `surroundings`, metres, 0…1e7
        double brightness = 0.6;     ///< brightness beyond the transition, 0…4; see ColorTransfer
        double saturation = 0.15;    ///< saturation beyond the transition, 0…4
        double contextReach = 3e5;   ///< how far the context reaches around the route, metres, 0…1e7
    };
    bool setStyle(const Style& style);
    const Style& getStyle() const { return _style; }

    /// A symbol in place of the round marks. It turns towards the eye. A null pointer brings the round marks back.
    void setPointLayer(DataLayer* layer);
    /// Shows one leg (counted from 0) in the highlight color and above the rest. An index that does not exist
    /// highlights nothing.
    void highlight(std::optional<std::size_t> leg);
    std::optional<std::size_t> highlighted() const { return _highlighted; }
    /// The leg whose line or outline contains a place. Programs use it for clicks.
    std::optional<std::size_t> legAt(const osg::Vec2d& place) const;

    /// Leaves the route's mappings in the ProjectiveMappings for good, named after the route; so they are drawn, and written to files, as
    /// mappings. This route has no way points afterwards.
    void leave(const std::string& name);

    /// The role of a mapping. A program may change properties that the route does not set itself: fades, heights,
    /// channels.
    enum Role
    {
        CONTEXT_MASKED, ///< the context around the route
        CONTEXT_BEYOND, ///< the four mappings beyond it, out to `contextReach`
        CASING,
        LINE,
        LINE_HIGHLIGHTED,
        POINTS
    };
    /// The mappings of one role.
    const MappingPool& mappings(Role role) const { return _pools[role]; }

protected:
    ~RouteMapping() override;

private:
    struct Piece
    {
        std::size_t leg = 0;
        osg::Vec2d from, to;
        bool join = false; ///< goes on round the corner at `to`
    };
    std::vector<Piece> pieces() const;
    MappingPool& pool(Role role) { return _pools[role]; }
    void make();
    void makeContext();
    void makeColors();
    void drawDistances(const osg::Vec2d& low, double texel);
    void addStrip(Role role, const osg::Vec2d& from, const osg::Vec2d& to, double halfWidth);
    void addDisc(Role role, const osg::Vec2d& center, double radius);

    std::vector<osg::Vec2d> _points;
    Style _style;
    std::optional<std::size_t> _highlighted;
    osg::ref_ptr<DataLayer> _disc, _mark, _ownMark, _distances;
    osg::ref_ptr<ColorTransfer> _contextTransfer, _beyondTransfer, _casingTransfer, _lineTransfer,
        _highlightTransfer;
    std::array<MappingPool, 6> _pools;
};

} // namespace osgGeoFX
