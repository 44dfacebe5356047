// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/MappingPool.h>

#include <osg/Vec4>

#include <array>
#include <optional>

namespace osgGeoFX
{

/** A route over the terrain (Trapp and Döllner 2009, Section 5 and Figure 3.B): a line along the way points with an outline,
    round joins and a mark at each way point, while everything away from the route loses brightness and saturation.

    Each leg is a strip and each way point a disc, mappings of their own; a dashed leg has one for each dash. The context is
    a mapping of the scene's own colours, whose mask holds the distance to the route, metres; so its edges are smooth
    and cost nothing to move. Four more carry it on to `contextReach`. All orders from the one given to 5 above are used.

    Places are those of the mappings' frame, metres. Everything may be changed between frames, by the thread of the frame
    loop; mappings that stay the same are not uploaded anew. The destructor takes all away. Setters that get what makes no
    sense return false, warn once and change nothing. */
class OSGGEOFX_EXPORT RouteMapping : public osg::Referenced
{
public:
    explicit RouteMapping(ProjectiveMappings& mappings, int order = 0);

    /// Way points with no way between them count once. One alone is a mark without a line.
    bool setWayPoints(const std::vector<osg::Vec2d>& places);
    const std::vector<osg::Vec2d>& getWayPoints() const { return _points; }
    std::size_t legs() const { return _points.empty() ? 0 : _points.size() - 1; }
    /// Along the ground plane, metres.
    double length() const;

    /// Colours are sRGB-coded; what is see-through shows its joins.
    struct Style
    {
        double halfWidth = 12.0; ///< of the line, metres; 0: no line
        double casing = 5.0;     ///< width of the outline on each side, metres; 0: none
        osg::Vec4 color = {0.13f, 0.45f, 0.95f, 1.0f};
        osg::Vec4 casingColor = {1.0f, 1.0f, 1.0f, 1.0f};
        osg::Vec4 highlightColor = {1.0f, 0.55f, 0.0f, 1.0f};
        double dash = 0.0; ///< length of dashes and of the gaps between them, metres, over the casing;
        double gap = 0.0;  ///< 0: a line without gaps
        double pointRadius = 35.0; ///< of the marks, metres; 0: none
        double pointPixels = 0.0;  ///< the marks' size on the screen instead; `pointRadius` then is the most

        bool context = true;
        double surroundings = 250.0; ///< so far from the route everything is as it was, metres,
        double softness = 250.0;     ///< and over so many more it goes over to
        double brightness = 0.6;     ///< these, 0…4; see ColorTransfer
        double saturation = 0.15;
        double contextReach = 3e5; ///< metres around the route
    };
    bool setStyle(const Style& style);
    const Style& getStyle() const { return _style; }

    /// A symbol for the marks in the place of the round ones, which null brings back.
    void setPointLayer(DataLayer* layer);
    /// Shows one leg, from 0 on, in the other colour and above the rest; none for those that are not there.
    void highlight(std::optional<std::size_t> leg);
    std::optional<std::size_t> highlighted() const { return _highlighted; }
    /// The leg whose line, with its casing, is at a place; for clicks.
    std::optional<std::size_t> legAt(const osg::Vec2d& place) const;

    /// The mappings of each role; a program may change what the route does not set itself: fades, heights, channels.
    enum Role
    {
        CONTEXT_MASKED, ///< around the route
        CONTEXT_BEYOND,
        CASING,
        LINE,
        LINE_HIGHLIGHTED,
        POINTS
    };
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
    void addDisc(Role role, const osg::Vec2d& centre, double radius);

    std::vector<osg::Vec2d> _points;
    Style _style;
    std::optional<std::size_t> _highlighted;
    osg::ref_ptr<DataLayer> _disc, _mark, _ownMark, _distances;
    osg::ref_ptr<ColorTransfer> _contextTransfer, _beyondTransfer, _casingTransfer, _lineTransfer,
        _highlightTransfer;
    std::array<MappingPool, 6> _pools;
};

} // namespace osgGeoFX
