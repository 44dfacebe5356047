// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Camera>
#include <osg/Image>

namespace geofx::test
{

/// A frame buffer object that a camera draws into, in the place of its window. After each frame `image` has the colors.
struct FrameBufferTarget
{
    osg::ref_ptr<osg::Image> image = new osg::Image;

    FrameBufferTarget(osg::Camera& camera, GLenum color, GLenum depth)
    {
        const osg::Viewport& port = *camera.getViewport();
        image->allocateImage(static_cast<int>(port.width()), static_cast<int>(port.height()), 1, GL_RGBA,
                             GL_FLOAT);
        image->setInternalTextureFormat(static_cast<GLint>(color));
        camera.setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT, osg::Camera::FRAME_BUFFER);
        camera.attach(osg::Camera::COLOR_BUFFER, image);
        camera.attach(osg::Camera::DEPTH_BUFFER, depth);
    }

    osg::Vec3d colorAt(int x, int y) const
    {
        const osg::Vec4 color = image->getColor(x, y);
        return {static_cast<double>(color.r()), static_cast<double>(color.g()),
                static_cast<double>(color.b())};
    }
};

} // namespace geofx::test
