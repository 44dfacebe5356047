// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/MappingPool.h>

#include <osg/Vec4d>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

class Georeference;

/** A route over the terrain (Trapp and Döllner 2009, Section 5 and Figure 3.B): a line with an outline and round
    joins along the way points, and a mark at each way point. Everything away from the route loses brightness and
    saturation.

    @code
    osg::ref_ptr<osgGeoFX::RouteMapping> route = new osgGeoFX::RouteMapping;
    mappings->addRoute(route);                                             // a ProjectiveMappings
    route->setGeographicWayPoints(degrees, ellipsoid, nullptr, error);     // or setWayPoints(), metres
    @endcode

    One ProjectiveMappings at a time has a route, and keeps it. There each leg is a strip and each way point a disc. Both are
    mappings, which the route makes and changes itself. A dashed leg has a mapping for each dash. The
    context is a mapping of the scene's own colors. Its mask holds the distance to the route, metres, so its edges are
    smooth. Four more mappings extend the context to `contextReach`. The mappings use the orders from `order` to
    `order` + 5, and lie above other mappings of the same order; of two routes, the later one lies above.

    Places are in the mappings' frame, metres. OSG's files have the route with its way points, its look, its point layer and what is
    highlighted; its mappings are made anew. So a program that has changed these itself must do so again. A copy of a
    ProjectiveMappings has copies of its routes.

    The thread of the frame loop may change everything, between frames. Unchanged mappings are not uploaded again. Setters refuse
    values out of range: they return false, warn once and change nothing.
    @ingroup mapping */
class OSGGEOFX_EXPORT RouteMapping : public PropertyHolder, private PropertyListener
{
public:
    RouteMapping();
    RouteMapping(const RouteMapping& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, RouteMapping);

    /// Whether it is drawn. Default: true.
    bool setEnabled(bool enabled) { return assign("enabled", enabled ? 1.0 : 0.0); }
    bool getEnabled() const { return _enabled; }
    /// The order of its lowest mappings, −1000…995. Default: 0.
    bool setOrder(int order) { return assign("order", order); }
    int getOrder() const { return _order; }
    /// 0…1. Below 1 strips and discs show where they overlap. Default: 1.
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }

    /// The way points, metres, ±5e7, with straight legs between them. Neighbours at the same place (within 1 mm) count once. A single
    /// way point is a mark without a line.
    bool setWayPoints(const std::vector<osg::Vec2d>& places);
    std::vector<osg::Vec2d> getWayPoints() const;

    /** Way points in degrees of longitude (±360) and latitude. The legs are geodesics of WGS 84, the shortest ways, also over the
        antimeridian: within 2 m of them for legs of up to 10 000 km. Each leg has as many strips as it needs.

        The route must be in a ProjectiveMappings, whose frame and origin count at this moment; after another origin give the way
        points again. `ellipsoid`: of a globe. `reference`: of a projected terrain, which has no ellipsoid. False, with
        a sentence in `error`, if a place is none, lies outside the projection or on the other side of the globe from the
        frame's origin, if a leg crosses the edge of the projection, or if there are more than 20 000 way points; the route then stays as it is. */
    bool setGeographicWayPoints(const std::vector<osg::Vec2d>& degrees, const osg::EllipsoidModel* ellipsoid,
                                const Georeference* reference, std::string& error);
    /// As they were set; empty of a route whose way points are metres.
    const std::vector<osg::Vec2d>& getGeographicWayPoints() const { return _way.degrees; }

    /// The line of a route as it is drawn. For files.
    struct Way
    {
        std::vector<osg::Vec2d> line; ///< the ends of the strips, metres, no two neighbours at one place
        std::vector<unsigned int>
            wayPoints; ///< which of these are way points, rising, the first and the last among them
        std::vector<osg::Vec2d> degrees; ///< the way points again; or none
    };
    bool setWay(const Way& way);
    const Way& getWay() const { return _way; }

    /// The number of legs.
    std::size_t legs() const { return _way.wayPoints.empty() ? 0 : _way.wayPoints.size() - 1; }
    /// The length of the route on the reference plane, metres.
    double length() const;

    /// The look of a route. Colors are sRGB-coded, 0…1, and kept with eight bits. A translucent color shows where strips and discs overlap.
    struct Style
    {
        double halfWidth = 12.0; ///< half the width of the line, metres, 0…1e7; 0: no line
        double casing = 5.0;     ///< width of the outline on each side, metres, 0…1e7; 0: none
        osg::Vec4d color = {0.13, 0.45, 0.95, 1.0};
        osg::Vec4d casingColor = {1.0, 1.0, 1.0, 1.0};
        osg::Vec4d highlightColor = {1.0, 0.55, 0.0, 1.0};
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
    Style getStyle() const;

    /// A symbol in place of the round marks. It turns towards the eye. A null pointer brings the round marks back.
    void setPointLayer(DataLayer* layer);
    DataLayer* getPointLayer() { return _ownMark.get(); }
    const DataLayer* getPointLayer() const { return _ownMark.get(); }
    /// Shows one leg (counted from 0) in the highlight color and above the rest. An index that does not exist
    /// highlights nothing.
    void highlight(std::optional<std::size_t> leg);
    std::optional<std::size_t> highlighted() const;
    /// The same as a number: −1…1e6, −1 for none. Default: −1.
    bool setHighlightedLeg(int leg) { return assign("highlightedLeg", leg); }
    int getHighlightedLeg() const { return _highlighted; }
    /// The leg whose line or outline contains a place. Programs use it for clicks.
    std::optional<std::size_t> legAt(const osg::Vec2d& place) const;

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
    /// The mappings of one role; none while no ProjectiveMappings has the route.
    const MappingPool& mappings(Role role) const { return _pools[role]; }
    /// The number of its mappings, of all roles.
    std::size_t getNumMappings() const;

    const Properties& properties() const override;

protected:
    ~RouteMapping() override;

private:
    friend class ProjectiveMappings;
    struct Piece
    {
        std::size_t leg = 0;
        osg::Vec2d from, to;
        bool join = false; ///< goes on round the corner at `to`
    };
    /// What the context is made of.
    struct Context
    {
        std::vector<osg::Vec2d> line;
        bool on = false;
        double surroundings = 0.0, softness = 0.0, reach = 0.0;
        bool operator==(const Context& other) const;
    };
    MappingPool makePool(Role role, int above, ColorTransfer* transfer);
    /// Makes the mappings in an effect, with a number of its own there; none for null.
    void show(ProjectiveMappings* host, std::uint64_t number);
    /// The effect has forgotten the mappings itself.
    void forget();
    void propertyChanged(PropertyHolder& self) override;

    std::vector<Piece> pieces() const;
    MappingPool& pool(Role role) { return _pools[role]; }
    void make();
    void makeLine();
    void makePoints();
    void makeContext();
    void makeColors();
    void drawDistances(const osg::Vec2d& low, double texel);
    void addStrip(Role role, const osg::Vec2d& from, const osg::Vec2d& to, double halfWidth);
    void addDisc(Role role, const osg::Vec2d& center, double radius);

    bool _enabled = true;
    int _order = 0;
    double _opacity = 1.0;
    Way _way;
    std::vector<std::size_t> _legs; ///< of the strips
    Style _style;                   ///< but its colors
    int _color, _casingColor, _highlightColor;
    double _colorAlpha, _casingAlpha, _highlightAlpha;
    int _highlighted = -1;
    osg::ref_ptr<DataLayer> _disc, _mark, _ownMark, _distances;
    osg::ref_ptr<ColorTransfer> _contextTransfer, _beyondTransfer, _casingTransfer, _lineTransfer,
        _highlightTransfer;
    ProjectiveMappings* _host = nullptr; ///< which has this
    std::uint64_t _number = 0;
    std::optional<Context> _context;                          ///< as it is drawn
    std::optional<std::pair<osg::Vec4d, osg::Vec4d>> _marked; ///< the colors of the round mark
    std::array<MappingPool, 6> _pools;
};

} // namespace osgGeoFX
