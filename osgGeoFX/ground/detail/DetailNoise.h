// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>
#include <osg/Matrixd>
#include <osg/Texture2D>
#include <osg/Texture3D>

#include <mutex>

namespace osgGeoFX
{

/** The waves that GroundDetail has on the ground: a periodic noise in space, with waves of about an eighth of its period in all
    directions. It lies in the world and is cut by the ground. So there is no seam on a globe, and no cliff on which it is stretched. */
class DetailNoise
{
public:
    static constexpr int side = 64; ///< texels of a period

    /// The noise: its gradient as red, green and blue, its height as alpha, each coded as 128 + 127 x.
    static osg::ref_ptr<osg::Image> makeImage();
    /// The matrix from the world, metres, to the noise's periods, for an octave of waves that long.
    static osg::Matrixd octave(int index, double wavelength);

    /// The textures for all cameras. Any thread may ask.
    osg::ref_ptr<osg::Texture3D> texture();
    /// One texel that says that nothing is known of the ground (shaders/lib/cover.glsl).
    osg::ref_ptr<osg::Texture2D> noCover();

    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    mutable std::mutex _mutex;
    osg::ref_ptr<osg::Texture3D> _texture;
    osg::ref_ptr<osg::Texture2D> _noCover;
};

} // namespace osgGeoFX
