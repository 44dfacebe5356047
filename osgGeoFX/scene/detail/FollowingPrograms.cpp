// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/FollowingPrograms.h>

#include <osgGeoFX/effect/detail/ProfileProgram.h>
#include <osgGeoFX/scene/detail/EffectProgram.h>
#include <osgGeoFX/scene/detail/OwnPrograms.h>

#include <algorithm>
#include <iterator>
#include <typeinfo>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Those of the application.
std::vector<const osg::Shader*> ownShaders(const osg::Program& program)
{
    std::vector<const osg::Shader*> own;
    for (unsigned int i = 0; i < program.getNumShaders(); ++i)
    {
        if (!EffectProgram::isFunctions(*program.getShader(i))) own.push_back(program.getShader(i));
    }
    return own;
}

std::vector<std::string> feedback(const osg::Program& program)
{
    std::vector<std::string> names;
    for (unsigned int i = 0; i < program.getNumTransformFeedBackVaryings(); ++i)
        names.push_back(program.getTransformFeedBackVarying(i));
    return names;
}

bool hasBlocksOf(const osg::Program& copy, const osg::Program& program)
{
    const osg::Program::UniformBlockBindingList& all = copy.getUniformBlockBindingList();
    const osg::Program::UniformBlockBindingList& wanted = program.getUniformBlockBindingList();
    return std::includes(all.begin(), all.end(), wanted.begin(), wanted.end());
}

/// Whether a copy still has what the application has put into its program. `adapted`: its shaders are known to be those.
bool isCopyOf(const osg::Program& copy, const osg::Program& program, const osg::Program& functions,
              bool adapted)
{
    for (const GLenum parameter :
         {GL_GEOMETRY_VERTICES_OUT_EXT, GL_GEOMETRY_INPUT_TYPE_EXT, GL_GEOMETRY_OUTPUT_TYPE_EXT})
    {
        if (copy.getParameter(parameter) != program.getParameter(parameter)) return false;
    }
    const osg::ShaderDefines& defines = copy.getShaderDefines();
    const osg::ShaderDefines& wanted = program.getShaderDefines();
    return (adapted || ownShaders(copy) == ownShaders(program)) && copy.getName() == program.getName() &&
           copy.getAttribBindingList() == program.getAttribBindingList() &&
           copy.getFragDataBindingList() == program.getFragDataBindingList() && hasBlocksOf(copy, program) &&
           hasBlocksOf(copy, functions) &&
           copy.getUniformBlockBindingList().size() ==
               program.getUniformBlockBindingList().size() + functions.getUniformBlockBindingList().size() &&
           copy.getTransformFeedBackMode() == program.getTransformFeedBackMode() &&
           feedback(copy) == feedback(program) &&
           std::includes(defines.begin(), defines.end(), wanted.begin(), wanted.end());
}

osg::ref_ptr<osg::Program> copyOf(const osg::Program& program, const osg::Program& functions,
                                  const ProgramAdaptation* adaptation)
{
    // A class of the application's may hold more. Its copies draw in the compatibility profile alone.
    const bool ordinary =
        typeid(program) == typeid(osg::Program) || dynamic_cast<const ProfileProgram*>(&program);
    osg::ref_ptr<osg::Program> copy =
        ordinary ? new ProfileProgram(program) : osg::clone(&program, osg::CopyOp::SHALLOW_COPY);
    for (unsigned int i = copy->getNumShaders(); i-- > 0;)
    {
        if (EffectProgram::isFunctions(*copy->getShader(i))) copy->removeShader(copy->getShader(i));
    }
    if (adaptation) adaptation->apply(*copy);
    // They are the same for all, and compiled once.
    EffectProgram::addFunctionsOf(functions, *copy);
    // What OSG's own copy leaves out.
    for (const osg::Program* each : {&functions, &program})
    {
        for (const auto& [name, binding] : each->getUniformBlockBindingList())
            copy->addBindUniformBlock(name, binding);
    }
    const osg::ShaderDefines& defines = program.getShaderDefines();
    copy->getShaderDefines().insert(defines.begin(), defines.end());
    return copy;
}

} // namespace

void FollowingPrograms::follow(const osg::Program& functions)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _functions = &functions;
}

osg::ref_ptr<osg::StateSet> FollowingPrograms::of(const osg::StateAttribute& program,
                                                  const osg::Program* drawing)
{
    const auto* original = dynamic_cast<const osg::Program*>(&program);
    if (!original) return nullptr;
    std::shared_ptr<const ProgramAdaptation> adaptation = AdaptedPrograms::instance().of(*original);
    if (adaptation && !adaptation->refusal().empty()) adaptation = nullptr;
    if (!adaptation && !EffectProgram::hasFunctions(*original)) return nullptr;
    const std::lock_guard<std::mutex> lock(_mutex);
    // A pass that needs stages of its own, for which the application's program has no place, draws it as the scene does.
    const bool inPass = drawing && EffectProgram::isPassOfTwoStages(*drawing);
    if (!inPass && !_functions) return nullptr;
    const osg::Program& functions = inPass ? *drawing : *_functions;
    Copy& copy = _copies[{&program, inPass ? drawing : nullptr}];
    if (copy.original.valid() && copy.functions.get() == &functions && copy.adaptation == adaptation &&
        isCopyOf(*copy.program, *original, functions, adaptation != nullptr))
        return copy.state;
    if (copy.program) _former.emplace_back(copy.program);
    copy.original = &program;
    copy.functions = &functions;
    copy.adaptation = adaptation;
    {
        // Scenes share shaders.
        const std::lock_guard<std::mutex> sharing(ProfileProgram::sharing());
        copy.program = copyOf(*original, functions, adaptation.get());
    }
    if (adaptation && !adaptation->colorRefusal().empty())
    {
        std::string sentence = OwnPrograms::describe(program, {}) + " is adapted, but keeps its colors: ";
        sentence += adaptation->colorRefusal() + ". Let its fragment shader call geofx_fragment().";
        if (std::find(_complaints.begin(), _complaints.end(), sentence) == _complaints.end())
            _complaints.push_back(sentence);
    }
    copy.state = new osg::StateSet;
    // Whatever put the program into force.
    copy.state->setAttributeAndModes(copy.program, osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE |
                                                       osg::StateAttribute::PROTECTED);
    const osg::ref_ptr<osg::StateSet> state = copy.state;
    purge();
    return state;
}

bool FollowingPrograms::hasFixedVertices(const osg::StateAttribute& program)
{
    const auto* original = dynamic_cast<const osg::Program*>(&program);
    const auto adaptation = original ? AdaptedPrograms::instance().of(*original) : nullptr;
    return adaptation && adaptation->hasFixedVertices();
}

void FollowingPrograms::purge()
{
    for (auto each = _copies.begin(); each != _copies.end();)
    {
        const bool lives = each->second.original.valid() && each->second.functions.valid();
        if (!lives) _former.emplace_back(each->second.program);
        each = lives ? std::next(each) : _copies.erase(each);
    }
    const auto gone = [](const osg::observer_ptr<osg::Program>& each)
    {
        return !each.valid();
    };
    _former.erase(std::remove_if(_former.begin(), _former.end(), gone), _former.end());
}

std::vector<std::string> FollowingPrograms::takeComplaints(bool colors)
{
    if (!colors) return {};
    const std::lock_guard<std::mutex> lock(_mutex);
    return std::exchange(_complaints, {});
}

std::vector<osg::ref_ptr<osg::Program>> FollowingPrograms::programs()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    std::vector<osg::ref_ptr<osg::Program>> all;
    for (const auto& [original, copy] : _copies)
        all.push_back(copy.program);
    for (const osg::observer_ptr<osg::Program>& each : _former)
    {
        osg::ref_ptr<osg::Program> former;
        if (each.lock(former)) all.push_back(former);
    }
    return all;
}

} // namespace osgGeoFX
