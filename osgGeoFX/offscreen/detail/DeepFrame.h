// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/FrameBufferObject>
#include <osg/GraphicsContext>
#include <osg/OperationThread>

namespace osgGeoFX
{

/// Gives a context a frame buffer with 16 bits for each channel, which takes the place of the one that it was made with. EGL and GLX offer
/// no such one. It is an operation for realizing a viewer; cameras that draw into "the context's own frame buffer" then draw into it.
class DeepFrame : public osg::Operation
{
public:
    static constexpr GLenum colorFormat = 0x805B; ///< GL_RGBA16, which OSG's headers lack

    DeepFrame(int width, int height, unsigned int samples);

    /// `context`: an osg::GraphicsContext, which is current.
    void operator()(osg::Object* context) override;
    /// Whether it has given the context its frame buffer.
    bool isThere() const { return _there; }

protected:
    ~DeepFrame() override = default;

private:
    const int _width, _height;
    const unsigned int _samples;
    bool _there = false;
};

} // namespace osgGeoFX
