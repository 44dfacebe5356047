// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Camera>
#include <osg/ref_ptr>
#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

#include <string>

namespace osgGeoFX
{

/** What is drawn over a corner of the window, each frame anew or as it was, and shown and hidden by a key; at first it is hidden.

    One handler serves one view, in its event traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT CornerOverlay : public osgGA::GUIEventHandler
{
public:
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    void setShown(bool shown);
    bool shown() const { return _shown; }

protected:
    /// `usage`: what the key does, for the help page.
    CornerOverlay(char key, std::string usage);
    ~CornerOverlay() override;

    /// Called in each frame while it is shown; the view's camera has a viewport.
    virtual void show(osgViewer::View& view) = 0;
    /// Called when it is hidden.
    virtual void hide();

    osg::ref_ptr<osg::Camera> _overlay; ///< as showOverlay() makes it; null before the first frame

private:
    const char _key;
    const std::string _usage;
    bool _shown = false;
};

} // namespace osgGeoFX
