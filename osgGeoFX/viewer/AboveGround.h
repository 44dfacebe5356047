// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>

#include <osgGA/CameraManipulator>

#include <cstdint>
#include <optional>

namespace osgGeoFX
{

/** Keeps a camera above the ground as its picture shows it: exaggerated, bent, lifted. It wraps any manipulator, all of OSG's among
    them, and is used in its place.

    @code
    viewer.setCameraManipulator(new osgGeoFX::AboveGround(*scene, manipulator));
    @endcode

    Where the manipulator would put the eye lower than `margin` over the ground, the eye rises straight up, in the same frame, and
    looks as before; the manipulator goes on from there. Where ground hangs over the eye, as a steep bend's may, the eye stays below it.
    Buildings and other things that keep their shape (RigidParts, RigidReference) hold nobody up. Recorded paths
    (osgGA::AnimationPathManipulator) and panorama maps (PanoramaManipulator) are left as they are.

    It looks at the tiles that are loaded, at the level that is drawn, and follows their triangles along bends. A look costs a ray through them; frames in which neither the
    camera nor an effect has changed cost nothing, but for four looks a second for new tiles. One object serves one view.
    @ingroup viewer */
class OSGGEOFX_EXPORT AboveGround : public osgGA::CameraManipulator
{
public:
    /// `manipulator`: never null; an osgGA::KeySwitchMatrixManipulator counts as the one that it has chosen.
    AboveGround(EffectScene& scene, osgGA::CameraManipulator& manipulator);
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "AboveGround"; }

    /// The least height of the eye above the ground below it, metres, more than 0; 2 by default.
    void setMargin(double metres) { _margin = metres > 0.0 ? metres : _margin; }
    double getMargin() const { return _margin; }
    /// Whether the camera is kept above the ground; true by default.
    void setEnabled(bool on) { _enabled = on; }
    bool getEnabled() const { return _enabled; }

    osgGA::CameraManipulator& getManipulator() { return *_inner; }
    /// The manipulator that moves a camera in the end: what is inside this class and osgGA's key switch. Null for null.
    static osgGA::CameraManipulator* movingOne(osgGA::CameraManipulator* manipulator);
    /// Whether it moves the camera by what its user does, so that others may move the camera, too: not recorded paths, and not
    /// PanoramaManipulator, which has rules of its own. False for null.
    static bool isFree(osgGA::CameraManipulator* manipulator);

    /// How far a camera has to rise, metres, to be `margin` above the ground as it shows it; 0 where it is high enough.
    static double rise(EffectScene& scene, const osg::Matrixd& view, const osg::Camera& camera,
                       double margin);

    /** Looks at the ground below one camera, for manipulators that keep it above the ground themselves. */
    class OSGGEOFX_EXPORT Watch
    {
    public:
        /// The camera's view matrix after a straight rise to `margin` above the ground, metres; empty if it is high enough, and
        /// where nothing has changed since the last look.
        std::optional<osg::Matrixd> risen(EffectScene& scene, const osg::Camera& camera, double margin);

    private:
        bool mustLook(EffectScene& scene, const osg::Camera& camera);

        // What there was at the last look.
        osg::Matrixd _view, _projection;
        std::uint64_t _effects = 0;
        double _time = -1.0; ///< seconds
    };

    void updateCamera(osg::Camera& camera) override;

    void setCoordinateFrameCallback(CoordinateFrameCallback* callback) override;
    void setByMatrix(const osg::Matrixd& matrix) override { _inner->setByMatrix(matrix); }
    void setByInverseMatrix(const osg::Matrixd& matrix) override { _inner->setByInverseMatrix(matrix); }
    osg::Matrixd getMatrix() const override { return _inner->getMatrix(); }
    osg::Matrixd getInverseMatrix() const override { return _inner->getInverseMatrix(); }
    osgUtil::SceneView::FusionDistanceMode getFusionDistanceMode() const override
    {
        return _inner->getFusionDistanceMode();
    }
    float getFusionDistanceValue() const override { return _inner->getFusionDistanceValue(); }
    void setNode(osg::Node* node) override { _inner->setNode(node); }
    const osg::Node* getNode() const override
    {
        return const_cast<const osgGA::CameraManipulator&>(*_inner).getNode();
    }
    osg::Node* getNode() override { return _inner->getNode(); }
    void setHomePosition(const osg::Vec3d& eye, const osg::Vec3d& center, const osg::Vec3d& up,
                         bool automatic) override;
    void getHomePosition(osg::Vec3d& eye, osg::Vec3d& center, osg::Vec3d& up) const override
    {
        _inner->getHomePosition(eye, center, up);
    }
    void setAutoComputeHomePosition(bool automatic) override;
    void computeHomePosition(const osg::Camera* camera, bool useBoundingBox) override
    {
        _inner->computeHomePosition(camera, useBoundingBox);
    }
    void finishAnimation() override { _inner->finishAnimation(); }
    void home(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override
    {
        _inner->home(event, action);
    }
    void home(double time) override { _inner->home(time); }
    void init(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override
    {
        _inner->init(event, action);
    }
    using osgGA::CameraManipulator::handle;
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override
    {
        return _inner->handle(event, action);
    }
    void getUsage(osg::ApplicationUsage& usage) const override { _inner->getUsage(usage); }

protected:
    ~AboveGround() override;

private:
    const osg::ref_ptr<EffectScene> _scene;
    const osg::ref_ptr<osgGA::CameraManipulator> _inner;
    double _margin = 2.0;
    bool _enabled = true;
    Watch _watch;
};

} // namespace osgGeoFX
