// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/Misuse.h>

#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/LOD>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <set>

namespace osgGeoFX
{

namespace
{

std::string nameOf(const osg::Node& node)
{
    return std::string(node.className()) + (node.getName().empty() ? "" : " \"" + node.getName() + "\"");
}

bool scales(const osg::Matrixd& matrix)
{
    constexpr double slack = 2e-3; // of squares
    osg::Vec3d rows[3];
    for (int row = 0; row < 3; ++row)
        rows[row].set(matrix(row, 0), matrix(row, 1), matrix(row, 2));
    const auto other = [&](int row)
    {
        return std::abs(rows[row].length2() - 1.0) > slack ||
               std::abs(rows[row] * rows[(row + 1) % 3]) > slack;
    };
    return other(0) || other(1) || other(2);
}

/// Whether coordinates are those of an Earth around its center: far from the plane z = 0, where projected heights are, and as far
/// from the center as the ground is; or all around it.
bool isEarth(const osg::BoundingSphere& bound)
{
    constexpr double least = 6.3e6, most = 6.5e6, middle = 1e5, highest = 5e4;
    const osg::Vec3d center = bound.center();
    const double radius = static_cast<double>(bound.radius()), away = center.length();
    if (away < middle) return radius > least && radius < most;
    return away > least && away < most && std::abs(center.z()) > std::max(highest, radius);
}

/// The effects that scenes have, as often as they have them.
struct Hosted
{
    std::mutex mutex;
    std::multiset<const Effect*> effects;
};

Hosted& hosted()
{
    // Scenes of static objects may outlive it otherwise.
    static Hosted* const all = new Hosted;
    return *all;
}

/// Whether a child does. A transform has a frame of its own for its children.
bool hasEarth(const osg::Group& terrain)
{
    for (unsigned int i = 0; i < terrain.getNumChildren(); ++i)
        if (isEarth(terrain.getChild(i)->getBound())) return true;
    return false;
}

} // namespace

void Misuse::enter(const Effect& effect)
{
    const std::lock_guard<std::mutex> lock(hosted().mutex);
    hosted().effects.insert(&effect);
}

void Misuse::leave(const Effect& effect)
{
    const std::lock_guard<std::mutex> lock(hosted().mutex);
    const auto found = hosted().effects.find(&effect);
    if (found != hosted().effects.end()) hosted().effects.erase(found);
}

void Misuse::say(Cause cause, const std::string& sentence)
{
    const unsigned int bit = 1u << cause;
    if ((_said.fetch_or(bit) & bit) == 0) OSG_WARN << "osgGeoFX: " << sentence << std::endl;
}

bool Misuse::lasts(Cause cause, bool holds)
{
    constexpr unsigned int patience = 30;
    if (!holds)
    {
        if (_looks[cause] != 0) _looks[cause] = 0;
        return false;
    }
    return ++_looks[cause] >= patience;
}

void Misuse::look(const EffectScene& scene, osgUtil::CullVisitor& outer, const ViewGeometry& view,
                  const osg::Group& terrain)
{
    if (!said(SCALED_ABOVE) && scales(view.modelView))
        say(SCALED_ABOVE,
            "a transform above the scene, or the camera's view matrix, scales. Effects take world "
            "coordinates for metres, so the picture is wrong. Put the transform below the "
            "EffectScene.");
    if (!said(EARTH_AS_PLANE) &&
        lasts(EARTH_AS_PLANE, !view.ground.ellipsoid && scene.getTerrainFrame() == EffectScene::AUTOMATIC &&
                                  hasEarth(terrain)))
        say(EARTH_AS_PLANE,
            "the terrain has geocentric coordinates, but there is no osg::CoordinateSystemNode with an "
            "ellipsoid, so effects take its z for heights. Put it below such a node, or call "
            "EffectScene::setTerrainFrame(EffectScene::GEOCENTRIC).");
    if (!said(LEVELS_ABOVE))
    {
        for (const osg::Node* node : outer.getNodePath())
        {
            // A terrain may be of any class itself.
            const auto* levels = node != &terrain ? dynamic_cast<const osg::LOD*>(node) : nullptr;
            if (!levels) continue;
            say(LEVELS_ABOVE,
                "the scene stands below the node " + nameOf(*levels) +
                    ", which chooses levels of detail by where the terrain is without effects. Put "
                    "the EffectScene above it.");
        }
    }
}

void Misuse::meet(const osg::Group& terrain, const osg::FrameStamp* frame)
{
    if (!frame) return;
    bool second = false;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        second = _terrain && _terrain != &terrain && _frame == frame->getFrameNumber();
        _terrain = &terrain;
        _frame = frame->getFrameNumber();
    }
    if (second && !said(TWO_TERRAINS))
        say(TWO_TERRAINS, "one EffectScene draws two terrains in a frame, and what works with it, such as "
                          "DeformedView, knows one of them. Give each EffectCullCallback a scene of its own; "
                          "scenes may share effects.");
}

void Misuse::look(const CameraEffects& camera)
{
    if (said(STRAY_EFFECT)) return;
    const std::lock_guard<std::mutex> lock(hosted().mutex);
    const Effect* stray =
        camera.find([](const Effect& effect) { return hosted().effects.count(&effect) == 0; });
    if (stray)
        say(STRAY_EFFECT, "a camera's CameraEffects are for a " + std::string(stray->className()) +
                              " that is in no scene, so they have no effect. Name the effect itself that the "
                              "scene has, not a copy of it, and add it with EffectScene::addEffect().");
}

} // namespace osgGeoFX
