// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/deformation/PerspectiveBend.h>

#include <osgGeoFX/effect/detail/EyeVector.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// 0…1 where a value goes from `from` to `to`, without a kink.
double eased(double from, double to, double value)
{
    const double share = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

/// Within this share of the curve's radius nothing folds.
constexpr double foldMargin = 0.9;

class BendSnapshot : public DeformationSnapshot, public TessellatedSnapshot
{
public:
    struct Look
    {
        double transitionDetail, contextDetail;
        osg::Vec4d context; ///< saturation, brightness, whether there is a map, blocks
        osg::Vec4d focus;   ///< saturation, brightness, whether the map is there
        bool foldPossible;  ///< the heights of what stands in the zone are not known for sure
        double allowed;     ///< pixels that divided triangles may be off; 0 if none is divided
    };

    /// `globe`: the radius of the globe, metres; 0 for a plane.
    BendSnapshot(const glsl::geofx_BendView& view, const Look& look, double globe) : _view(view), _look(look)
    {
        const glsl::geofx_Bend& bend = view.bend;
        const double d = std::max(bend.size, 1e-9);
        const double slope = std::abs(bend.slope);
        switch (bend.curve)
        {
        case glsl::GEOFX_CURVE_BEZIER:
            _curvature = 2.0 * std::abs(bend.bisector.y) / d;
            _turnRate = 2.0 * slope / d;
            _turnChange = 2.6 * slope * slope / (d * d);
            break;
        case glsl::GEOFX_CURVE_ARC_LENGTH:
            _turnRate = bend.arc * slope / d;
            _curvature = _turnRate;
            _turnChange = 4.2 * slope * slope / (d * d);
            break;
        default:
            _turnRate = std::abs(bend.angle) / d;
            _curvature = _turnRate;
        }
        fillTable();
        const glm::dvec2 eye = profile({});
        // Where T is rolled up, its normals spread below it, so the globe stays one body. For an eye that is near the zone, as seen
        // from the middle of the globe, lines of sight to what is deeper than that run through this body.
        constexpr double near = 0.05, deep = 1.25, mostAngle = 2.1;
        const double away = glm::length(eye) + bend.size;
        if (bend.angle > 0.0 && bend.angle < mostAngle && away < near * globe) _hidden = deep * globe;
    }

    osg::Vec3d roughly(const osg::Vec3d& position) const override
    {
        return roughly(position, profile(position));
    }
    double roughness(const Ball& ball) const override
    {
        const glm::dvec2 at = profile(ball.center);
        const bool outside = at.x + ball.radius <= 0.0 || at.x - ball.radius >= _view.bend.size;
        return outside ? 0.0 : roughness(std::abs(at.y) + ball.radius);
    }
    Ball bound(const Ball& ball) const override
    {
        const glm::dvec2 at = profile(ball.center);
        if (at.x + ball.radius <= 0.0) return ball;
        Ball result = {roughly(ball.center, at), ball.radius};
        if (at.x - ball.radius < _view.bend.size)
        {
            const double height = std::abs(at.y) + ball.radius;
            result.radius = ball.radius * (1.0 + height * _turnRate) + roughness(height);
        }
        return result;
    }
    osg::Vec3d deform(const osg::Vec3d& position) const override
    {
        return toOsg(glsl::geofx_bendViewDeform(_view, toGlm(position)));
    }
    osg::Vec3d undeform(const osg::Vec3d& position) const override
    {
        return toOsg(glsl::geofx_bendViewUndeform(_view, toGlm(position)));
    }
    osg::Vec3d deformNormal(const osg::Vec3d& position, const osg::Vec3d& normal) const override
    {
        return toOsg(glsl::geofx_bendViewNormal(_view, toGlm(position), toGlm(normal)));
    }
    osg::Matrixd turn(const osg::Vec3d& position) const override
    {
        const glsl::geofx_BendFrame frame =
            glsl::geofx_bendFrame(_view.bend, glsl::geofx_bendViewProfile(_view, toGlm(position)).x);
        // From D towards n.
        const osg::Vec3d axis = toOsg(_view.forward) ^ toOsg(_view.normal);
        return osg::Matrixd::rotate(std::atan2(frame.tangent.y, frame.tangent.x), axis);
    }
    double style(const osg::Vec3d& position) const override
    {
        return glsl::geofx_bendViewStyle(_view, toGlm(position));
    }

    Reach reach(const Ball& ball) const override
    {
        const double s = profile(ball.center).x;
        if (s + ball.radius <= 0.0) return Reach::Identity;
        return s - ball.radius >= _view.bend.size ? Reach::Affine : Reach::Curved;
    }
    double lipschitz(const Ball& ball) const override
    {
        const glm::dvec2 at = profile(ball.center);
        if (at.x + ball.radius <= 0.0 || at.x - ball.radius >= _view.bend.size) return 1.0;
        // Along h lengths stay; along s they grow by speed − h·turnRate, and the speed is at most 1.
        return 1.0 + (std::abs(at.y) + ball.radius) * _turnRate;
    }
    void boundBox(const EyeBox& box, Hull& hull, double fineness) const override
    {
        const Extent extent = extentOf(box);
        hull.margin = 0.0;
        box.corners(hull.points);
        if (extent.middle.x + extent.along <= 0.0) return;
        const bool inZone = extent.middle.x - extent.along < _view.bend.size;
        if (inZone) addSlices(box, extent, fineness, hull);
        for (std::size_t i = 0; i < boxCorners; ++i)
            hull.points[i] = roughly(hull.points[i]);
    }
    double longestEdge(const Ball& ball, double tolerance) const override
    {
        if (reach(ball) != Reach::Curved) return HUGE_VAL;
        const Ball bent = bound(ball);
        const double gap = std::max(0.0, bent.center.length() - bent.radius);
        const double longest =
            std::sqrt(8.0 * tolerance * gap / (_look.transitionDetail * std::max(_curvature, 1e-30)));
        // The GPU divides what is too long, but not without end.
        return dividesTriangles() ? mostParts * longest : longest;
    }
    double detail(const Ball& ball) const override
    {
        const double s = profile(ball.center).x;
        if (s + ball.radius <= 0.0) return 1.0;
        return s - ball.radius >= _view.bend.size ? _look.contextDetail : _look.transitionDetail;
    }
    bool hides(const Ball& ball, const osg::Vec2d&) const override
    {
        const glm::dvec2 at = profile(ball.center);
        const double besideZone = 0.1 * _hidden;
        return _hidden > 0.0 && at.y + ball.radius < -_hidden && at.x + ball.radius > -besideZone &&
               at.x - ball.radius < _view.bend.size + besideZone;
    }
    bool looksAtBoxes() const override { return _look.foldPossible || _hidden > 0.0; }
    std::string complaint(const EyeBox& box) const override
    {
        if (!_look.foldPossible || reach(box.ball()) != Reach::Curved) return {};
        // The ball reaches farther than the box does.
        const Extent extent = extentOf(box);
        if (extent.middle.x + extent.along <= 0.0 || extent.middle.x - extent.along >= _view.bend.size)
            return {};
        const double inner = extent.middle.y * (_view.bend.angle > 0.0 ? 1.0 : -1.0) + extent.up;
        if (inner * std::abs(glsl::geofx_bendCurvature(_view.bend)) < 1.0) return {};
        const std::string side = _view.bend.angle > 0.0 ? "above" : "below";
        // `tallest` goes no higher. Skies have such bounds, and some are infinite.
        if (!(inner <= 1e6))
            return "something in the transition zone has a bound that reaches more than 1000 km " + side +
                   " the reference plane, so the bend folds it over; if it is no ground, leave it out with "
                   "setDefine(\"GEOFX_DEFORMATION\", OFF) in its state set.";
        return "something in the transition zone reaches " + std::to_string(std::lround(inner)) + " m " +
               side +
               " the reference plane, beyond the radius of the bend, and folds over; set `tallest` to that "
               "or more.";
    }
    Uniforms uniforms() const override
    {
        const glsl::geofx_Bend& bend = _view.bend;
        Uniforms result = {{"plane", {toOsg(_view.normal), _view.height}},
                           {"forward", {toOsg(_view.forward), _view.start}},
                           {"bend", {bend.size, bend.angle, bend.slope, bend.arc}},
                           {"angle", {bend.direction.x, bend.direction.y, bend.bisector.x, bend.bisector.y}},
                           {"end", {bend.end.x, bend.end.y, 0.0, 0.0}},
                           {"look", _look.context},
                           {"focusLook", _look.focus}};
        if (_look.allowed > 0.0)
        {
            const glm::dvec4 rates = this->rates();
            result.insert(result.end(), {{"rates", {rates.x, rates.y, rates.z, rates.w}},
                                         {"allowed", {1.0 / _look.allowed, 0.0, 0.0, 0.0}}});
        }
        return result;
    }
    bool dividesTriangles() const override { return _look.allowed > 0.0; }
    bool divides(const EyeBox& box) const override
    {
        if (!dividesTriangles()) return false;
        const Extent extent = extentOf(box);
        // Of floats, whose places in eye space are rounded, and the numbers of the bend, too.
        constexpr double rounding = 1e-5;
        const double room =
            rounding * (box.center.length() + extent.along + std::abs(_view.start) + _view.bend.size);
        return extent.middle.x + extent.along > -room &&
               extent.middle.x - extent.along < _view.bend.size + room;
    }
    osg::Vec2d edgeSag(const osg::Vec3d& from, const osg::Vec3d& to) const override
    {
        const glm::dvec2 sag = glsl::geofx_bendViewSag(_view, rates(), toGlm(from), toGlm(to));
        return {sag.x, sag.y};
    }

private:
    glm::dvec2 profile(const osg::Vec3d& position) const
    {
        return glsl::geofx_bendViewProfile(_view, toGlm(position));
    }
    osg::Vec3d roughly(const osg::Vec3d& position, const glm::dvec2& point) const
    {
        const glsl::geofx_Bend& bend = _view.bend;
        if (!(point.x > 0.0)) return position;
        glm::dvec2 to;
        if (point.x >= bend.size)
        {
            const glm::dvec2 past(point.x - bend.size, point.y);
            to =
                bend.end + past.x * bend.direction + past.y * glm::dvec2(-bend.direction.y, bend.direction.x);
        }
        else
        {
            const double cell = point.x * static_cast<double>(tableCells) / bend.size;
            const auto below = std::min(static_cast<std::size_t>(cell), tableCells - 1);
            const double share = cell - static_cast<double>(below);
            const TableEntry& a = _table[below];
            const TableEntry& b = _table[below + 1];
            to = a.foot + share * (b.foot - a.foot) + point.y * (a.normal + share * (b.normal - a.normal));
        }
        return moved(position, point, to);
    }
    /// `height` from T at most.
    double roughness(double height) const
    {
        const double cell = _view.bend.size / static_cast<double>(tableCells);
        return (_curvature + height * (_turnChange + _turnRate * _turnRate)) * cell * cell / 8.0;
    }

    /// Of a box, in the profile.
    struct Extent
    {
        glm::dvec2 middle;
        std::array<glm::dvec2, 3> half; ///< of its axes
        double along = 0.0;             ///< from the middle, at most
        double up = 0.0;
    };
    Extent extentOf(const EyeBox& box) const
    {
        Extent extent;
        extent.middle = profile(box.center);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const osg::Vec3d& half = box.half[axis];
            extent.half[axis] = {half * toOsg(_view.forward), half * toOsg(_view.normal)};
            extent.along += std::abs(extent.half[axis].x);
            extent.up += std::abs(extent.half[axis].y);
        }
        return extent;
    }
    /// How far what becomes of a box is from the hull of its corners and of its sections by planes `width` apart across
    /// the zone. Before the zone, behind it, and in such a plane the bend is affine. Anything else in the box lies on a line
    /// along one of its axes, between two planes, or a plane and a face; what is on the face, between others; what is
    /// on an edge at last, between points of the hull.
    double sliceSag(const Extent& extent, double width) const
    {
        const double change =
            _curvature + (std::abs(extent.middle.y) + extent.up) * (_turnChange + _turnRate * _turnRate);
        double sag = 0.0;
        for (const glm::dvec2& half : extent.half)
        {
            const double axis = 2.0 * std::abs(half.x);
            if (axis == 0.0) continue;
            const double along = std::min(width, axis);
            const double up = 2.0 * std::abs(half.y) * along / axis;
            // P = C(s) + h·N(s)
            sag += along * (change * along / 8.0 + _turnRate * up / 4.0);
        }
        return sag;
    }
    /// What becomes of a box's sections by as many planes as `fineness` asks for; and the margin.
    void addSlices(const EyeBox& box, const Extent& extent, double fineness, Hull& hull) const
    {
        const double size = _view.bend.size;
        const double allowed = fineness * box.ball().radius;
        std::size_t slices = 1;
        while (slices < tableCells && sliceSag(extent, size / static_cast<double>(slices)) > allowed)
            slices *= 2;
        const double width = size / static_cast<double>(slices);
        hull.margin = sliceSag(extent, width) + roughness(std::abs(extent.middle.y) + extent.up);
        for (std::size_t slice = 0; slice <= slices; ++slice)
        {
            const double s = width * static_cast<double>(slice);
            if (std::abs(s - extent.middle.x) > extent.along) continue;
            // Corners a and b differ in one of the bits that their numbers have for the axes.
            for (std::size_t a = 0; a < boxCorners; ++a)
            {
                for (std::size_t axis = 0; axis < 3; ++axis)
                {
                    if (a & (4u >> axis)) continue;
                    const glm::dvec2 from = cornerOf(extent, a);
                    const double share = (s - from.x) / (2.0 * extent.half[axis].x);
                    if (!(share >= 0.0 && share <= 1.0)) continue;
                    const osg::Vec3d at = hull.points[a] + box.half[axis] * (2.0 * share);
                    const double h = from.y + extent.half[axis].y * 2.0 * share;
                    const TableEntry& frame = _table[slice * (tableCells / slices)];
                    hull.points.push_back(moved(at, {s, h}, frame.foot + h * frame.normal));
                }
            }
        }
    }
    static glm::dvec2 cornerOf(const Extent& extent, std::size_t corner)
    {
        glm::dvec2 at = extent.middle;
        for (std::size_t axis = 0; axis < 3; ++axis)
            at += (corner & (4u >> axis) ? 1.0 : -1.0) * extent.half[axis];
        return at;
    }
    osg::Vec3d moved(const osg::Vec3d& position, const glm::dvec2& from, const glm::dvec2& to) const
    {
        const glm::dvec2 offset = to - from;
        return position + toOsg(_view.forward * offset.x + _view.normal * offset.y);
    }

    /// As geofx_bendViewSag() has them.
    glm::dvec4 rates() const
    {
        const glsl::geofx_Bend& bend = _view.bend;
        const double jump =
            bend.curve == glsl::GEOFX_CURVE_ARC_LENGTH ? std::abs(1.0 - bend.arc * bend.bisector.x) : 0.0;
        return {_curvature, _turnChange + _turnRate * _turnRate, _turnRate, jump};
    }

    static constexpr std::size_t boxCorners = 8;
    static constexpr std::size_t tableCells = 32;
    struct TableEntry
    {
        glm::dvec2 foot;
        glm::dvec2 normal;
    };
    /// The zone's frames at even distances: bounds ask for them often, and Newton's method takes its time.
    void fillTable()
    {
        for (std::size_t i = 0; i <= tableCells; ++i)
        {
            const double s = _view.bend.size * static_cast<double>(i) / static_cast<double>(tableCells);
            const glsl::geofx_BendFrame frame = glsl::geofx_bendFrame(_view.bend, s);
            _table[i] = {frame.foot, {-frame.tangent.y, frame.tangent.x}};
        }
        // A hinge turns at once.
        _table.back() = {_view.bend.end, {-_view.bend.direction.y, _view.bend.direction.x}};
    }

    glsl::geofx_BendView _view;
    Look _look;
    std::array<TableEntry, tableCells + 1> _table;
    double _curvature = 0.0;  ///< of |C''|, at most
    double _turnRate = 0.0;   ///< of the frame, at most
    double _turnChange = 0.0; ///< of the turn rate's derivative, at most
    double _hidden =
        0.0; ///< from so far below T on the globe hides what is around the zone, metres; 0: nothing
};

} // namespace

PerspectiveBend::PerspectiveBend(const PerspectiveBend& other, const osg::CopyOp& copy)
    : Deformation(other, copy), Tessellator(other), _curve(other._curve), _planeHeight(other._planeHeight),
      _planeReference(other._planeReference), _tallest(other._tallest),
      _transitionDetail(other._transitionDetail), _contextDetail(other._contextDetail),
      _tessellation(other._tessellation), _tessellationPixels(other._tessellationPixels),
      _contextSaturation(other._contextSaturation), _contextBrightness(other._contextBrightness),
      _contextBlocks(other._contextBlocks), _focusSaturation(other._focusSaturation),
      _focusBrightness(other._focusBrightness), _mapUnit(other._mapUnit), _coverMap(other._coverMap),
      _mapPlace(other._mapPlace), _zoneLines(other._zoneLines)
{
}

PerspectiveBend::~PerspectiveBend() = default;

Properties PerspectiveBend::bendProperties()
{
    using Self = PerspectiveBend;
    return {
        enabledProperty(),
        Property::choice("curve", "the curve of the transition zone",
                         {{"bezier", ""},
                          {"arcLength", "the same, but equal ground takes equal length"},
                          {"circularArc", "which keeps lengths"}})
            .of<&Self::_curve>(),
        Property::number("planeHeight", "the height of the reference plane above what planeReference says",
                         -12000.0, 1e7, "m")
            .of<&Self::_planeHeight>(),
        Property::choice("planeReference", "what planeHeight counts from",
                         {{"ground", "the database's zero height"}, {"eye", "the camera"}})
            .of<&Self::_planeReference>(),
        Property::number(
            "tallest",
            "how far the tallest thing in the transition zone rises above the reference plane; -1 "
            "takes it from the database",
            -1.0, 1e6, "m")
            .of<&Self::_tallest>(),
        Property::number("transitionDetail",
                         "how many times finer the level of detail is in the transition zone", 1.0, 16.0)
            .of<&Self::_transitionDetail>(),
        Property::number("contextDetail", "how many times finer the level of detail is in the context", 0.1,
                         16.0)
            .of<&Self::_contextDetail>(),
        Property::flag(
            "tessellation",
            "whether the GPU divides the triangles of the transition zone, with OpenGL 4; the terrain is "
            "not refined there for the bend's sake then")
            .of<&Self::_tessellation>(),
        Property::number("tessellationPixels",
                         "how far a triangle that the GPU has divided may be from the curve, pixels", 0.1,
                         16.0)
            .of<&Self::_tessellationPixels>(),
        Property::number("contextSaturation", "the saturation of the context; 0 is grey", 0.0, 2.0)
            .of<&Self::_contextSaturation>(),
        Property::number("contextBrightness", "the brightness of the context; 0 is black", 0.0, 2.0)
            .of<&Self::_contextBrightness>(),
        Property::number("contextBlocks",
                         "how far buildings lose windows and colors in the context, and become blocks", 0.0,
                         1.0)
            .of<&Self::_contextBlocks>(),
        Property::number("focusSaturation", "the saturation of the focus; 0 is grey", 0.0, 2.0)
            .of<&Self::_focusSaturation>(),
        Property::number("focusBrightness", "the brightness of the focus; 0 is black", 0.0, 2.0)
            .of<&Self::_focusBrightness>(),
        Property::integer("mapUnit", "the texture unit of a map that mapPlace shows; -1 is none", -1, 3)
            .of<&Self::_mapUnit>(),
        Property::flag("coverMap",
                       "whether the map is made of what tiles say of the ground: water, woods and towns")
            .of<&Self::_coverMap>(),
        Property::choice("mapPlace", "where the map replaces the ground's own colors",
                         {{"context", "a map behind a photo"}, {"focus", "a photo behind a map"}})
            .of<&Self::_mapPlace>(),
        Property::flag("zoneLines",
                       "whether lines on the ground show where the transition zone begins and ends")
            .of<&Self::_zoneLines>(),
    };
}

double PerspectiveBend::planeHeight(const ViewGeometry& view) const
{
    return _planeReference == EYE ? -_planeHeight : view.eyeHeight - _planeHeight;
}

double PerspectiveBend::planeLevel(const ViewGeometry& view) const
{
    return view.eyeHeight - planeHeight(view);
}

double PerspectiveBend::mostCurvature(const ViewGeometry& view, double angle, double reach) const
{
    double extent = 0.0;
    if (_tallest >= 0.0)
    {
        extent = _tallest;
    }
    else if (angle > 0.0)
    {
        extent = view.ground.maxHeight - planeLevel(view);
    }
    else
    {
        extent = planeLevel(view) - view.ground.minHeight;
    }
    if (angle < 0.0 && view.ground.ellipsoid)
    {
        // The globe falls away below T.
        extent += reach * reach / (2.0 * view.ground.ellipsoid->getRadiusPolar());
    }
    return foldMargin / std::max(extent, 1.0);
}

osg::Vec3d PerspectiveBend::heading(const ViewGeometry& view)
{
    const osg::Vec3d right = osg::Vec3d(1.0, 0.0, 0.0) - view.up * view.up.x();
    osg::Vec3d heading = view.up ^ right;
    // Where the camera's right vector is vertical, there is no direction; the bend is gone before.
    const double length = heading.normalize();
    // Square to the view, so that the bend's horizon is turned by the camera's roll, as the natural one is. There is no such
    // direction straight down and for a camera on its side; towards them it is the one square to the camera's right.
    osg::Vec3d side = view.up ^ osg::Vec3d(0.0, 0.0, 1.0);
    const double level = side.normalize();
    const double upright = heading * (side ^ view.up);
    heading -= side * (eased(0.03, 0.34, level) * eased(0.2, 0.5, std::abs(upright)) * (heading * side));
    heading.normalize();
    return heading * eased(0.05, 0.25, length);
}

osg::ref_ptr<const DeformationSnapshot> PerspectiveBend::snapshot(const ViewGeometry& view) const
{
    const std::optional<BendPlacement> place = placement(view);
    if (!place) return nullptr;
    osg::Vec3d forward = heading(view);
    const double share = forward.normalize();
    // What little is left of a bend at its end goes smoothly, too, and then there is nothing to draw.
    const double rest = std::clamp(std::abs(place->angle) * share / 1e-5 - 1.0, 0.0, 1.0);
    const double angle = place->angle * share * (rest * rest * (3.0 - 2.0 * rest));
    glsl::geofx_BendView bend;
    bend.normal = toGlm(view.up);
    bend.forward = toGlm(forward);
    bend.height = place->planeHeight;
    bend.start = place->start;
    bend.bend = glsl::geofx_makeBend(_curve, place->size, angle);
    // Not a number, or beyond what floats can work with: no camera over a terrain is like this.
    const double sum = std::abs(place->planeHeight) + std::abs(place->start) + place->size + std::abs(angle) +
                       std::abs(forward * view.up);
    if (!(sum < 1e15) || angle == 0.0) return nullptr;
    // A database that tells its heights needs no watching, unless someone says that they do not matter, and they do; and what
    // hangs below T in it are skirts.
    const double highest = view.ground.maxHeight - (view.eyeHeight - place->planeHeight);
    const bool matters = !(highest * std::abs(glsl::geofx_bendCurvature(bend.bend)) < foldMargin);
    const bool foldPossible = !view.ground.heightsKnown || (_tallest >= 0.0 && angle > 0.0 && matters);
    const BendSnapshot::Look look = {
        _transitionDetail,
        _contextDetail,
        {_contextSaturation, _contextBrightness, _mapUnit < 0 && !_coverMap ? 0.0 : 1.0, _contextBlocks},
        {_focusSaturation, _focusBrightness, _mapPlace == FOCUS ? 1.0 : 0.0, 0.0},
        foldPossible,
        tessellates() ? _tessellationPixels : 0.0};
    return new BendSnapshot(bend, look,
                            view.ground.ellipsoid ? view.ground.ellipsoid->getRadiusEquator() : 0.0);
}

std::string PerspectiveBend::fragmentFile() const
{
    const bool plain = _contextSaturation == 1.0 && _contextBrightness == 1.0 && _contextBlocks == 0.0 &&
                       _focusSaturation == 1.0 && _focusBrightness == 1.0 && _mapUnit < 0 && !_coverMap &&
                       !_zoneLines;
    return plain ? std::string() : "stages/bendstyle.glsl";
}

std::string PerspectiveBend::constants() const
{
    return "const int SLOT_curve = " + std::to_string(_curve) + ";\n" +
           (_coverMap ? "#define SLOT_COVER_MAP\n" : "") + (_zoneLines ? "#define SLOT_ZONE_LINES\n" : "");
}

std::vector<Varying> PerspectiveBend::varyings() const
{
    std::vector<Varying> result;
    if (_coverMap) result.push_back({"vec2", "mapPlace"});
    if (_zoneLines) result.push_back({"float", "ahead"});
    return result;
}

} // namespace osgGeoFX
