// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/web/WebNames.h>

#include <osgGeoFX/web/detail/TilePyramid.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgGeoFX
{

namespace
{

/// Every so many points of a curve are kept.
constexpr std::size_t thinning = 4;
/// The gap between a place and its name, of the picture's height on the screen, and its bounds in pixels. A small picture has no room above its summits.
constexpr double gapShare = 0.02, leastGap = 5.0, mostGap = 10.0;
/// Boxes that a line may lead up. Names on the screen have less room than those of a print.
constexpr int rows = 4;

std::vector<osg::Vec2d> thinned(const std::vector<osg::Vec2d>& curve, double scale, double height)
{
    std::vector<osg::Vec2d> points;
    for (std::size_t i = 0; i < curve.size(); ++i)
        if (i % thinning == 0 || i + 1 == curve.size())
            points.emplace_back(curve[i].x() / scale, height - curve[i].y() / scale);
    return points;
}

void setPlace(const MapName& name, const Georeference* reference, WebName& web)
{
    if (name.kind == MapName::POINT && !std::isnan(name.height)) web.height = name.height;
    double longitude = 0.0, latitude = 0.0, height = 0.0;
    if (!reference ||
        !reference->toGeodetic(name.places[name.places.size() / 2], longitude, latitude, height))
        return;
    web.longitude = osg::RadiansToDegrees(longitude);
    web.latitude = osg::RadiansToDegrees(latitude);
    if (name.kind == MapName::POINT && !web.height) web.height = height;
}

} // namespace

int WebNames::nativeZoom() const
{
    return TilePyramid::levelsOf(width, height);
}

double WebNames::scaleAt(int step) const
{
    return std::exp2(static_cast<double>(step) / stepsOfZoom - nativeZoom());
}

std::vector<WebName> WebNames::layOut(NameSet& names, EffectScene& scene) const
{
    const double formerScale = names.getScale();
    names.setScale(1.0);
    LabelLayout::Rules rules;
    rules.rows = rows;
    rules.fading = rules.patience = 0.0;
    rules.most = most;
    LabelLayout layout(rules);
    std::map<std::size_t, WebName> found; // by the index in the set, which is the order of importance
    std::map<std::size_t, bool> visible;
    double time = 0.0;
    for (int step = 0; step <= lastStep(); ++step)
    {
        const double scale = scaleAt(step);
        rules.gap = std::clamp(gapShare * scale * height, leastGap, mostGap);
        layout.setRules(rules);
        std::vector<LabelCandidate> candidates;
        for (const NameSet::Seen& seen :
             names.inPicture(scene, view, projection, scale * width, scale * height, most))
        {
            const auto known = visible.find(seen.name);
            const bool shows =
                known != visible.end()
                    ? known->second
                    : depths.empty() || NameSet::isShown(seen, NameSet::placesShown(seen, depths));
            visible[seen.name] = shows;
            const bool within = seen.label.anchor.x() >= 0.0 && seen.label.anchor.y() >= 0.0 &&
                                seen.label.anchor.x() <= scale * width &&
                                seen.label.anchor.y() <= scale * height;
            if (!shows || !within || !seen.label.visible) continue;
            candidates.push_back(seen.label);
            if (found.count(seen.name)) continue;
            const MapName& name = names.names()[seen.name];
            WebName& web = found[seen.name];
            web.text = name.text;
            web.style = name.style;
            web.look = names.styleOf(name);
            web.alongCurve = name.kind == MapName::LINE;
            web.anchor.set(seen.label.anchor.x() / scale, height - seen.label.anchor.y() / scale);
            web.size.set(seen.label.size.x(), seen.label.size.y());
            if (web.alongCurve)
            {
                // At the first zoom that has room for the name its curve is longest. The middle stays the same.
                web.curve = thinned(seen.label.curve, scale, height);
                web.anchor = web.curve[web.curve.size() / 2];
            }
            setPlace(name, reference, web);
        }
        // At whole zooms names move to better places, if there are any by now.
        if (step % stepsOfZoom == 0) layout.clear();
        // Those that are shown come first, so that none goes away because one zooms in.
        std::stable_partition(candidates.begin(), candidates.end(),
                              [&](const LabelCandidate& candidate)
                              {
                                  const WebName& web = found[candidate.id];
                                  return !web.shown.empty() && web.shown.back().to == step - 1;
                              });
        // A name that had to leave its place gets another one in the second round.
        layout.place(candidates, scale * width, scale * height, time += 1.0);
        for (const PlacedLabel& label : layout.place(candidates, scale * width, scale * height, time += 1.0))
        {
            WebName& web = found[label.id];
            const osg::Vec2d corner(label.corner.x() - label.anchor.x(),
                                    label.anchor.y() - label.corner.y() - label.size.y());
            const bool goesOn = !web.shown.empty() && web.shown.back().to == step - 1 &&
                                (web.alongCurve || (web.shown.back().corner - corner).length() < 0.01);
            if (goesOn)
                web.shown.back().to = step;
            else
                web.shown.push_back({step, step, corner});
        }
    }
    names.setScale(formerScale);
    std::vector<WebName> result;
    for (auto& [index, name] : found)
        result.push_back(std::move(name));
    return result;
}

} // namespace osgGeoFX
