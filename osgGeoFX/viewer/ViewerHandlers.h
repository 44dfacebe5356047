// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Camera>
#include <osgGA/GUIEventHandler>
#include <osgText/Text>
#include <osgViewer/View>

#include <chrono>

namespace osgGeoFX
{

/** Keeps the terrain's pixel-error bound when the size of the window or the field of view changes. It preserves other
    changes of the camera's LOD scale (the keys * and / of osgViewer::LODScaleHandler). One handler serves one view.
    @ingroup viewer */
class OSGGEOFX_EXPORT LodScaleFollower : public osgGA::GUIEventHandler
{
public:
    explicit LodScaleFollower(const Scene& scene) : _terrain(scene.terrain) {}

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;

private:
    std::optional<TerrainInfo> _terrain;
    float _base = 1.0f;
};

/** Shows longitude and latitude (degrees) and height (metres) of the ground below the pointer, as the effects show the
    ground, in the lower left corner of the window. The key c switches the text. If the scene has no reference, the
    text says why. One handler serves one view.
    @ingroup viewer */
class OSGGEOFX_EXPORT CursorReadout : public osgGA::GUIEventHandler
{
public:
    explicit CursorReadout(const Scene& scene);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// The key that shows and hides the text, as in osgGA::GUIEventAdapter; 'c' by default.
    void setKey(int key) { _key = key; }
    int getKey() const { return _key; }

    /// The text shown; empty while it is hidden.
    std::string text() const;

private:
    void toggle(osgViewer::View& view);
    void show(osgViewer::View& view, float x, float y);

    osg::ref_ptr<EffectScene> _effects;
    osg::ref_ptr<Georeference> _reference;
    std::string _whyNone;
    osg::ref_ptr<osg::Camera> _overlay;
    osg::ref_ptr<osgText::Text> _text;
    int _key = 'c';
    bool _shown = false;
    bool _moved = false;
    std::chrono::steady_clock::time_point _lastMove;
};

} // namespace osgGeoFX
