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

/// Whether a program is nothing more than what OSG's own class holds.
bool isOrdinary(const osg::Program& program)
{
    return typeid(program) == typeid(osg::Program) || dynamic_cast<const ProfileProgram*>(&program);
}

/// Without the functions.
osg::ref_ptr<osg::Program> copyOf(const osg::Program& program, const ProgramAdaptation* adaptation)
{
    // A class of the application's may hold more. Its copies draw in the compatibility profile alone.
    osg::ref_ptr<osg::Program> copy;
    if (isOrdinary(program))
        copy = new ProfileProgram(program);
    else
    {
        copy = osg::clone(&program, osg::CopyOp::SHALLOW_COPY);
        ProfileProgram::watch(*copy);
    }
    for (unsigned int i = copy->getNumShaders(); i-- > 0;)
    {
        if (EffectProgram::isFunctions(*copy->getShader(i))) copy->removeShader(copy->getShader(i));
    }
    if (adaptation) adaptation->apply(*copy);
    return copy;
}

void addFunctions(const osg::Program& program, const osg::Program& functions, osg::Program& copy)
{
    // They are the same for all, and compiled once.
    EffectProgram::addFunctionsOf(functions, copy);
    // What OSG's own copy leaves out.
    for (const osg::Program* each : {&functions, &program})
    {
        for (const auto& [name, binding] : each->getUniformBlockBindingList())
            copy.addBindUniformBlock(name, binding);
    }
    const osg::ShaderDefines& defines = program.getShaderDefines();
    copy.getShaderDefines().insert(defines.begin(), defines.end());
}

} // namespace

/// Whether it still has what the application has put into its program.
bool FollowingPrograms::Copy::isOf(const osg::Program& original, const osg::Program& wanted,
                                   bool adapts) const
{
    // Others may come to the address of former ones.
    if (functions.get() != &wanted || adapted != adapts) return false;
    for (const GLenum parameter :
         {GL_GEOMETRY_VERTICES_OUT_EXT, GL_GEOMETRY_INPUT_TYPE_EXT, GL_GEOMETRY_OUTPUT_TYPE_EXT})
    {
        if (program->getParameter(parameter) != original.getParameter(parameter)) return false;
    }
    const std::vector<const osg::Shader*> own = ownShaders(original);
    const bool sameShaders = isOrdinary(original)
                                 ? std::equal(own.begin(), own.end(), texts.begin(), texts.end(),
                                              [](const osg::Shader* shader, const Text& text) {
                                                  return shader->getType() == text.first &&
                                                         shader->getShaderSource() == text.second;
                                              })
                                 : adapts || ownShaders(*program) == own;
    const osg::ShaderDefines& defines = program->getShaderDefines();
    const osg::ShaderDefines& needed = original.getShaderDefines();
    return sameShaders && program->getAttribBindingList() == original.getAttribBindingList() &&
           program->getFragDataBindingList() == original.getFragDataBindingList() &&
           hasBlocksOf(*program, original) && hasBlocksOf(*program, wanted) &&
           program->getUniformBlockBindingList().size() ==
               original.getUniformBlockBindingList().size() + wanted.getUniformBlockBindingList().size() &&
           program->getTransformFeedBackMode() == original.getTransformFeedBackMode() &&
           feedback(*program) == feedback(original) &&
           std::includes(defines.begin(), defines.end(), needed.begin(), needed.end());
}

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
    Use& use = _uses[{&program, inPass ? drawing : nullptr}];
    // An application's own class is copied anew with each adaptation.
    const bool known = use.copy && use.original.valid() &&
                       (use.adaptation == adaptation || isOrdinary(*original)) &&
                       use.copy->isOf(*original, functions, adaptation != nullptr);
    use.adaptation = adaptation;
    if (known) return use.copy->state;
    use.original = &program;
    use.copy = copyFor(*original, functions, adaptation.get());
    if (adaptation) complain(*original, *adaptation);
    const osg::ref_ptr<osg::StateSet> state = use.copy->state;
    if (_uses.size() > _purgeSize || use.copy.use_count() == 1) purge();
    return state;
}

std::shared_ptr<const FollowingPrograms::Copy> FollowingPrograms::copyFor(const osg::Program& original,
                                                                          const osg::Program& functions,
                                                                          const ProgramAdaptation* adaptation)
{
    const bool ordinary = isOrdinary(original);
    for (const std::weak_ptr<const Copy>& each : _shared)
    {
        const std::shared_ptr<const Copy> copy = ordinary ? each.lock() : nullptr;
        if (copy && copy->isOf(original, functions, adaptation != nullptr)) return copy;
    }
    const auto copy = std::make_shared<Copy>();
    copy->functions = &functions;
    copy->adapted = adaptation != nullptr;
    for (const osg::Shader* shader : ownShaders(original))
    {
        if (ordinary) copy->texts.emplace_back(shader->getType(), shader->getShaderSource());
    }
    {
        // Scenes share shaders.
        const std::lock_guard<std::mutex> sharing(ProfileProgram::sharing());
        copy->program = copyOf(original, adaptation);
        if (ordinary) takeShaders(*copy->program, original);
        addFunctions(original, functions, *copy->program);
    }
    copy->state = new osg::StateSet;
    // Whatever put the program into force.
    copy->state->setAttributeAndModes(copy->program, osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE |
                                                         osg::StateAttribute::PROTECTED);
    _former.emplace_back(copy->program);
    if (ordinary) _shared.push_back(copy);
    return copy;
}

/// Puts shaders of ours into the places of the application's. Copies share those with equal texts, so that each is compiled once.
void FollowingPrograms::takeShaders(osg::Program& copy, const osg::Program& original)
{
    const std::vector<const osg::Shader*> foreign = ownShaders(original);
    std::vector<osg::ref_ptr<osg::Shader>> all;
    for (unsigned int i = 0; i < copy.getNumShaders(); ++i)
        all.emplace_back(copy.getShader(i));
    for (const osg::ref_ptr<osg::Shader>& each : all)
        copy.removeShader(each);
    for (const osg::ref_ptr<osg::Shader>& each : all)
    {
        osg::observer_ptr<osg::Shader>& known =
            _shaders[{{each->getType(), each->getShaderSource()}, each->getName()}];
        osg::ref_ptr<osg::Shader> shader;
        const bool shares = known.lock(shader) && shader->getShaderDefines() == each->getShaderDefines() &&
                            shader->getShaderRequirements() == each->getShaderRequirements() &&
                            !each->getShaderBinary();
        if (!shares)
        {
            const bool isForeign = std::find(foreign.begin(), foreign.end(), each.get()) != foreign.end();
            shader = isForeign ? osg::clone(each.get(), osg::CopyOp::SHALLOW_COPY) : each.get();
            shader->getShaderDefines() = each->getShaderDefines();
            shader->getShaderRequirements() = each->getShaderRequirements();
            known = shader;
        }
        copy.addShader(shader);
    }
}

/// Once for all programs with equal texts.
void FollowingPrograms::complain(const osg::Program& program, const ProgramAdaptation& adaptation)
{
    if (adaptation.colorRefusal().empty() || !_complained.insert(OwnPrograms::numberOf(program)).second)
        return;
    _complaints.push_back(OwnPrograms::describe(program, {}) + " is adapted, but keeps its colors: " +
                          adaptation.colorRefusal() + ". Let its fragment shader call geofx_fragment().");
}

bool FollowingPrograms::hasFixedVertices(const osg::StateAttribute& program)
{
    const auto* original = dynamic_cast<const osg::Program*>(&program);
    const auto adaptation = original ? AdaptedPrograms::instance().of(*original) : nullptr;
    return adaptation && adaptation->hasFixedVertices();
}

void FollowingPrograms::purge()
{
    for (auto each = _uses.begin(); each != _uses.end();)
    {
        const bool lives = each->second.original.valid() && each->second.copy->functions.valid();
        each = lives ? std::next(each) : _uses.erase(each);
    }
    _purgeSize = 2 * _uses.size() + 64;
    const auto gone = [](const auto& each)
    {
        return !each.valid();
    };
    _former.erase(std::remove_if(_former.begin(), _former.end(), gone), _former.end());
    _shared.erase(
        std::remove_if(_shared.begin(), _shared.end(), [](const auto& each) { return each.expired(); }),
        _shared.end());
    for (auto each = _shaders.begin(); each != _shaders.end();)
        each = each->second.valid() ? std::next(each) : _shaders.erase(each);
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
    for (const osg::observer_ptr<osg::Program>& each : _former)
    {
        osg::ref_ptr<osg::Program> former;
        if (each.lock(former)) all.push_back(former);
    }
    return all;
}

} // namespace osgGeoFX
