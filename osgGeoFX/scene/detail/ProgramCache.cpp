// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/ProgramCache.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

std::string keyOf(const PassShaders& shaders, const std::string& prefix)
{
    std::string key = prefix + shaders.vertexMain + ';' + shaders.fragmentMain + ';';
    for (const auto* files : {&shaders.vertex, &shaders.tessellationControl, &shaders.tessellationEvaluation,
                              &shaders.geometry, &shaders.fragment})
    {
        for (const std::string& file : *files)
            key += file + ';';
        key += '|';
    }
    for (const auto& [name, binding] : shaders.blocks)
        key += name + std::to_string(binding) + ';';
    if (shaders.within) key += " in " + keyOf(*shaders.within, shaders.withinPrefix);
    return key;
}

} // namespace

osg::ref_ptr<osg::Program> ProgramCache::programOf(const Effects& effects)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const bool other = changed(effects);
    if (_made && !other) return _program;
    const std::string key = EffectProgram::key(effects);
    if (_made && key == _key) return _program;
    _key = key;
    _made = true;
    retire(_program);
    _program = EffectProgram::create(effects);
    // If the program cannot be made, the application's programs keep the last functions that worked. The next change
    // tries again.
    if (_program)
        _following.follow(*_program);
    else
        _key.clear();
    return _program;
}

osg::ref_ptr<osg::Program> ProgramCache::tessellatingProgramOf(const Effects& effects)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    // Without a key a shader file is missing.
    if (_key.empty() || _key == _tessellatingKey) return _tessellating;
    _tessellatingKey = _key;
    retire(_tessellating);
    _tessellating = EffectProgram::createTessellating(effects);
    return _tessellating;
}

osg::ref_ptr<osg::StateSet> ProgramCache::tell(ShaderHost& host, const Effects& effects)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    // Without a key a shader file is missing, and the host keeps the last texts that worked.
    if (_key.empty() || (_host == &host && _toldKey == _key)) return _addition;
    const ShaderTexts texts = {EffectProgram::hostText(effects, osg::Shader::VERTEX),
                               EffectProgram::hostText(effects, osg::Shader::FRAGMENT)};
    host.use(texts);
    _addition = host.addition(texts);
    _host = &host;
    _toldKey = _key;
    return _addition;
}

osg::ref_ptr<osg::StateSet> ProgramCache::additionOf(ShaderHost& host, const Effects& effects,
                                                     const osg::Program* program)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (!program) return nullptr;
    if (program == _program) return _host == &host ? _addition : nullptr;
    const auto found = std::find_if(_passes.begin(), _passes.end(),
                                    [program](const auto& entry) { return entry.second.program == program; });
    if (found == _passes.end()) return nullptr;
    PassProgram& pass = found->second;
    if (pass.host == &host) return pass.addition;
    pass.host = &host;
    pass.addition = nullptr;
    if (EffectProgram::isPassOfTwoStages(*program) && pass.shaders.vertexMain.empty() &&
        pass.shaders.fragmentMain.empty() && !pass.shaders.within)
    {
        ShaderTexts texts = {
            EffectProgram::hostText(effects, pass.shaders, pass.prefix, osg::Shader::VERTEX),
            EffectProgram::hostText(effects, pass.shaders, pass.prefix, osg::Shader::FRAGMENT)};
        for (const auto& [name, binding] : pass.shaders.blocks)
            texts.blocks.emplace_back(pass.prefix + name, binding);
        pass.addition = host.addition(texts);
    }
    return pass.addition;
}

osg::ref_ptr<osg::Program> ProgramCache::passProgramOf(const Effects& effects, const PassShaders& shaders,
                                                       const std::string& prefix)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    PassProgram& found = _passes[keyOf(shaders, prefix)];
    const std::string key = EffectProgram::key(effects);
    if (!found.made || found.effects != key)
    {
        retire(found.program);
        found = {true, key, EffectProgram::create(effects, shaders, prefix), shaders, prefix};
    }
    return found.program;
}

void ProgramCache::dirty()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _revisions.clear();
}

void ProgramCache::forgetEffects()
{
    // Let go of when the lock is.
    Effects former;
    const std::lock_guard<std::mutex> lock(_mutex);
    _revisions.clear();
    former.swap(_effects);
}

void ProgramCache::retire(const osg::ref_ptr<osg::Program>& former)
{
    const auto gone = [](const osg::observer_ptr<osg::Program>& each)
    {
        return !each.valid();
    };
    _retired.erase(std::remove_if(_retired.begin(), _retired.end(), gone), _retired.end());
    if (former) _retired.emplace_back(former);
}

std::vector<osg::ref_ptr<osg::Program>> ProgramCache::all()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    std::vector<osg::ref_ptr<osg::Program>> programs = _following.programs();
    if (_program) programs.push_back(_program);
    if (_tessellating) programs.push_back(_tessellating);
    for (const auto& [key, pass] : _passes)
    {
        if (pass.program) programs.push_back(pass.program);
    }
    for (const osg::observer_ptr<osg::Program>& each : _retired)
    {
        osg::ref_ptr<osg::Program> former;
        if (each.lock(former)) programs.push_back(former);
    }
    return programs;
}

bool ProgramCache::changed(const Effects& effects)
{
    bool other = effects != _effects;
    _effects = effects;
    _revisions.resize(effects.size());
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        const unsigned int revision = effects[i]->revision();
        other = other || revision != _revisions[i];
        _revisions[i] = revision;
    }
    return other;
}

} // namespace osgGeoFX
