// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>

#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

namespace osgGeoFX
{

/** Click and fly (Mackinlay et al. 1990; paper: multi-perspective views, Section 3.2): a click with Ctrl and the left
    button flies the camera to the ground shown at that pixel. It also works in the transition zone and in the context.
    Any camera manipulator works, since only its matrices are used. One handler serves one view.
    @ingroup viewer */
class OSGGEOFX_EXPORT ClickAndFly : public osgGA::GUIEventHandler
{
public:
    /// `share`: how much of the way is flown, 0…1. `seconds`: how long a flight takes.
    explicit ClickAndFly(EffectScene& scene, double share = 0.7, double seconds = 1.5)
        : _scene(&scene), _share(share), _seconds(seconds)
    {
    }

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;
    bool flying() const { return _start >= 0.0; }

private:
    bool aim(osgViewer::View& view, const osgGA::GUIEventAdapter& event);
    void fly(osgViewer::View& view, double time);

    osg::ref_ptr<EffectScene> _scene;
    double _share;
    double _seconds;
    double _start = -1.0;
    osg::Vec3d _from; ///< position of the eye at the start, world coordinates
    osg::Vec3d _to;
    osg::Matrixd _attitude; ///< the view matrix without its translation
};

} // namespace osgGeoFX
