// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/CameraRole.h>

namespace osgGeoFX
{

CameraRoleCallback::~CameraRoleCallback() = default;

CameraRole CameraRole::like(const osg::Camera& camera)
{
    CameraRole role(LIKE);
    role._camera = &camera;
    role._follows = true;
    return role;
}

CameraRole CameraRole::like(const osg::Matrixd& viewMatrix, const osg::Matrixd& projectionMatrix)
{
    CameraRole role(LIKE);
    role._viewMatrix = viewMatrix;
    role._projectionMatrix = projectionMatrix;
    return role;
}

bool CameraRole::getMatrices(osg::Matrixd& viewMatrix, osg::Matrixd& projectionMatrix) const
{
    if (_kind != LIKE) return false;
    if (!_follows)
    {
        viewMatrix = _viewMatrix;
        projectionMatrix = _projectionMatrix;
        return true;
    }
    osg::ref_ptr<const osg::Camera> camera;
    if (!_camera.lock(camera)) return false;
    viewMatrix = camera->getViewMatrix();
    projectionMatrix = camera->getProjectionMatrix();
    return true;
}

} // namespace osgGeoFX
