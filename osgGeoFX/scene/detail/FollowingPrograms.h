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
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** What a scene draws with in the place of an application's own programs that have the kit's functions
    (EffectScene::addFunctions), or are to be adapted (EffectScene::adapt): copies with the functions of the scene's effects.

    The threads that draw may compile a program while the next frame is culled, so none that has been given out changes: where
    the effects change, or what the application has put into its program, there is a new copy. Copies share the application's
    shaders. Thread-safe. */
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
    struct Copy
    {
        osg::observer_ptr<const osg::StateAttribute> original;
        osg::ref_ptr<const osg::Program> functions;          ///< those that it has
        std::shared_ptr<const ProgramAdaptation> adaptation; ///< with which it was made
        osg::ref_ptr<osg::Program> program;
        osg::ref_ptr<osg::StateSet> state;
    };
    void purge();

    std::mutex _mutex;
    osg::ref_ptr<const osg::Program> _functions;
    /// By programs, and by passes; null for the scene's.
    std::map<std::pair<const osg::StateAttribute*, const osg::Program*>, Copy> _copies;
    std::vector<std::string> _complaints;
    std::vector<osg::observer_ptr<osg::Program>> _former; ///< frames that are on their way may hold them
};

} // namespace osgGeoFX
