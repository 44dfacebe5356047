// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/TargetFormat.h>

#include <osg/FrameBufferObject>
#include <osg/Image>
#include <osg/Texture>
#include <osgUtil/RenderStage>

namespace osgGeoFX
{

namespace
{

// Those that OSG's headers lack.
constexpr GLenum r16f = 0x822D, r32f = 0x822E, rg16f = 0x822F, rg32f = 0x8230, r11fG11fB10f = 0x8C3A;
constexpr GLenum rgb16 = 0x8054, rgb10A2 = 0x8059, rgba12 = 0x805A, rgba16 = 0x805B;
constexpr GLenum srgb8 = 0x8C41, srgb8Alpha8 = 0x8C43;

/// The internal format of a camera's color buffer; 0 where it draws into its window's.
GLenum formatOf(const osg::Camera& camera)
{
    const osg::Camera::BufferAttachmentMap& all = camera.getBufferAttachmentMap();
    for (const osg::Camera::BufferComponent buffer : {osg::Camera::COLOR_BUFFER, osg::Camera::COLOR_BUFFER0})
    {
        const auto found = all.find(buffer);
        if (found == all.end()) continue;
        const osg::Camera::Attachment& attachment = found->second;
        if (attachment._texture) return static_cast<GLenum>(attachment._texture->getInternalFormat());
        const GLint ofImage = attachment._image ? attachment._image->getInternalTextureFormat() : 0;
        return ofImage ? static_cast<GLenum>(ofImage) : attachment._internalFormat;
    }
    return 0;
}

GLenum formatOf(const osg::FrameBufferObject& target)
{
    const auto& all = target.getAttachmentMap();
    for (const osg::Camera::BufferComponent buffer : {osg::Camera::COLOR_BUFFER, osg::Camera::COLOR_BUFFER0})
    {
        const auto found = all.find(buffer);
        if (found == all.end()) continue;
        if (const osg::Texture* texture = found->second.getTexture())
            return static_cast<GLenum>(texture->getInternalFormat());
        if (const osg::RenderBuffer* buffers = found->second.getRenderBuffer())
            return buffers->getInternalFormat();
    }
    return 0;
}

} // namespace

GLenum targetFormat(osgUtil::CullVisitor& visitor)
{
    const osgUtil::RenderStage* stage = visitor.getCurrentRenderBin()->getStage();
    GLenum format = stage->getCamera() ? formatOf(*stage->getCamera()) : 0;
    if (!format && stage->getFrameBufferObject()) format = formatOf(*stage->getFrameBufferObject());
    switch (format)
    {
    case r16f:
    case rg16f:
    case r11fG11fB10f:
    case GL_RGB16F_ARB:
    case GL_RGBA16F_ARB:
        return GL_RGBA16F_ARB;
    case r32f:
    case rg32f:
    case GL_RGB32F_ARB:
    case GL_RGBA32F_ARB:
        return GL_RGBA32F_ARB;
    case rgb16:
    case rgb10A2:
    case rgba12:
    case rgba16:
    // Colors are put through the curve when they get there, not before.
    case srgb8:
    case srgb8Alpha8:
        return rgba16;
    default:
        return GL_RGBA8;
    }
}

bool holdsBrightColors(GLenum format)
{
    return format == GL_RGBA16F_ARB || format == GL_RGBA32F_ARB;
}

} // namespace osgGeoFX
