// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/effect/PassEffect.h>

#include <osg/Program>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** The shaders of a scene's effects, put together.

    Effect i of the scene has the prefix geofx_<i>_ and the defines GEOFX_EFFECT_<i>, which is set where it deforms, and
    GEOFX_SURFACE_<i>, where it colors, so that switching effects changes defines and nothing else. */
class EffectProgram
{
public:
    using Effects = std::vector<osg::ref_ptr<Effect>>;

    static std::string prefix(std::size_t effect);
    static std::string define(std::size_t effect);
    static std::string surfaceDefine(std::size_t effect);

    /// Changes where the shaders' text does.
    static std::string key(const Effects& effects);
    /// The text of a function shader, of the vertex, tessellation evaluation, geometry or fragment stage; ShaderError as
    /// ShaderLibrary has it.
    static std::string functions(const Effects& effects, osg::Shader::Type stage);
    /// The same without `#version`, for the vertex and the fragment stage.
    static std::string hostText(const Effects& effects, osg::Shader::Type stage);
    /// The same with what the effect of that prefix draws a pass with, if the pass has these two stages alone.
    static std::string hostText(const Effects& effects, const PassShaders& pass, const std::string& prefix,
                                osg::Shader::Type stage);
    /// Adds the functions of effects to the stages of a program that have none yet; ShaderError.
    static void addFunctions(osg::Program& program, const Effects& effects);
    /// Adds functions that do nothing, as a program of the application has them where no scene draws it. They name nothing of a
    /// profile, so any context compiles them; ShaderError.
    static void addIdleFunctions(osg::Program& program);
    /// Those that another program has.
    static void addFunctionsOf(const osg::Program& like, osg::Program& program);
    /// Whether a shader is one of those that addFunctions() adds; create() has such, too.
    static bool isFunctions(const osg::Shader& shader);
    static bool hasFunctions(const osg::Program& program);
    /// Whether it is one that create() has made for a pass that has no stages between vertices and fragments.
    static bool isPassOfTwoStages(const osg::Program& program);
    /// A program for geometry that has none. A new one each time, since one that is in use must not change. Null, after a
    /// warning, where a shader file is missing.
    static osg::ref_ptr<osg::Program> create(const Effects& effects);
    /// The same for patches of triangles, which it divides where a Tessellator asks for it. It needs OpenGL 4.
    static osg::ref_ptr<osg::Program> createTessellating(const Effects& effects);

    /// The same with what the effect of that prefix draws a pass with; the text of a `stage` that the pass has
    /// not is empty.
    static std::string passFunctions(const Effects& effects, const PassShaders& pass,
                                     const std::string& prefix, osg::Shader::Type stage);
    static osg::ref_ptr<osg::Program> create(const Effects& effects, const PassShaders& pass,
                                             const std::string& prefix);

private:
    /// Those of a program's stages that have no functions yet.
    static std::vector<osg::Shader::Type> missingStages(const osg::Program& program);
};

} // namespace osgGeoFX
