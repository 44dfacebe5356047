// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/panorama/PanoramaComposer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

#include <functional>
#include <future>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Makes a panorama map of whatever terrain a scene shows, by the key F11. PanoramaComposer chooses the view for the
    window's shape. With Shift it takes liberties, too, as a painter would.

    The first PanoramaMap of the scene takes the values and is enabled; a scene without one gets one. Other
    deformations are disabled, since the projection of a scene is one; only a RegionalLiberty stays. Liberties of the map
    before are removed. Then the view's manipulator, or its camera, moves
    to the map's place. The view stays as it is where there is no terrain, with a warning that says why.

    The terrain is read in the event traversal, which takes up to a second or two. The choice takes some seconds in a
    thread of its own, while the viewer goes on; the destructor waits for it. One handler serves one view, in its event
    traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT AutomaticPanorama : public osgGA::GUIEventHandler
{
public:
    /// `terrain`: what TerrainRelief reads, in world coordinates; usually the whole scene.
    AutomaticPanorama(EffectScene& scene, osg::Node& terrain);

    /// Makes the map in the next frames, as the key does. For the event traversal, such as a button's.
    /// `liberties`: their strength, 0…1 (PanoramaComposer::liberties()); 0 for none.
    void request(double liberties = 0.0)
    {
        _requested = true;
        _strength = liberties;
    }
    /// Whether a map is still being made.
    bool busy() const { return _requested || _composition.valid(); }

    /// Called when a map is in the scene and enabled, before the camera moves; to select a manipulator that suits it.
    void setPrepared(std::function<void(PanoramaMap&)> prepared) { _prepared = std::move(prepared); }

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

protected:
    ~AutomaticPanorama() override;

private:
    struct Result
    {
        PanoramaComposition view;
        bool geocentric;
        std::vector<PanoramaLiberty> liberties;
    };

    void begin(osgViewer::View& view);
    void show(const Result& result, osgViewer::View& view);

    const osg::ref_ptr<EffectScene> _scene;
    const osg::ref_ptr<osg::Node> _terrain;
    std::function<void(PanoramaMap&)> _prepared;
    bool _requested = false;
    double _strength = 0.0;                                ///< of the liberties of the next map
    std::vector<osg::ref_ptr<RegionalLiberty>> _liberties; ///< of the last one
    std::future<Result> _composition;
};

} // namespace osgGeoFX
