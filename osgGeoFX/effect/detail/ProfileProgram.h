// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Program>
#include <osg/Shader>

#include <mutex>
#include <string>

namespace osgGeoFX
{

/** A program whose shaders are for the compatibility profile, and which draws in a core profile, too.

    Where OSG's state gives matrices as uniforms and arrays as generic vertex attributes, as a core profile needs it, another
    program draws in its place. It has the same shaders, of which those of the kit are translated by coreText(). It is
    made when it is first needed, so shaders must not be added or removed after a program has been drawn.

    If shaders of the program stand in for OpenGL's fixed functions, that program draws nothing, and one warning says so.

    Threads: like osg::Program. */
class ProfileProgram : public osg::Program
{
public:
    ProfileProgram();
    /// A program with the shaders of another one, and all else that it has.
    explicit ProfileProgram(const osg::Program& other);

    /// The program for core profiles; one that draws nothing if this one stands in for the fixed functions.
    osg::ref_ptr<osg::Program> core() const;

    void apply(osg::State& state) const override;
    void compileGLObjects(osg::State& state) const override;
    void setThreadSafeRefUnref(bool threadSafe) override;
    void resizeGLObjectBuffers(unsigned int maxSize) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

    /// Whether OSG's state is one for a core profile.
    static bool isCore(const osg::State& state);

    /// A shader of the kit, in the language of the compatibility profile.
    static osg::ref_ptr<osg::Shader> createShader(osg::Shader::Type stage, const std::string& text,
                                                  const std::string& name);
    /** The text of a shader of the kit for a core profile. It defines GEOFX_CORE. OSG itself replaces OpenGL's attributes and
        matrices in vertex shaders. This function replaces the matrices in other stages, and the color that fragments put
        out. gl_ClipVertex becomes a variable without effect: a core profile has no clip planes of that kind. Lines
        keep their numbers. */
    static std::string coreText(const std::string& text, osg::Shader::Type stage);

    /// Releases what all programs that live have in the context of a state, wherever they are: those of this class, and those that
    /// watch() was called for. Any thread may call it.
    static void releaseAll(osg::State& state);
    /// For a copy of a program of an application's own class.
    static void watch(osg::Program& program);

    /// Hold it while programs get shaders that others have, too: OSG's shaders know their programs.
    static std::mutex& sharing();

protected:
    ~ProfileProgram() override;

private:
    bool standsInForFixedFunctions() const;
    osg::ref_ptr<osg::Program> coreIfMade() const;

    mutable std::mutex _mutex;
    mutable osg::ref_ptr<osg::Program> _core;
};

} // namespace osgGeoFX
