// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/detail/AdaptedPrograms.h>

#include <osg/Program>
#include <osg/StateSet>
#include <osg/observer_ptr>

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** What a scene draws with in the place of an application's own programs that have the kit's functions
    (EffectScene::addFunctions), or are to be adapted (EffectScene::adapt): copies with the functions of the scene's effects.

    The threads that draw may compile a program while the next frame is culled, so none that has been given out changes: where
    the effects change, or what the application has put into its program, there is a new copy. Programs of OSG's own class that
    have equal texts and parameters share one copy, whatever they are called: a database may have a program for each tile. Such a
    copy has shaders of its own, so that it stays as it is when one of the programs changes. A copy of an application's own class
    shares the application's shaders. Thread-safe. */
class FollowingPrograms
{
public:
    /// Copies have the functions of this program, one of EffectProgram's, from now on.
    void follow(const osg::Program& functions);
    /// With which to draw what a program is in force for; never changes. Null where it is to be drawn with the program itself: it
    /// has no functions and is not adapted, or there are none to follow yet.
    /// `drawing`: with which the scene, or a pass, draws what has no program; null for the scene's.
    osg::ref_ptr<osg::StateSet> of(const osg::StateAttribute& program, const osg::Program* drawing = nullptr);
    /// Whether the copy of a program has the stand-in for the fixed vertex stage, which needs the defines of a look (LookCache).
    static bool hasFixedVertices(const osg::StateAttribute& program);
    /// Sentences on programs whose colors cannot be adapted, each once, where effects color.
    std::vector<std::string> takeComplaints(bool colors);
    /// Those that may have GL objects.
    std::vector<osg::ref_ptr<osg::Program>> programs();

private:
    using Text = std::pair<osg::Shader::Type, std::string>;
    struct Copy
    {
        osg::observer_ptr<const osg::Program> functions; ///< those that it has
        bool adapted = false;
        std::vector<Text> texts; ///< of the application's shaders; empty for an application's own class
        osg::ref_ptr<osg::Program> program;
        osg::ref_ptr<osg::StateSet> state;

        bool isOf(const osg::Program& original, const osg::Program& functions, bool adapted) const;
    };
    /// What is drawn for one program of the application.
    struct Use
    {
        osg::observer_ptr<const osg::StateAttribute> original;
        std::shared_ptr<const ProgramAdaptation> adaptation; ///< with which it was looked for
        std::shared_ptr<const Copy> copy;
    };
    std::shared_ptr<const Copy> copyFor(const osg::Program& original, const osg::Program& functions,
                                        const ProgramAdaptation* adaptation);
    void takeShaders(osg::Program& copy, const osg::Program& original);
    void complain(const osg::Program& program, const ProgramAdaptation& adaptation);
    void purge();

    std::mutex _mutex;
    osg::ref_ptr<const osg::Program> _functions;
    /// By programs, and by passes; null for the scene's.
    std::map<std::pair<const osg::StateAttribute*, const osg::Program*>, Use> _uses;
    std::size_t _purgeSize = 64;
    std::vector<std::weak_ptr<const Copy>> _shared;
    std::map<std::pair<Text, std::string>, osg::observer_ptr<osg::Shader>>
        _shaders; ///< by texts and names; copies share them
    std::vector<std::string> _complaints;
    std::set<std::size_t> _complained;                    ///< by OwnPrograms::numberOf()
    std::vector<osg::observer_ptr<osg::Program>> _former; ///< frames that are on their way may hold them
};

} // namespace osgGeoFX
