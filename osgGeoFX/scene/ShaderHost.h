// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Referenced>
#include <osg/StateAttribute>

#include <string>

namespace osgGeoFX
{

/** GLSL texts of a scene's effects, for an engine that assembles its shaders itself. They have no `#version`.

    The texts are for GLSL 3.30 or later, in a compatibility context. Put each one behind the engine's own `#version` and
    `#extension` lines, into any shader of its stage, once. OSG sets the defines that they import
    (`#pragma import_defines`), so the programs must be osg::Program objects, or use these, as osgEarth's VirtualProgram
    does.

    Outside of a scene, and for cameras that see it undeformed, the functions change nothing.

    @ingroup scene */
struct ShaderTexts
{
    /** For the stage that places vertices:
        - `vec4 geofx_vertex(vec4 eyePosition)`: the deformed place in eye space. Call it once for each vertex.
        - `vec3 geofx_normal(vec4 eyePosition, vec3 eyeNormal)`: the normal to light with, of length 1. */
    std::string vertex;
    /// `vec4 geofx_fragment(vec4 color, vec4 map)`: the color of the lit fragment. `map`: what a bend's context shows instead;
    /// vec4(0.0) for nothing.
    std::string fragment;
};

/** An engine that assembles its shaders itself, such as osgEarth with its VirtualProgram.

    Its programs are not copied, and not adapted. The engine puts the scene's texts into them, and says which they are.
    Passes that draw the scene again with functions of their own, such as those of close-ups, leave out what these
    programs draw.

    Threads: threads that cull call both functions, possibly several at once, for one scene or for several.

    @ingroup scene */
class OSGGEOFX_EXPORT ShaderHost : public osg::Referenced
{
public:
    /** Puts the texts of a scene's effects into the engine's programs, in place of the former ones. The scene calls it
        before it draws with effects that need other texts than the last ones; once for all cameras. Programs that are being
        drawn must not change, so the engine makes new ones. Switching effects on and off changes no texts. */
    virtual void use(const ShaderTexts& texts) = 0;
    /// Whether a program has the texts and calls geofx_vertex(). The attribute is of type PROGRAM, of any class.
    virtual bool draws(const osg::StateAttribute& program) const = 0;

protected:
    ~ShaderHost() override;
};

} // namespace osgGeoFX
