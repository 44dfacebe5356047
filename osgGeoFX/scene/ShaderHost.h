// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Referenced>
#include <osg/StateAttribute>
#include <osg/StateSet>
#include <osg/ref_ptr>

#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** GLSL texts of a scene's effects, for an engine that assembles its shaders itself. They have no `#version`.

    The texts are for GLSL 3.30 or later. Put each one behind the engine's own `#version` and `#extension` lines, into
    any shader of its stage, once. OSG sets the defines that they import (`#pragma import_defines`), so the programs must
    be osg::Program objects, or use these, as osgEarth's VirtualProgram does.

    An engine whose fragments have normals of their own, such as those of a texture, puts a line before each of the two
    texts: `#define GEOFX_HOST_NORMAL expression`. The expression of the fragment stage is a vec3 in the camera's eye
    space, before any effect; that of the vertex stage is not read.

    An engine that leaves tiles coarse where they are out of sight (isTileOutOfSight()) puts `#define GEOFX_HOST_COARSE_TILES` before the
    text of the vertex stage: panorama maps gather all ground far ahead in one point, and large triangles that lead there from beside the
    picture would cross it.

    Outside of a scene, and for cameras that see it undeformed, the functions change nothing.

    @ingroup scene */
struct ShaderTexts
{
    /** For the stage that places vertices:
        - `vec4 geofx_vertex(vec4 eyePosition)`: the deformed place in eye space. Call it once for each vertex.
        - `vec3 geofx_normal(vec4 eyePosition, vec3 eyeNormal)`: the normal to light with, of length 1. */
    std::string vertex;
    /** - `vec4 geofx_fragment(vec4 color, vec4 map)`: the color of the lit fragment. `map`: what a bend's context shows
          instead; vec4(0.0) for nothing.
        - `vec3 geofx_turnedNormal()`, with GEOFX_HOST_NORMAL: the normal of the deformed ground in the camera's eye space,
          to light with. */
    std::string fragment;
    /// The uniform blocks of the texts, and the binding points that the programs must give them.
    std::vector<std::pair<std::string, unsigned int>> blocks = {};
};

/** An engine that assembles its shaders itself, such as osgEarth with its VirtualProgram.

    Its programs are not copied, and not adapted. The engine says which they are. It has the scene's texts in one of two
    ways:
    - Its programs are complete ones. Then use() puts the texts into them. Passes that draw the scene again with
      functions of their own, such as those of close-ups, leave out what these programs draw.
    - Its programs add to those above them in the scene graph, as VirtualProgram does. Then addition() makes one with the
      texts alone, and the scene draws with it below the engine's own. So passes draw, too, unless they have a geometry
      stage.

    Threads: threads that cull call all functions, possibly several at once, for one scene or for several.

    @ingroup scene */
class OSGGEOFX_EXPORT ShaderHost : public osg::Referenced
{
public:
    /** Puts the texts of a scene's effects into the engine's programs, in place of the former ones. The scene calls it
        before it draws with effects that need other texts than the last ones; once for all cameras. Programs that are being
        drawn must not change, so the engine makes new ones. Switching effects on and off changes no texts. Does nothing by
        default. */
    virtual void use(const ShaderTexts& texts);
    /** A state that the scene draws below the engine's own: with a program that has these texts and calls their functions,
        protected from what is above it, and whatever else the engine needs while effects are drawn; a new one each
        time. The scene calls it once for its own texts and once for those of each pass, and keeps what it gets. Null,
        the default, if use() does all. */
    virtual osg::ref_ptr<osg::StateSet> addition(const ShaderTexts& texts);
    /// Whether the engine puts GEOFX_HOST_COARSE_TILES before the texts (ShaderTexts), so that tiles of which nothing is drawn then are
    /// culled. False by default.
    virtual bool leavesTilesCoarse() const { return false; }
    /// Whether a program has the texts and calls geofx_vertex(), by itself or by an addition(). The attribute is of type
    /// PROGRAM, of any class.
    virtual bool draws(const osg::StateAttribute& program) const = 0;

protected:
    ~ShaderHost() override;
};

} // namespace osgGeoFX
