// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/LabelPicture.h>

#include <osgGeoFX/labels/detail/CairoRows.h>
#include <osgGeoFX/labels/detail/WayBands.h>

#include <cairo.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

void setColor(cairo_t* target, const osg::Vec4& color)
{
    cairo_set_source_rgba(target, static_cast<double>(color.r()), static_cast<double>(color.g()),
                          static_cast<double>(color.b()), static_cast<double>(color.a()));
}

} // namespace

LabelPicture::LabelPicture(NameSet& names, EffectScene& scene, const osg::Camera& camera,
                           const std::vector<std::shared_ptr<const DepthPicture>>& depths,
                           const LabelLayout::Rules& rules, std::size_t most)
    : _names(&names), _width(camera.getViewport()->width()), _height(camera.getViewport()->height())
{
    const DeformedView view(scene, camera);
    const std::vector<NameSet::Seen> seen =
        names.inPicture(scene, camera.getViewMatrix(), camera.getProjectionMatrix(), _width, _height, most);
    std::vector<bool> visible;
    for (const NameSet::Seen& each : seen)
        visible.push_back(depths.empty() || NameSet::isShown(each, NameSet::placesShown(each, depths)));
    place(seen, visible, rules, bandsOfWays(scene, view, names, seen));
}

LabelPicture::LabelPicture(NameSet& names, const std::vector<NameSet::Seen>& seen,
                           const std::vector<bool>& visible, double width, double height,
                           const LabelLayout::Rules& rules)
    : _names(&names), _width(width), _height(height)
{
    place(seen, visible, rules, {});
}

void LabelPicture::place(const std::vector<NameSet::Seen>& seen, const std::vector<bool>& visible,
                         const LabelLayout::Rules& rules, const std::vector<LabelBand>& bands)
{
    std::vector<LabelCandidate> candidates;
    for (std::size_t i = 0; i < seen.size(); ++i)
    {
        candidates.push_back(seen[i].label);
        candidates.back().id = i;
        candidates.back().visible = seen[i].label.visible && i < visible.size() && visible[i];
    }
    LabelLayout::Rules scaled = rules;
    scaled.gap *= _names->getScale();
    scaled.room *= _names->getScale();
    for (const PlacedLabel& label : LabelLayout::placeOnce(candidates, _width, _height, scaled, bands))
    {
        _placed.push_back({seen[label.id].name, label, seen[label.id].label.curve});
        _placed.back().label.id = seen[label.id].name;
    }
}

void LabelPicture::draw(_cairo* target) const
{
    const double scale = _names->getScale();
    for (const Name& each : _placed)
    {
        const NameStyle& style = _names->styleOf(_names->names()[each.name]);
        const double x = each.label.anchor.x(), y = _height - each.label.anchor.y();
        for (const bool halo : {true, false})
        {
            setColor(target, halo ? style.text.halo : style.text.color);
            cairo_set_line_width(target, scale * style.lineWidth * (halo ? 2.0 : 1.0));
            cairo_set_line_cap(target, CAIRO_LINE_CAP_BUTT);
            if (each.label.leader)
            {
                cairo_move_to(target, x, y);
                cairo_line_to(target, x, _height - each.label.corner.y());
                cairo_stroke(target);
            }
            if (style.dot > 0.0)
            {
                cairo_new_sub_path(target);
                cairo_arc(target, x, y, scale * (style.dot + (halo ? 0.5 * style.lineWidth : 0.0)), 0.0,
                          2.0 * M_PI);
                cairo_fill(target);
            }
        }
    }
    for (const Name& each : _placed)
    {
        const LabelText& text = _names->text(each.name);
        if (each.curve.empty())
        {
            text.draw(target, each.label.corner.x() + text.left(),
                      _height - (each.label.corner.y() + each.label.size.y()) + text.above());
            continue;
        }
        std::vector<osg::Vec2d> curve;
        for (const osg::Vec2d& point : each.curve)
            curve.emplace_back(point.x(), _height - point.y());
        text.drawAlong(target, curve);
    }
}

bool LabelPicture::drawOnto(osg::Image& image) const
{
    return image.t() == static_cast<int>(_height) && drawOnto(image, 0);
}

bool LabelPicture::drawOnto(osg::Image& image, int first) const
{
    return drawOver(image, first, static_cast<int>(_width), [this](cairo_t* target) { draw(target); });
}

} // namespace osgGeoFX
