// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Camera>
#include <osg/Matrixd>
#include <osg/Referenced>
#include <osg/observer_ptr>
#include <osgUtil/CullVisitor>

#include <optional>

namespace osgGeoFX
{

/** What a camera shows of an EffectScene. A value.

    - VIEW: the world as the effects deform it for this camera itself.
    - UNDEFORMED: the world without effects, as a plain osg::Group shows it. Shadow maps and overlays need it.
    - LIKE: the world as the effects deform it for another camera, seen from this one. The deformed shape is the same in
      both images, and so are levels of detail. Use it for the channels of a wall of screens, stereo, pickers, compositors'
      near and far cameras, the tiles of a print, and shadow maps of the deformed world.

    EffectScene finds a role for each camera that meets it; CameraEffects and a CameraRoleCallback decide otherwise.

    @ingroup scene */
class OSGGEOFX_EXPORT CameraRole
{
public:
    enum Kind
    {
        VIEW,
        UNDEFORMED,
        LIKE
    };

    static CameraRole view() { return CameraRole(VIEW); }
    static CameraRole undeformed() { return CameraRole(UNDEFORMED); }
    /// The view of another camera, by the matrices that it has when the scene is culled. Its view matrix leads from world
    /// coordinates, those of the scene's root. If it is deleted, the role becomes VIEW.
    static CameraRole like(const osg::Camera& camera);
    /// The view of a camera with these matrices, such as that of the whole picture whose tiles are drawn.
    static CameraRole like(const osg::Matrixd& viewMatrix, const osg::Matrixd& projectionMatrix);

    Kind getKind() const { return _kind; }
    /// For LIKE: the view and projection matrices of the other camera; false if there is none.
    bool getMatrices(osg::Matrixd& viewMatrix, osg::Matrixd& projectionMatrix) const;

private:
    explicit CameraRole(Kind kind) : _kind(kind) {}

    Kind _kind;
    bool _follows = false; ///< the camera's matrices, not those below
    osg::observer_ptr<const osg::Camera> _camera;
    osg::Matrixd _viewMatrix, _projectionMatrix;
};

/// Decides on the roles of cameras. The threads that cull call it, several at once.
/// @ingroup scene
class OSGGEOFX_EXPORT CameraRoleCallback : public osg::Referenced
{
public:
    /// The role of the camera that `visitor` culls for. `byDefault`: what the scene has found itself.
    virtual CameraRole role(const osg::Camera& camera, osgUtil::CullVisitor& visitor,
                            const CameraRole& byDefault) const = 0;

protected:
    ~CameraRoleCallback() override;
};

} // namespace osgGeoFX
