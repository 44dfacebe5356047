// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Program>
#include <osg/Shader>
#include <osg/observer_ptr>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/// How an application's fragments come to their depths.
enum class FragmentDepth
{
    OF_PLACE,    ///< the fragment's own, or made of it
    LOGARITHMIC, ///< of a variable
    PROJECTED,   ///< of a place beside the fragment's
    UNKNOWN
};

/** What is to be done to a copy of an application's program for its vertices to go where a scene's effects move them, and for its
    colors to be those that they make. It is the same for all effects: their functions come on top. Never changes.

    The text of a shader that has a `main` stays as it is, under another name for `main`; ours calls it, and then looks at what it has
    written (shaders/stages/adapted.glsl). */
class ProgramAdaptation
{
public:
    explicit ProgramAdaptation(const osg::Program& program);

    /// Whether it was made for what the program has now.
    bool isOf(const osg::Program& program) const;
    /// Why the program is drawn where it is, as the end of a sentence; empty where it can be adapted.
    const std::string& refusal() const { return _refusal; }
    /// Why its colors stay as they are, although its vertices move; empty where there is nothing to tell.
    const std::string& colorRefusal() const { return _colorRefusal; }
    /// Whether it has a fragment stage alone. A copy then has the kit's stand-in for the fixed vertex stage, whose defines
    /// a FixedFunctionLook sets.
    bool hasFixedVertices() const { return _fixedVertices; }
    /// Puts a copy of the program right.
    void apply(osg::Program& copy) const;

private:
    struct Stage;
    struct Color;
    void adapt(const osg::Program& program);
    void adaptFragments(const osg::Program& program, const Stage& fragment);
    void adaptPlaces(const Stage& last);
    void adaptEmissions(const Stage& geometry);
    void adaptColors(const osg::Program& program, const Stage& fragment, FragmentDepth depth);
    void addMain(const Stage& last, const std::string& main, FragmentDepth depth);
    void refuse(const std::string& reason) { _refusal = reason; }

    // Texts, and no shaders: those have objects of OpenGL, which go with the copies.
    using Text = std::pair<const osg::Shader*, std::string>;
    std::vector<Text> _sources;                                  ///< those that it was made for
    std::vector<std::pair<std::string, unsigned int>> _bindings; ///< of the fragments' outputs
    std::vector<Text> _replaced;                                 ///< by their former shaders
    osg::Shader::Type _lastStage = osg::Shader::UNDEFINED;       ///< that places vertices
    std::string _main;                                           ///< what it gets more
    bool _fixedVertices = false;
    std::string _refusal, _colorRefusal;
};

/** Which programs scenes draw as adapted (EffectScene::adapt): those of the whole process, since scenes share them. The programs
    themselves are left as they are: threads may be drawing with them. Thread-safe. */
class AdaptedPrograms
{
public:
    static AdaptedPrograms& instance();

    void add(const osg::Program& program);
    /// Null for one that was not added.
    std::shared_ptr<const ProgramAdaptation> of(const osg::Program& program);

private:
    struct Known
    {
        osg::observer_ptr<const osg::Program> program;
        std::shared_ptr<const ProgramAdaptation> adaptation;
    };
    std::mutex _mutex;
    std::map<const osg::Program*, Known> _known;
    std::size_t _purgeSize = 64;
};

} // namespace osgGeoFX
