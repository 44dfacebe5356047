// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "PatternLayers.h"

#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <osg/Math>

#include <cstddef>
#include <cstdio>

namespace geofx::bench
{

namespace
{

using namespace osgGeoFX;

struct Pattern
{
    const char* name;
    const char* what;
    ColorTransfer::Pattern pattern;
    double interval; ///< metres
};

constexpr Pattern patterns[] = {{"contours", "contour lines, 20 m", ColorTransfer::CONTOURS, 20.0},
                                {"graticule", "a graticule, 500 m", ColorTransfer::GRATICULE, 500.0},
                                {"hatching", "hatching, 200 m", ColorTransfer::HATCHING, 200.0},
                                {"dots", "dots, 200 m", ColorTransfer::DOTS, 200.0}};

/// A mapping of one color over all of the ground, in an effect of its own.
osg::ref_ptr<ProjectiveMappings> effectWith(ColorTransfer::Pattern pattern, double interval)
{
    constexpr double reach = 5000.0;
    const osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setRectangle({0.0, 0.0}, reach, reach);
    ColorTransfer& transfer = *mapping->getTransfer();
    transfer.setSource(ColorTransfer::CONSTANT);
    transfer.setConstant({0.2, 0.1, 0.05, 1.0});
    transfer.setPattern(pattern);
    transfer.setPatternInterval(interval);
    transfer.setPatternWidth(1.5);
    osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
    effect->addMapping(mapping);
    return effect;
}

} // namespace

std::vector<Figure> patternLayers(OffscreenView& view, EffectScene& scene, const Settings& settings)
{
    announce("drawing patterns");
    // None, a plain color, and the patterns. Only one is in the scene at a time, for all that are there are in its program.
    std::vector<osg::ref_ptr<ProjectiveMappings>> effects = {nullptr, effectWith(ColorTransfer::NONE, 100.0)};
    for (const Pattern& pattern : patterns)
        effects.push_back(effectWith(pattern.pattern, pattern.interval));
    view.look(osg::Matrixd::lookAt(osg::Vec3d(0.0, -7000.0, 5500.0), osg::Vec3d(0.0, -700.0, 0.0),
                                   osg::Vec3d(0.0, 0.0, 1.0)));
    const int rounds = settings.smoke ? 1 : settings.quick ? 5 : 11;
    std::vector<std::vector<double>> times(effects.size());
    for (int round = 0; round < rounds; ++round)
    {
        for (std::size_t i = 0; i < effects.size(); ++i)
        {
            if (effects[i]) scene.addEffect(effects[i]);
            // Its program and its textures come with the first one.
            view.frame();
            for (int k = 0; k < 3; ++k)
                times[i].push_back(1000.0 * view.frame());
            if (effects[i]) scene.removeEffect(effects[i]);
        }
    }
    const double none = median(times[0]), plain = median(times[1]);
    std::vector<Figure> figures;
    for (std::size_t i = 0; i < std::size(patterns); ++i)
    {
        const double time = median(times[i + 2]);
        Figure figure{std::string("pattern-") + patterns[i].name,
                      std::string("frames a second with ") + patterns[i].what +
                          " over all of the ground, over those with a plain color there",
                      ""};
        figure.measured = plain / time;
        char remark[160];
        std::snprintf(remark, sizeof remark,
                      "%.2f ms, a plain color %.2f ms, no mapping %.2f ms; over those without a mapping %.2f",
                      time, plain, none, none / time);
        figure.remark = remark;
        figures.push_back(figure);
    }
    return figures;
}

} // namespace geofx::bench
