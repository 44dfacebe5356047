// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/viewer/EffectPresets.h>

#include <osg/Camera>
#include <osgGA/GUIEventHandler>
#include <osgText/Text>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Keys that step through the presets of a scene: p leads to the next one, P to the one before, by a blend (PresetBlend). A key during a blend
    begins another one from where the effects are. For three seconds the picture tells the preset's name, or why it cannot be shown.
    It handles no key if the scene has no presets. One handler serves one view and one scene.
    @ingroup viewer */
class OSGGEOFX_EXPORT PresetKeys : public osgGA::GUIEventHandler
{
public:
    /// Reads the presets of the scene. `seconds`: how long a blend takes; 0: it is done in the next frame.
    explicit PresetKeys(EffectScene& scene, double seconds = 1.5);

    bool hasPresets() const { return !_presets.empty(); }
    /// What the picture tells now; empty for nothing.
    std::string text() const;
    /// Whether a blend is going on.
    bool blending() const { return _blend.has_value(); }

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

private:
    void step(std::ptrdiff_t by, double time);

    osg::ref_ptr<EffectScene> _scene;
    std::vector<EffectPreset> _presets;
    double _seconds;
    std::optional<std::size_t> _current;
    std::optional<PresetBlend> _blend;
    double _start = 0.0; ///< the event time at which the blend began
    double _until = 0.0; ///< the event time at which the text goes
    std::string _words;
    osg::ref_ptr<osg::Camera> _overlay;
    osg::ref_ptr<osgText::Text> _text; ///< of _words
};

} // namespace osgGeoFX
