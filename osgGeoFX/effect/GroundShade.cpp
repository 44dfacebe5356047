// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/GroundShade.h>

#include <osg/BlendFunc>
#include <osg/Depth>
#include <osg/PolygonOffset>
#include <osg/Texture2D>

namespace osgGeoFX
{

namespace
{

/// After the ground and its strokes, before lines and names.
constexpr int shadeBin = 5;
/// The ground may be drawn more coarsely than the shade lies, by a pixel or so of the picture. This much nearer, in pixels of
/// the picture, is the shade drawn, at any angle. shaders/stages/fixed.frag has the same number.
constexpr float nearer = 4.0f;

} // namespace

osg::ref_ptr<osg::StateSet> GroundShade::createState()
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setDefine(define);
    // It lies on the ground and is none, and it bends as the ground does where things around it do not.
    for (const char* other : {"GEOFX_RIGID", "GEOFX_PAINTED", "GEOFX_DETAIL"})
        state->setDefine(other, osg::StateAttribute::OFF);
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
    state->setTextureMode(0, GL_TEXTURE_2D, osg::StateAttribute::OFF);
    // What is drawn takes its share, whatever color effects have given it.
    state->setAttributeAndModes(new osg::BlendFunc(GL_ZERO, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE));
    state->setAttributeAndModes(new osg::Depth(osg::Depth::LEQUAL, 0.0, 1.0, false));
    state->setAttributeAndModes(new osg::PolygonOffset(-nearer, -nearer));
    state->setRenderBinDetails(shadeBin, "RenderBin");
    return state;
}

osg::ref_ptr<osg::StateSet> GroundShade::createReversed()
{
    constexpr auto on =
        osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttributeAndModes(new osg::Depth(osg::Depth::GEQUAL, 0.0, 1.0, false), on);
    state->setAttributeAndModes(new osg::PolygonOffset(nearer, nearer), on);
    return state;
}

} // namespace osgGeoFX
