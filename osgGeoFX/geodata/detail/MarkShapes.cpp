// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/MarkShapes.h>

#include <cairo.h>
#include <osg/Math>
#include <osg/Vec2d>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

namespace osgGeoFX
{

namespace
{

using Points = std::vector<osg::Vec2d>;

void addLine(cairo_t* context, const Points& points, bool closed)
{
    cairo_new_sub_path(context);
    for (const osg::Vec2d& point : points)
        cairo_line_to(context, point.x(), point.y());
    if (closed) cairo_close_path(context);
}

/// Corners on a circle, the first one at the top. `inner`: the radius of every second one.
Points corners(int count, double inner = 0.5)
{
    Points points;
    for (int i = 0; i < count; ++i)
    {
        const double radius = i % 2 == 0 ? 0.5 : inner, angle = i * 2.0 * osg::PI / count;
        points.emplace_back(radius * std::sin(angle), -radius * std::cos(angle));
    }
    return points;
}

/// From one angle to another, counter-clockwise from the right, degrees.
void addArc(cairo_t* context, const osg::Vec2d& center, double radius, double from, double to)
{
    cairo_arc_negative(context, center.x(), center.y(), radius, osg::DegreesToRadians(-from),
                       osg::DegreesToRadians(-to));
}

void addSector(cairo_t* context, double from, double to)
{
    cairo_move_to(context, 0.0, 0.0);
    addArc(context, osg::Vec2d(), 0.5, from, to);
    cairo_close_path(context);
}

void addRounded(cairo_t* context)
{
    constexpr double radius = 0.125, middle = 0.5 - radius;
    cairo_new_sub_path(context);
    addArc(context, {middle, -middle}, radius, 0.0, 90.0);
    addArc(context, {-middle, -middle}, radius, 90.0, 180.0);
    addArc(context, {-middle, middle}, radius, 180.0, 270.0);
    addArc(context, {middle, middle}, radius, 270.0, 360.0);
    cairo_close_path(context);
}

void addHeart(cairo_t* context)
{
    cairo_move_to(context, 0.0, 0.375);
    addArc(context, {0.25, -0.25}, 0.25, -45.0, 165.0);
    addArc(context, {-0.25, -0.25}, 0.25, 15.0, 225.0);
    cairo_close_path(context);
}

constexpr double arm = 0.125; ///< half of the width of a cross's arms
const Points& plus()
{
    static const Points points = {{-arm, -0.5}, {arm, -0.5}, {arm, -arm},  {0.5, -arm},
                                  {0.5, arm},   {arm, arm},  {arm, 0.5},   {-arm, 0.5},
                                  {-arm, arm},  {-0.5, arm}, {-0.5, -arm}, {-arm, -arm}};
    return points;
}

void addTurned(cairo_t* context, const Points& points)
{
    cairo_rotate(context, osg::PI_4);
    addLine(context, points, true);
    cairo_rotate(context, -osg::PI_4);
}

constexpr double side = 0.2071; ///< of a regular octagon that is one unit high, halved

/// Closed lines.
const std::map<std::string, Points>& polygons()
{
    static const std::map<std::string, Points> known = {
        {"square", {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}},
        {"triangle", {{0.0, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}},
        {"equilateral_triangle", corners(3)},
        {"star", corners(10, 0.191)},
        {"star_diamond", corners(8, 0.191)},
        {"cross", plus()},
        {"diamond", corners(4)},
        {"pentagon", corners(5)},
        {"hexagon", corners(6)},
        {"octagon",
         {{side, -0.5},
          {0.5, -side},
          {0.5, side},
          {side, 0.5},
          {-side, 0.5},
          {-0.5, side},
          {-0.5, -side},
          {-side, -0.5}}},
        {"decagon", corners(10)},
        {"shield", {{0.5, 0.25}, {0.5, -0.5}, {-0.5, -0.5}, {-0.5, 0.25}, {0.0, 0.5}}},
        {"square_with_corners",
         {{-0.3, 0.5},
          {0.3, 0.5},
          {0.5, 0.3},
          {0.5, -0.3},
          {0.3, -0.5},
          {-0.3, -0.5},
          {-0.5, -0.3},
          {-0.5, 0.3}}},
        {"half_square", {{-0.5, -0.5}, {0.0, -0.5}, {0.0, 0.5}, {-0.5, 0.5}}},
        {"quarter_square", {{-0.5, -0.5}, {0.0, -0.5}, {0.0, 0.0}, {-0.5, 0.0}}},
        {"diagonal_half_square", {{-0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}},
        {"left_half_triangle", {{0.0, 0.5}, {0.5, 0.5}, {0.0, -0.5}}},
        {"right_half_triangle", {{-0.5, 0.5}, {0.0, 0.5}, {0.0, -0.5}}},
        {"trapezoid", {{0.25, -0.25}, {0.5, 0.25}, {-0.5, 0.25}, {-0.25, -0.25}}},
        {"parallelogram_right", {{0.25, 0.25}, {0.5, -0.25}, {-0.25, -0.25}, {-0.5, 0.25}}},
        {"parallelogram_left", {{0.5, 0.25}, {0.25, -0.25}, {-0.5, -0.25}, {-0.25, 0.25}}},
        {"arrow",
         {{0.0, -0.5},
          {0.25, -0.25},
          {0.125, -0.25},
          {0.125, 0.5},
          {-0.125, 0.5},
          {-0.125, -0.25},
          {-0.25, -0.25}}},
        {"filled_arrowhead", {{0.0, 0.0}, {-0.5, 0.5}, {-0.5, -0.5}}}};
    return known;
}

/// Lines of two or three points; crosses of two of them.
const std::map<std::string, std::vector<Points>>& lines()
{
    static const std::map<std::string, std::vector<Points>> known = {
        {"line", {{{0.0, -0.5}, {0.0, 0.5}}}},
        {"horline", {{{-0.5, 0.0}, {0.5, 0.0}}}},
        {"slash", {{{-0.5, 0.5}, {0.5, -0.5}}}},
        {"backslash", {{{-0.5, -0.5}, {0.5, 0.5}}}},
        {"plus", {{{0.0, -0.5}, {0.0, 0.5}}, {{-0.5, 0.0}, {0.5, 0.0}}}},
        {"times", {{{-0.5, 0.5}, {0.5, -0.5}}, {{-0.5, -0.5}, {0.5, 0.5}}}},
        {"arrowhead", {{{-0.5, -0.5}, {0.0, 0.0}, {-0.5, 0.5}}}}};
    return known;
}

using Add = std::function<void(cairo_t*)>;
const std::map<std::string, Add>& rounds()
{
    static const std::map<std::string, Add> known = {
        {"circle",
         [](cairo_t* context)
         {
             cairo_arc(context, 0.0, 0.0, 0.5, 0.0, 2.0 * osg::PI);
         }},
        {"dot",
         [](cairo_t* context)
         {
             cairo_arc(context, 0.0, 0.0, 0.125, 0.0, 2.0 * osg::PI);
         }},
        {"semi_circle",
         [](cairo_t* context)
         {
             addSector(context, 0.0, 180.0);
         }},
        {"third_circle",
         [](cairo_t* context)
         {
             addSector(context, 90.0, 210.0);
         }},
        {"quarter_circle",
         [](cairo_t* context)
         {
             addSector(context, 90.0, 180.0);
         }},
        {"rounded_square", addRounded},
        {"heart", addHeart},
        {"x",
         [](cairo_t* context)
         {
             addTurned(context, plus());
         }},
        {"asterisk_fill", [](cairo_t* context)
         {
             addLine(context, plus(), true);
             addTurned(context, plus());
         }}};
    return known;
}

const std::map<std::string, Add>& arcs()
{
    static const std::map<std::string, Add> known = {{"half_arc",
                                                      [](cairo_t* context)
                                                      {
                                                          addArc(context, osg::Vec2d(), 0.5, 0.0, 180.0);
                                                      }},
                                                     {"third_arc",
                                                      [](cairo_t* context)
                                                      {
                                                          addArc(context, osg::Vec2d(), 0.5, 90.0, 210.0);
                                                      }},
                                                     {"quarter_arc", [](cairo_t* context)
                                                      {
                                                          addArc(context, osg::Vec2d(), 0.5, 90.0, 180.0);
                                                      }}};
    return known;
}

/// Other names of these.
const std::map<std::string, std::string>& others()
{
    static const std::map<std::string, std::string> known = {{"rectangle", "square"},
                                                             {"cross_fill", "cross"},
                                                             {"cross2", "x"},
                                                             {"regular_star", "star"},
                                                             {"vertline", "line"},
                                                             {"oarrow", "arrowhead"},
                                                             {"emicircle", "semi_circle"},
                                                             {"carrow", "filled_arrowhead"},
                                                             {"diamond_star", "star_diamond"},
                                                             {"narrow", "arrow"},
                                                             {"hatch", "times"}};
    return known;
}

} // namespace

std::optional<std::string> MarkShapes::named(const std::string& wellKnownName)
{
    std::string name = wellKnownName;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const std::string scheme : {"shape://", "extshape://"})
        if (name.rfind(scheme, 0) == 0) name.erase(0, scheme.size());
    const auto other = others().find(name);
    if (other != others().end()) name = other->second;
    if (polygons().count(name) + lines().count(name) + rounds().count(name) + arcs().count(name) > 0)
        return name;
    return std::nullopt;
}

bool MarkShapes::isLine(const std::string& mark)
{
    return lines().count(mark) + arcs().count(mark) > 0;
}

std::vector<double> MarkShapes::hatches(const std::string& mark)
{
    static const std::map<std::string, std::vector<double>> known = {
        {"line", {90.0}},       {"horline", {0.0}},    {"slash", {45.0}},
        {"backslash", {-45.0}}, {"plus", {0.0, 90.0}}, {"times", {45.0, -45.0}}};
    const auto found = known.find(mark);
    return found == known.end() ? std::vector<double>() : found->second;
}

void MarkShapes::add(_cairo* context, const std::string& mark)
{
    cairo_new_path(context);
    if (const auto polygon = polygons().find(mark); polygon != polygons().end())
        addLine(context, polygon->second, true);
    else if (const auto line = lines().find(mark); line != lines().end())
        for (const Points& points : line->second)
            addLine(context, points, false);
    else if (const auto round = rounds().find(mark); round != rounds().end())
        round->second(context);
    else if (const auto arc = arcs().find(mark); arc != arcs().end())
        arc->second(context);
}

} // namespace osgGeoFX
