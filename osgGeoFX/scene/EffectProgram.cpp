// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/EffectProgram.h>

#include <osgGeoFX/deformation/Deformation.h>
#include <osgGeoFX/scene/ShaderLibrary.h>
#include <osgGeoFX/scene/SurfaceEffect.h>

#include <osg/Notify>

namespace osgGeoFX
{

namespace
{

std::string replaced(std::string text, const std::string& word, const std::string& by)
{
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
    {
        text.replace(at, word.size(), by);
    }
    return text;
}

/// What stands in the place of the words in capitals in stages/functions.*.
struct Parts
{
    std::string imports, functions, locate, deform, normal, colour;

    std::string fill(std::string text) const
    {
        text = replaced(std::move(text), "GEOFX_IMPORTED_EFFECTS", imports);
        text = replaced(std::move(text), "GEOFX_EFFECT_FUNCTIONS", functions);
        text = replaced(std::move(text), "GEOFX_LOCATE_CALLS", locate);
        text = replaced(std::move(text), "GEOFX_DEFORM_CALLS", deform);
        text = replaced(std::move(text), "GEOFX_NORMAL_CALLS", normal);
        return replaced(std::move(text), "GEOFX_COLOUR_CALLS", colour);
    }
};

std::string fileOf(osg::Shader::Type stage)
{
    return stage == osg::Shader::VERTEX ? "stages/functions.vert" : "stages/functions.frag";
}

std::string conditional(const std::string& condition, const std::string& text)
{
    return "#if " + condition + "\n" + text + "#endif\n";
}

void addDeformation(Parts& parts, const Deformation& deformation, const std::string& prefix,
                    const std::string& define)
{
    const std::string move = "    position = " + prefix + "deform(position);\n";
    std::string deform = "    geofx_styleBlend = max(geofx_styleBlend, ";
    deform += prefix + "style(position));\n";
    deform += move;
    parts.deform += conditional("defined(" + define + ")", deform);
    std::string normal = "    normal = ";
    normal += prefix + "normal(position, normal);\n";
    normal += move;
    parts.normal += conditional("defined(" + define + ")", normal);
    if (deformation.fragmentFile().empty()) return;
    parts.colour += conditional("defined(GEOFX_DEFORMATION) && defined(" + define + ")",
                                "    result = " + prefix + "restyle(result, map, geofx_styleBlend);\n");
}

void addSurface(Parts& parts, const std::string& prefix, const std::string& define)
{
    parts.locate += conditional("defined(" + define + ")", "    " + prefix + "locate(located);\n");
    parts.colour += conditional("defined(" + define + ")", "    result = " + prefix + "colour(result);\n");
}

/// The code of all effects for one stage.
Parts partsOf(const std::vector<osg::ref_ptr<Effect>>& effects, const ShaderLibrary& library, bool vertex)
{
    Parts parts;
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        const Deformation* deformation = effects[i]->asDeformation();
        const SurfaceEffect* surface = effects[i]->asSurfaceEffect();
        if (!deformation && !surface) continue;
        const std::string prefix = EffectProgram::prefix(i);
        const std::string define = EffectProgram::define(i);
        // Short lines: some drivers broke on long ones.
        parts.imports += "#pragma import_defines(" + define + ")\n";
        std::string text;
        if (deformation)
        {
            const std::string file = vertex ? deformation->vertexFile() : deformation->fragmentFile();
            if (!file.empty()) text = deformation->constants() + library.read(file);
            addDeformation(parts, *deformation, prefix, define);
        }
        else
        {
            text = library.read(vertex ? surface->vertexFile() : surface->fragmentFile());
            addSurface(parts, prefix, define);
        }
        parts.functions += replaced(text, "SLOT_", prefix);
    }
    return parts;
}

osg::ref_ptr<osg::Shader> functionShader(const EffectProgram::Effects& effects, osg::Shader::Type stage)
{
    osg::ref_ptr<osg::Shader> shader = new osg::Shader(stage, EffectProgram::functions(effects, stage));
    shader->setName(fileOf(stage));
    return shader;
}

} // namespace

std::string EffectProgram::prefix(std::size_t effect)
{
    return "geofx_" + std::to_string(effect) + "_";
}

std::string EffectProgram::define(std::size_t effect)
{
    return "GEOFX_EFFECT_" + std::to_string(effect);
}

std::string EffectProgram::key(const Effects& effects)
{
    std::string key;
    for (const auto& effect : effects)
    {
        const Deformation* deformation = effect->asDeformation();
        if (deformation)
            key += deformation->vertexFile() + deformation->fragmentFile() + deformation->constants();
        if (const SurfaceEffect* surface = effect->asSurfaceEffect())
            key += surface->vertexFile() + surface->fragmentFile();
        key += ';';
    }
    return key;
}

std::string EffectProgram::functions(const Effects& effects, osg::Shader::Type stage)
{
    const ShaderLibrary library;
    const std::string file = fileOf(stage);
    const Parts parts = partsOf(effects, library, stage == osg::Shader::VERTEX);
    return library.assemble(parts.fill(library.read(file)), file);
}

osg::ref_ptr<osg::Program> EffectProgram::create(const Effects& effects)
{
    try
    {
        const ShaderLibrary library;
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->setName("osgGeoFX");
        program->addShader(library.createShader(osg::Shader::VERTEX, "stages/fixed.vert"));
        program->addShader(library.createShader(osg::Shader::FRAGMENT, "stages/fixed.frag"));
        program->addShader(functionShader(effects, osg::Shader::VERTEX));
        program->addShader(functionShader(effects, osg::Shader::FRAGMENT));
        return program;
    }
    catch (const ShaderError& error)
    {
        OSG_WARN << "osgGeoFX: " << error.what() << std::endl;
        return nullptr;
    }
}

} // namespace osgGeoFX
