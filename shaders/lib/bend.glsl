// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The bend: how the reference plane curves from the focus into the context, after Section 4 of Lorenz, Trapp,
// Doellner, Jobst: "Interactive Multi-Perspective Views of Virtual 3D Landscape and City Models" (2008).
//
// All of it happens in the profile, the plane across the parallel lines b, r, e of the paper. A point is (s,
// h): s metres past the line b in the direction of the bend, h metres above the undeformed plane. The
// transition zone is 0 < s < d. Before it nothing moves. Behind it everything moves rigidly, turned by beta:
// about r = (d/2, 0) for the curves BEZIER and ARC_LENGTH; tangentially to the arc's end for CIRCULAR_ARC.
//
// Within the zone a point moves with the curve's frame: (s, h) goes to C + h*normal. BEZIER takes the curve's
// parameter t = s/d, as the paper does, so that ground is compressed towards the middle of the zone.
// ARC_LENGTH, on the same curve, compresses it evenly (the paper's future work). CIRCULAR_ARC, of radius
// d/beta, does not compress it. The tangent is continuous everywhere; the speed |dC/ds| too for BEZIER and
// CIRCULAR_ARC, whereas ARC_LENGTH has one speed below 1 in the zone (0.950 for 45 degrees).
//
// The parabola. With u = 2t - 1 in -1..1 and the axes turned by beta/2, the Bezier curve is, from its vertex
// at u = 0, X = d/2 * cos(beta/2) * u, Y = d/4 * sin(beta/2) * u^2. Its slope there is u * tan(beta/2), which
// needs no care where beta is 0; most of what follows is written in u.
#ifndef __cplusplus
#include "lib/types.glsl"
#include "lib/series.glsl"
#endif

const int GEOFX_CURVE_BEZIER = 0;
const int GEOFX_CURVE_ARC_LENGTH = 1;
const int GEOFX_CURVE_CIRCULAR_ARC = 2;

// A bend and the values that follow from it. geofx_makeBend makes it, best once per camera and in double.
struct geofx_Bend
{
    int curve;         // GEOFX_CURVE_...
    Length size;       // d, the width of the transition zone
    Angle angle;       // beta, positive upwards
    Vector2 direction; // (cos, sin) of beta
    Vector2 bisector;  // (cos, sin) of beta/2
    Number slope;      // tan(beta/2)
    Number arc;        // length of the Bezier curve / (d * cos(beta/2))
    Profile end;       // where the line e goes
};

// What happens to the vertical line at a ground point s.
struct geofx_BendFrame
{
    Profile foot;      // where (s, 0) goes
    Vector2 tangent;   // direction of growing s there, a unit vector; the frame is turned from (1, 0) to it
    Number speed;      // |dC/ds|: metres of curve for each metre of ground
    PerMetre turnRate; // turn of the frame for each metre of ground, positive upwards
};

// The length of the parabola from its vertex to u, over d/2 * cos(beta/2). Odd in u, |u| <= 1.
GEOFX_INLINE Number geofx_bendArc(Number slope, Number u)
{
    Number x = slope * u;
    return u * (sqrt(1 + x * x) + geofx_asinhc(x)) / 2;
}

// curve: GEOFX_CURVE_...; size: d >= 0, where 0 makes a hinge; angle: beta, clamped to -pi/2..pi/2.
GEOFX_INLINE geofx_Bend geofx_makeBend(int curve, Length size, Angle angle)
{
    geofx_Bend bend;
    bend.curve = curve;
    bend.size = size;
    bend.angle = clamp(angle, Number(-1.57079632679489662), Number(1.57079632679489662));
    Angle halfAngle = bend.angle / 2;
    Number sine = halfAngle * geofx_sinc(halfAngle);
    bend.bisector = Vector2(sqrt(1 - sine * sine), sine);
    bend.direction = Vector2(1 - 2 * sine * sine, 2 * sine * bend.bisector.x);
    bend.slope = bend.bisector.y / bend.bisector.x;
    bend.arc = 2 * geofx_bendArc(bend.slope, Number(1));
    if (curve == GEOFX_CURVE_CIRCULAR_ARC)
    {
        bend.end = size * geofx_sinc(halfAngle) * bend.bisector;
    }
    else
    {
        bend.end = size * bend.bisector.x * bend.bisector;
    }
    return bend;
}

// The largest curvature of the bend, with beta's sign. On the curve's inner side heights must keep h * curvature < 1.
// Beyond, the curve folds, and the inverse ends.
GEOFX_INLINE PerMetre geofx_bendCurvature(geofx_Bend bend)
{
    Length size = max(bend.size, Number(1e-30));
    if (bend.curve == GEOFX_CURVE_CIRCULAR_ARC)
    {
        return bend.angle / size;
    }
    return 2 * bend.slope / (bend.bisector.x * size);
}

// The parabola's u after the share 0..1 of its length. The start is the odd polynomial of fifth degree with the right
// slopes at the vertex and at the ends, and the right value at the ends. It is off by 3e-6 for |beta| = 30 degrees,
// and by 3e-3 for 90. Newton's method on geofx_bendArc follows, which turns an error e into less than 0.36 * e^2. One
// step leaves 1e-7 for 75 degrees and 3e-6 for 90, which is enough for floats. Three steps leave less than 1e-20,
// which is enough for doubles.
GEOFX_INLINE Number geofx_bendArcInverse(geofx_Bend bend, Number share)
{
    Number v = 2 * share - 1;
    Number atVertex = bend.arc / 2;
    Number fifth = (atVertex * bend.bisector.x + 2 * atVertex - 3) / 2;
    Number u = v * (atVertex + v * v * (1 - atVertex - fifth + v * v * fifth));
    for (int i = 0; i < GEOFX_NEWTON_STEPS; ++i)
    {
        Number x = bend.slope * u;
        u -= (geofx_bendArc(bend.slope, u) - v * atVertex) / sqrt(1 + x * x);
    }
    return u;
}

// The frame within the zone, 0 < s < d, on the arc of a circle.
GEOFX_INLINE geofx_BendFrame geofx_bendFrameOnArc(geofx_Bend bend, Length s)
{
    geofx_BendFrame frame;
    Angle halfTurn = bend.angle * (s / bend.size) / 2;
    Number sinc = geofx_sinc(halfTurn);
    Number sine = halfTurn * sinc;
    Number cosine = sqrt(1 - sine * sine);
    frame.foot = s * sinc * Vector2(cosine, sine);
    frame.tangent = Vector2(1 - 2 * sine * sine, 2 * sine * cosine);
    frame.speed = Number(1);
    frame.turnRate = bend.angle / bend.size;
    return frame;
}

// The frame within the zone, 0 < s < d, on the parabola.
GEOFX_INLINE geofx_BendFrame geofx_bendFrameOnParabola(geofx_Bend bend, Length s)
{
    geofx_BendFrame frame;
    Number share = s / bend.size;
    bool even = bend.curve == GEOFX_CURVE_ARC_LENGTH;
    Number u = even ? geofx_bendArcInverse(bend, share) : 2 * share - 1;
    Number t = even ? (1 + u) / 2 : share;
    Number x = bend.slope * u;
    Number secant = sqrt(1 + x * x);
    // du/d(s/d): 2 for the paper's parameter. For equal lengths of curve it is a constant over the secant.
    Number rate = even ? bend.arc / secant : Number(2);
    frame.foot = bend.size * t * Vector2(1 - t * bend.bisector.y * bend.bisector.y, t * bend.direction.y / 2);
    frame.tangent = (bend.bisector + x * Vector2(-bend.bisector.y, bend.bisector.x)) / secant;
    frame.speed = rate * bend.bisector.x * secant / 2;
    frame.turnRate = rate * bend.slope / (bend.size * secant * secant);
    return frame;
}

// The frame at any s.
GEOFX_INLINE geofx_BendFrame geofx_bendFrame(geofx_Bend bend, Length s)
{
    if (s > 0 && s < bend.size)
    {
        if (bend.curve == GEOFX_CURVE_CIRCULAR_ARC)
        {
            return geofx_bendFrameOnArc(bend, s);
        }
        return geofx_bendFrameOnParabola(bend, s);
    }
    geofx_BendFrame frame;
    frame.foot = Vector2(s, Number(0));
    frame.tangent = Vector2(Number(1), Number(0));
    frame.speed = Number(1);
    frame.turnRate = Number(0);
    if (s > 0)
    {
        frame.foot = bend.end + (s - bend.size) * bend.direction;
        frame.tangent = bend.direction;
    }
    return frame;
}

// Turns a vector of the profile, for example a normal, with the frame.
GEOFX_INLINE Vector2 geofx_bendTurn(geofx_BendFrame frame, Vector2 v)
{
    return v.x * frame.tangent + v.y * Vector2(-frame.tangent.y, frame.tangent.x);
}

// The stretch of the bend along the tangent at height h. The bend keeps heights, so this is its determinant, too. It
// is positive before the fold. An exact normal is geofx_bendTurn(frame, Vector2(n.x / stretch, n.y)).
GEOFX_INLINE Number geofx_bendStretch(geofx_BendFrame frame, Length h)
{
    return frame.speed - h * frame.turnRate;
}

// Where a point (s, h) goes.
GEOFX_INLINE Profile geofx_bend(geofx_Bend bend, Profile point)
{
    geofx_BendFrame frame = geofx_bendFrame(bend, point.x);
    return frame.foot + geofx_bendTurn(frame, Vector2(Number(0), point.y));
}

// The parabola's u whose normal meets a point. `across` and `along` are its coordinates from the vertex, across and
// along the bisector, in units of d/2 * cos(beta/2), with `along` >= 0. u is the root of slope^2/2 * u^3 + c*u =
// along, where c = 1 - slope * across. Newton's method starts beyond the root, where the cubic is convex and rises,
// so the steps come down to the root. An error e becomes less than 2/3 * e, and, with m = 1 - h*curvature, less than
// e^2 * (0.75/sqrt(m) + e/m). So 14 steps reach double precision for h*curvature <= 0.99. The loop ends when rounding
// stops the descent, most often after three steps. Between the zone's borders u stays in 0..1, even beyond the fold:
// the cubic is negative at 0 and not at 1.
GEOFX_INLINE Number geofx_bendFootInverse(Number slope, Number across, Number along)
{
    Number c = 1 - slope * across;
    Number square = slope * slope;
    Number u = along < c ? along / c : Number(1);
    for (int i = 0; i < 14; ++i)
    {
        Number next = (square * u * u * u + along) / (Number(1.5) * square * u * u + c);
        if (!(next < u))
        {
            break;
        }
        u = next;
    }
    return u;
}

// The inverse within the zone, on the parabola.
GEOFX_INLINE Profile geofx_unbendFromParabola(geofx_Bend bend, Profile point)
{
    Vector2 bisector = bend.bisector;
    Length unit = bend.size * bisector.x / 2;
    // The vertex is the curve's point at t = 1/2.
    Profile vertex = bend.size / 4 * Vector2(2 - bisector.y * bisector.y, bisector.x * bisector.y);
    Vector2 offset = (point - vertex) / unit;
    Number along = dot(offset, bisector);
    Number across = bisector.x * offset.y - bisector.y * offset.x;
    Number u = geofx_bendFootInverse(bend.slope, across, abs(along));
    u = along < 0 ? -u : u;
    // The height is measured from the foot to the point, along the normal.
    Number x = bend.slope * u;
    Length height = unit * (across - u * x / 2 - x * (along - u)) / sqrt(1 + x * x);
    Number share = (1 + u) / 2;
    if (bend.curve == GEOFX_CURVE_ARC_LENGTH)
    {
        share = Number(0.5) + geofx_bendArc(bend.slope, u) / bend.arc;
    }
    return Vector2(bend.size * share, height);
}

// The inverse within the zone, on the arc of a circle.
GEOFX_INLINE Profile geofx_unbendFromArc(geofx_Bend bend, Profile point)
{
    PerMetre curvature = bend.angle / bend.size;
    Vector2 toCenter = Vector2(curvature * point.x, 1 - curvature * point.y);
    Number radius = length(toCenter); // in units of the arc's own
    Number scale = radius + toCenter.y;
    Length s = 2 * point.x / scale * geofx_atanc(toCenter.x / scale);
    return Vector2(s, (2 * point.y - curvature * dot(point, point)) / (1 + radius));
}

// The inverse of geofx_bend: the point (s, h) that goes to this place. It is exact for heights with h *
// geofx_bendCurvature(bend) <= 0.99. Beyond the fold, places have several originals or none. There it stays finite,
// and prefers the focus. A hinge (d = 0) opens a wedge, which belongs to s = 0.
GEOFX_INLINE Profile geofx_unbend(geofx_Bend bend, Profile point)
{
    if (point.x <= 0)
    {
        return point;
    }
    Profile offset = point - bend.end;
    Length past = dot(offset, bend.direction);
    if (past >= 0)
    {
        return Vector2(bend.size + past, bend.direction.x * offset.y - bend.direction.y * offset.x);
    }
    if (bend.size <= 0)
    {
        return Vector2(Number(0), bend.angle > 0 ? -length(point) : length(point));
    }
    if (bend.curve == GEOFX_CURVE_CIRCULAR_ARC)
    {
        return geofx_unbendFromArc(bend, point);
    }
    return geofx_unbendFromParabola(bend, point);
}
