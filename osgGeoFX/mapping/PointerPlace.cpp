// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/PointerPlace.h>

#include <osgGeoFX/scene/DeformedView.h>

namespace osgGeoFX
{

std::optional<osg::Vec3d> placeUnderPointer(EffectScene& scene, const ProjectiveMappings& mappings,
                                            const osg::Camera& camera, const osgGA::GUIEventAdapter& event)
{
    const osg::Viewport* port = camera.getViewport();
    if (!port) return std::nullopt;
    const DeformedView picture(scene, camera);
    const auto hit = picture.pick(static_cast<double>(event.getX()) - port->x(),
                                  static_cast<double>(event.getY()) - port->y());
    if (!hit) return std::nullopt;
    return mappings.placeOf(hit->world, scene.ground().ellipsoid);
}

} // namespace osgGeoFX
