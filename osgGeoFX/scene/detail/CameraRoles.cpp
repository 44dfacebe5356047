// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/CameraRoles.h>

#include <osg/Transform>
#include <osg/View>
#include <osgUtil/RenderStage>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

/// Whose image a slave with relative matrices shows a part of; null for other cameras.
const osg::Camera* masterOf(const osg::Camera& camera)
{
    const osg::View* view = camera.getView();
    const osg::Camera* master = view ? view->getCamera() : nullptr;
    if (!master || master == &camera || camera.getReferenceFrame() != osg::Transform::RELATIVE_RF)
        return nullptr;
    return master;
}

/// osgEarth's name for cameras that draw what is under the pointer.
bool picks(const osg::Camera& camera)
{
    const osg::StateSet* state = camera.getStateSet();
    const osg::StateSet::DefinePair* define = state ? state->getDefinePair("OE_IS_PICK_CAMERA") : nullptr;
    return define && (define->second & osg::StateAttribute::ON);
}

/// The modelview matrix where the visitor is, if it had begun with another view matrix.
osg::Matrixd modelViewFrom(const osg::Matrixd& viewMatrix, osgUtil::CullVisitor& visitor)
{
    const osg::NodePath& path = visitor.getNodePath();
    // Below a camera with matrices of its own all begins anew.
    auto first = path.end();
    while (first != path.begin())
    {
        const osg::Camera* camera = (*(first - 1))->asCamera();
        if (camera && camera->getReferenceFrame() != osg::Transform::RELATIVE_RF) break;
        --first;
    }
    // In the order in which the visitor has multiplied, so that the same matrices give the same result to the last bit.
    osg::Matrixd matrix = viewMatrix;
    for (; first != path.end(); ++first)
    {
        const osg::Transform* transform = (*first)->asTransform();
        if (transform && !transform->asCamera()) transform->computeLocalToWorldMatrix(matrix, &visitor);
    }
    return matrix;
}

} // namespace

bool isNested(osgUtil::CullVisitor& visitor)
{
    const osg::NodePath& path = visitor.getNodePath();
    return visitor.getCurrentCamera() != visitor.getRenderStage()->getCamera() ||
           std::any_of(path.begin(), path.end(), [](osg::Node* node) { return node->asCamera() != nullptr; });
}

const osg::Camera* leaderOf(osgUtil::CullVisitor& visitor)
{
    const osg::Camera* camera = visitor.getCurrentCamera();
    if (!camera || isNested(visitor)) return nullptr;
    const osg::View* view = camera->getView();
    return !view || view->getCamera() == camera ? camera : masterOf(*camera);
}

CameraRole defaultRole(osgUtil::CullVisitor& visitor)
{
    const osg::Camera* own = visitor.getRenderStage()->getCamera();
    const bool nested = isNested(visitor);
    if (nested && !picks(*visitor.getCurrentCamera())) return CameraRole::undeformed();
    const osg::Camera* master = own ? masterOf(*own) : nullptr;
    if (master) return CameraRole::like(*master);
    return nested && own ? CameraRole::like(*own) : CameraRole::view();
}

ViewGeometry viewOf(osgUtil::CullVisitor& visitor, const CameraRole& role, const Ground& ground)
{
    const osg::Matrixd& modelView = *visitor.getModelViewMatrix();
    const osg::Matrixd& projection = *visitor.getProjectionMatrix();
    osg::Matrixd viewMatrix, viewProjection;
    if (!role.getMatrices(viewMatrix, viewProjection))
    {
        if (isNested(visitor)) return ViewGeometry(modelView, projection, ground);
        viewMatrix = visitor.getCurrentCamera()->getViewMatrix();
        viewProjection = visitor.getCurrentCamera()->getProjectionMatrix();
    }
    ViewGeometry view(modelViewFrom(viewMatrix, visitor), viewProjection, ground);
    if (view.modelView != modelView || view.projection != projection) view.setImage(modelView, projection);
    return view;
}

} // namespace osgGeoFX
