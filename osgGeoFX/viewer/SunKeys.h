// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/light/SunLight.h>

#include <osg/Camera>
#include <osgGA/GUIEventHandler>
#include <osgText/Text>

#include <string>

namespace osgGeoFX
{

/** Keys that move the sun of a scene: j goes half an hour on, J half an hour back. For two seconds the picture tells the time
    and where the sun stands. It handles no key if the scene has no SunLight.
    @ingroup viewer */
class OSGGEOFX_EXPORT SunKeys : public osgGA::GUIEventHandler
{
public:
    /// Moves the first SunLight below a node.
    explicit SunKeys(osg::Node& scene);

    bool hasSun() const { return _sun.valid(); }
    /// What the picture tells now; empty for nothing.
    std::string text() const;

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

private:
    osg::ref_ptr<SunLight> _sun;
    osg::ref_ptr<osg::Camera> _overlay;
    osg::ref_ptr<osgText::Text> _text;
    double _until = 0.0; ///< the event time at which the text goes
};

} // namespace osgGeoFX
