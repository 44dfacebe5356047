// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/AutomaticPanorama.h>

#include <osgGeoFX/viewer/Liberties.h>

#include <osg/Notify>

#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Cells of the relief from which the view is chosen, along the longer side.
constexpr int reliefCells = 512;

double aspectOf(const osgViewer::View& view)
{
    const osg::Viewport* const viewport = view.getCamera()->getViewport();
    const double aspect = viewport ? viewport->aspectRatio() : 1.0;
    return std::isfinite(aspect) && aspect > 0.0 ? aspect : 1.0;
}

} // namespace

AutomaticPanorama::AutomaticPanorama(EffectScene& scene, osg::Node& terrain)
    : _scene(&scene), _terrain(&terrain)
{
}

AutomaticPanorama::~AutomaticPanorama() = default;

void AutomaticPanorama::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("F11", "Make a panorama map; Shift: with liberties");
}

void AutomaticPanorama::begin(osgViewer::View& view)
{
    std::string error;
    std::optional<TerrainRelief> relief =
        TerrainRelief::read(*_terrain, _scene->ground().ellipsoid.get(), reliefCells, error);
    if (!relief)
    {
        OSG_WARN << "osgGeoFX: no panorama map can be made: " << error << std::endl;
        return;
    }
    PanoramaWishes wishes;
    wishes.aspect = aspectOf(view);
    _composition = std::async(std::launch::async,
                              [terrain = std::move(*relief), wishes, strength = _strength]() -> Result
                              {
                                  const PanoramaComposer composer(terrain, wishes);
                                  const PanoramaComposition chosen = composer.compose();
                                  return {chosen, terrain.geocentric,
                                          strength > 0.0 ? composer.liberties(chosen, strength)
                                                         : std::vector<PanoramaLiberty>()};
                              });
}

void AutomaticPanorama::show(const Result& result, osgViewer::View& view)
{
    for (const osg::ref_ptr<RegionalLiberty>& former : _liberties)
        _scene->removeEffect(former);
    _liberties.clear();
    osg::ref_ptr<PanoramaMap> map;
    for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
    {
        Effect* const effect = _scene->getEffect(i);
        auto* const panorama = dynamic_cast<PanoramaMap*>(effect);
        if (panorama && !map)
            map = panorama;
        else if (dynamic_cast<Deformation*>(effect) && !dynamic_cast<RegionalLiberty*>(effect))
            effect->setEnabled(false);
    }
    const bool known = map.valid();
    if (!known) map = new PanoramaMap;
    result.view.applyTo(*map);
    map->setEnabled(true);
    if (!known) _scene->addEffect(map);
    for (const PanoramaLiberty& liberty : result.liberties)
    {
        _liberties.push_back(makeLiberty(liberty, result.geocentric));
        addLiberty(*_scene, *_liberties.back());
        OSG_NOTICE << "osgGeoFX: " << liberty.why << std::endl;
    }
    if (_prepared) _prepared(*map);
    TerrainRelief frame;
    frame.geocentric = result.geocentric;
    const osg::Matrixd toEye = result.view.viewMatrix(frame);
    if (osgGA::CameraManipulator* const manipulator = view.getCameraManipulator())
        manipulator->setByInverseMatrix(toEye);
    else
        view.getCamera()->setViewMatrix(toEye);
}

bool AutomaticPanorama::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    if (event.getEventType() == osgGA::GUIEventAdapter::KEYDOWN &&
        event.getKey() == osgGA::GUIEventAdapter::KEY_F11)
    {
        request(event.getModKeyMask() & osgGA::GUIEventAdapter::MODKEY_SHIFT
                    ? PanoramaComposer::usualLiberties
                    : 0.0);
        action.requestRedraw();
        return true;
    }
    auto* const view = dynamic_cast<osgViewer::View*>(&action);
    if (event.getEventType() != osgGA::GUIEventAdapter::FRAME || !view || !busy()) return false;
    // A viewer that draws on demand must go on asking.
    action.requestRedraw();
    if (_composition.valid())
    {
        if (_composition.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
        show(_composition.get(), *view);
        return false;
    }
    _requested = false;
    begin(*view);
    return false;
}

} // namespace osgGeoFX
