// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Check.h"

#include "Effects.h"

#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>
#include <stdexcept>

namespace flightgear
{

namespace
{

std::vector<osg::Matrixd> randomViews(const osgGeoFX::Scene& scene, const osgGeoFX::ViewPoint& place,
                                      int count)
{
    std::mt19937 random(17);
    const auto between = [&](double low, double high)
    {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    std::vector<osg::Matrixd> views;
    while (static_cast<int>(views.size()) < count)
    {
        osgGeoFX::ViewPoint eye = place;
        const double away = between(0.0, 10000.0) / 6371000.0;
        const double bearing = between(0.0, 2.0 * osg::PI);
        eye.latitude += away * std::cos(bearing);
        eye.longitude += away * std::sin(bearing) / std::cos(place.latitude);
        eye.height = 1200.0 * std::pow(6.0, between(0.0, 1.0));
        eye.heading = between(0.0, 2.0 * osg::PI);
        eye.pitch = osg::DegreesToRadians(between(-60.0, 0.0));
        osg::Matrixd view;
        if (!eye.viewMatrix(*scene.reference, view))
            throw std::runtime_error("--check: a camera lies outside of the Earth's surface.");
        views.push_back(view);
    }
    return views;
}

/// Pixels that differ by more than a few levels.
int differing(const osg::Image& a, const osg::Image& b)
{
    int count = 0;
    for (int y = 0; y < a.t(); ++y)
        for (int x = 0; x < a.s(); ++x)
        {
            const unsigned char *one = a.data(x, y), *other = b.data(x, y);
            int most = 0;
            for (int channel = 0; channel < 3; ++channel)
                most = std::max(most, std::abs(one[channel] - other[channel]));
            count += most > 6 ? 1 : 0;
        }
    return count;
}

struct Named
{
    std::string name;
    osg::ref_ptr<osgGeoFX::Effect> effect;
};

/// A picture of squares in two colors.
osg::ref_ptr<osg::Image> chequers()
{
    constexpr int side = 64;
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            image->setColor((x / 8 + y / 8) % 2 ? osg::Vec4(0.9f, 0.2f, 0.1f, 1.0f)
                                                : osg::Vec4(1.0f, 0.9f, 0.3f, 1.0f),
                            static_cast<unsigned int>(x), static_cast<unsigned int>(y));
    return image;
}

/// All kinds of effects, over a place.
std::vector<Named> everyEffect(const osgGeoFX::ViewPoint& place)
{
    std::vector<Named> all;
    for (const char* line : {"birdsEyeView", "pedestrianView", "blendedView", "verticalExaggeration factor=3",
                             "panoramaMap edge=sea"})
        all.push_back({line, makeEffect(line)});
    const double longitude = osg::RadiansToDegrees(place.longitude),
                 latitude = osg::RadiansToDegrees(place.latitude);
    all.push_back({"closeUps", makeCloseUps({std::to_string(longitude) + "," + std::to_string(latitude) +
                                             ",4000,2500,1.6"})});
    all.push_back({"projectiveMappings", makeMapping(longitude, latitude, 8000.0, 20.0, *chequers())});
    return all;
}

class Checker
{
public:
    Checker(const osgGeoFX::Scene& scene, Drawing& drawing, std::vector<osg::Matrixd> views,
            std::string folder)
        : _scene(scene), _drawing(drawing), _views(std::move(views)), _folder(std::move(folder))
    {
    }

    /// With an effect, against the host's own picture; `most`: pixels that may differ.
    void comparesWithHost(const std::string& effect, int most)
    {
        const osg::ref_ptr<osgGeoFX::Effect> made = makeEffect(effect);
        _scene.effects->addEffect(made);
        compare(effect + " against the host's own picture", most,
                [&](bool first) { _drawing.setWithEffects(first); });
        _drawing.setWithEffects(true);
        _scene.effects->removeEffect(made);
    }
    /// With culling against without: the scene's own effects, and one more.
    void comparesCulling(const std::string& name, osgGeoFX::Effect* effect = nullptr)
    {
        if (effect) _scene.effects->addEffect(effect);
        culling(name);
        if (effect) _scene.effects->removeEffect(effect);
    }
    /// The same for the host's own picture.
    void comparesHostsCulling()
    {
        _drawing.setWithEffects(false);
        culling("the host itself");
        _drawing.setWithEffects(true);
    }
    int faults() const { return _faults; }

private:
    void culling(const std::string& what)
    {
        // Without the culling of small features, which is meant to be seen by those who look for it.
        using osg::CullSettings;
        compare(what + ", culling on against off", 0,
                [&](bool first)
                {
                    _drawing.camera().setCullingMode(first ? CullSettings::VIEW_FRUSTUM_SIDES_CULLING
                                                           : CullSettings::NO_CULLING);
                });
        _drawing.camera().setCullingMode(CullSettings::DEFAULT_CULLING);
    }
    template<class Set>
    void compare(const std::string& what, int most, const Set& set)
    {
        int worst = 0, wrong = 0;
        for (std::size_t i = 0; i < _views.size(); ++i)
        {
            osg::ref_ptr<osg::Image> one, other;
            int count = most + 1;
            // Again where something came late: SimGear's own pictures change, too, when a camera comes back.
            for (int attempt = 0; attempt < 3 && count > most; ++attempt)
            {
                set(true);
                one = _drawing.draw(_views[i]);
                set(false);
                other = _drawing.draw(_views[i]);
                count = same(*one, *other) ? 0 : std::max(most == 0 ? 1 : 0, differing(*one, *other));
            }
            worst = std::max(worst, count);
            if (count <= most) continue;
            ++wrong;
            if (_folder.empty()) continue;
            const std::string name = _folder + "/" + std::to_string(_faults) + "-" + std::to_string(i);
            osgDB::writeImageFile(*one, name + "a.png");
            osgDB::writeImageFile(*other, name + "b.png");
        }
        _faults += wrong > 0 ? 1 : 0;
        std::cout << (wrong > 0 ? "WRONG " : "ok    ") << what << ": " << _views.size() << " cameras, "
                  << wrong << " wrong, at most " << worst << " pixels differ" << std::endl;
    }

    const osgGeoFX::Scene& _scene;
    Drawing& _drawing;
    const std::vector<osg::Matrixd> _views;
    const std::string _folder;
    int _faults = 0;
};

} // namespace

int check(const osgGeoFX::Scene& scene, Ground& ground, const osgGeoFX::ViewPoint& place,
          const CheckOptions& options, const Frame& frame)
{
    const double nearest = options.nearest > 0.0 ? options.nearest : 1000.0;
    const bool own = scene.effects->getNumEffects() > 0;
    const std::vector<Named> effects = own ? std::vector<Named>() : everyEffect(place);
    double longest = ground.longestEdge(frame, nearest);
    for (const Named& each : effects)
    {
        scene.effects->addEffect(each.effect);
        longest = std::min(longest, ground.longestEdge(frame, nearest));
        scene.effects->removeEffect(each.effect);
    }
    ground.refine(longest);
    Drawing drawing(scene, frame);
    // Culling must not change what depths there are.
    drawing.camera().setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    Checker checker(scene, drawing, randomViews(scene, place, options.cameras), options.folder);
    if (own)
    {
        checker.comparesCulling("the scene's own effects");
        return checker.faults() == 0 ? 0 : 1;
    }
    checker.comparesWithHost("verticalExaggeration factor=1", 0);
    checker.comparesWithHost("verticalExaggeration factor=1.000001", frame.width * frame.height / 500);
    checker.comparesHostsCulling();
    for (const Named& each : effects)
        checker.comparesCulling(each.name, each.effect);
    return checker.faults() == 0 ? 0 : 1;
}

} // namespace flightgear
