// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/ArrayStorage.h>

#include <osg/GLExtensions>

namespace osgGeoFX
{

ArrayStorage::~ArrayStorage() = default;

void ArrayStorage::load(const osg::Texture2DArray& texture, osg::State& state) const
{
    constexpr GLenum target = GL_TEXTURE_2D_ARRAY_EXT;
    const auto* extensions = state.get<osg::GLExtensions>();
    state.unbindPixelBufferObject();
    extensions->glTexImage3D(target, 0, texture.getInternalFormat(), texture.getTextureWidth(),
                             texture.getTextureHeight(), texture.getTextureDepth(), 0, _format, _type,
                             nullptr);
    for (int layer = 0; layer < texture.getTextureDepth(); ++layer)
    {
        const osg::Image* image = texture.getImage(static_cast<unsigned int>(layer));
        if (!image) continue;
        glPixelStorei(GL_UNPACK_ALIGNMENT, static_cast<GLint>(image->getPacking()));
        glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(image->getRowLength()));
        extensions->glTexSubImage3D(target, 0, 0, 0, layer, image->s(), image->t(), 1,
                                    image->getPixelFormat(), image->getDataType(), image->data());
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    const osg::Texture::FilterMode filter = texture.getFilter(osg::Texture::MIN_FILTER);
    if (filter != osg::Texture::NEAREST && filter != osg::Texture::LINEAR)
        extensions->glGenerateMipmap(target);
}

} // namespace osgGeoFX
