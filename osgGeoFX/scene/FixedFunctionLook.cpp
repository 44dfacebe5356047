// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/FixedFunctionLook.h>

#include <osg/Fog>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/TexEnv>
#include <osg/TexGen>

#include <algorithm>
#include <array>

namespace osgGeoFX
{

namespace
{

/// The state sets from the root to a drawable.
class Path
{
public:
    Path(const osgUtil::StateGraph& state, const osg::StateSet* drawable)
    {
        if (drawable) push(drawable);
        for (const osgUtil::StateGraph* graph = &state; graph; graph = graph->_parent)
        {
            if (graph->getStateSet()) push(graph->getStateSet());
        }
        std::reverse(_sets.begin(), _sets.begin() + _count);
    }
    const osg::StateSet* const* begin() const { return _sets.data(); }
    const osg::StateSet* const* end() const { return _sets.data() + _count; }

private:
    void push(const osg::StateSet* set)
    {
        // Deeper graphs than this lose what is nearest to the root.
        if (_count < static_cast<int>(_sets.size())) _sets[static_cast<std::size_t>(_count++)] = set;
    }
    std::array<const osg::StateSet*, 64> _sets{};
    int _count = 0;
};

/// A value that is handed down the path, as osg::State does it.
template<typename Value>
class Inherited
{
public:
    explicit Inherited(Value value) : _value(value) {}
    void meet(Value value, unsigned int flags)
    {
        if (_overridden && !(flags & osg::StateAttribute::PROTECTED)) return;
        _value = value;
        _overridden = (flags & osg::StateAttribute::OVERRIDE) != 0;
    }
    Value value() const { return _value; }

private:
    Value _value;
    bool _overridden = false;
};

using Mode = Inherited<bool>;
using Attribute = Inherited<const osg::StateAttribute*>;

/// One pass over the path for all that the look depends on.
struct Gathered
{
    Mode lighting{false}, normalize{false}, rescale{false}, fog{false};
    std::array<Mode, 8> lights{Mode(false), Mode(false), Mode(false), Mode(false),
                               Mode(false), Mode(false), Mode(false), Mode(false)};
    Attribute program{nullptr}, material{nullptr}, model{nullptr}, fogSettings{nullptr};
    struct Unit
    {
        Mode texture{false}, other{false}, genS{false}, genR{false};
        Attribute image{nullptr}, environment{nullptr}, gen{nullptr};
    };
    std::array<Unit, FixedFunctionLook::units> units;

    void meetMode(GLenum mode, unsigned int flags)
    {
        const bool on = (flags & osg::StateAttribute::ON) != 0;
        switch (mode)
        {
        case GL_LIGHTING:
            lighting.meet(on, flags);
            break;
        case GL_NORMALIZE:
            normalize.meet(on, flags);
            break;
        case GL_RESCALE_NORMAL:
            rescale.meet(on, flags);
            break;
        case GL_FOG:
            fog.meet(on, flags);
            break;
        default:
            if (mode >= GL_LIGHT0 && mode < GL_LIGHT0 + 8) lights[mode - GL_LIGHT0].meet(on, flags);
        }
    }
    void meetTextureMode(Unit& unit, GLenum mode, unsigned int flags)
    {
        const bool on = (flags & osg::StateAttribute::ON) != 0;
        switch (mode)
        {
        case GL_TEXTURE_2D:
            unit.texture.meet(on, flags);
            break;
        case GL_TEXTURE_1D:
        case GL_TEXTURE_3D:
        case GL_TEXTURE_CUBE_MAP:
        case GL_TEXTURE_RECTANGLE:
            unit.other.meet(on, flags);
            break;
        case GL_TEXTURE_GEN_S:
            unit.genS.meet(on, flags);
            break;
        case GL_TEXTURE_GEN_R:
            unit.genR.meet(on, flags);
            break;
        default:
            break;
        }
    }
    void meet(const osg::StateSet& set)
    {
        for (const auto& [mode, flags] : set.getModeList())
            meetMode(mode, flags);
        for (const auto& [type, entry] : set.getAttributeList())
        {
            switch (type.first)
            {
            case osg::StateAttribute::PROGRAM:
                program.meet(entry.first.get(), entry.second);
                break;
            case osg::StateAttribute::MATERIAL:
                material.meet(entry.first.get(), entry.second);
                break;
            case osg::StateAttribute::LIGHTMODEL:
                model.meet(entry.first.get(), entry.second);
                break;
            case osg::StateAttribute::FOG:
                fogSettings.meet(entry.first.get(), entry.second);
                break;
            default:
                break;
            }
        }
        const auto& modes = set.getTextureModeList();
        for (std::size_t i = 0; i < std::min(modes.size(), units.size()); ++i)
        {
            for (const auto& [mode, flags] : modes[i])
                meetTextureMode(units[i], mode, flags);
        }
        const auto& attributes = set.getTextureAttributeList();
        for (std::size_t i = 0; i < std::min(attributes.size(), units.size()); ++i)
        {
            for (const auto& [type, entry] : attributes[i])
            {
                if (type.first == osg::StateAttribute::TEXTURE)
                    units[i].image.meet(entry.first.get(), entry.second);
                if (type.first == osg::StateAttribute::TEXENV)
                {
                    units[i].environment.meet(entry.first.get(), entry.second);
                }
                if (type.first == osg::StateAttribute::TEXGEN)
                    units[i].gen.meet(entry.first.get(), entry.second);
            }
        }
    }
};

int environmentOf(const osg::StateAttribute* attribute, bool& unsupported)
{
    const auto* environment = static_cast<const osg::TexEnv*>(attribute);
    if (!environment) return 1;
    switch (environment->getMode())
    {
    case osg::TexEnv::MODULATE:
        return 1;
    case osg::TexEnv::REPLACE:
        return 2;
    case osg::TexEnv::DECAL:
        return 3;
    case osg::TexEnv::BLEND:
        return 4;
    case osg::TexEnv::ADD:
        return 5;
    default:
        unsupported = true;
        return 1;
    }
}

int texGenOf(const osg::StateAttribute* attribute, bool& unsupported)
{
    const auto* gen = static_cast<const osg::TexGen*>(attribute);
    if (gen && gen->getMode() == osg::TexGen::OBJECT_LINEAR) return 1;
    if (gen && gen->getMode() == osg::TexGen::EYE_LINEAR) return 2;
    unsupported = true;
    return 0;
}

int fogOf(const osg::StateAttribute* attribute)
{
    const auto* fog = static_cast<const osg::Fog*>(attribute);
    if (!fog || fog->getMode() == osg::Fog::EXP) return 2;
    return fog->getMode() == osg::Fog::LINEAR ? 1 : 3;
}

int colorMaterialOf(const osg::StateAttribute* attribute)
{
    const auto* material = static_cast<const osg::Material*>(attribute);
    if (!material) return 0;
    switch (material->getColorMode())
    {
    case osg::Material::AMBIENT:
        return 1;
    case osg::Material::DIFFUSE:
        return 2;
    case osg::Material::AMBIENT_AND_DIFFUSE:
        return 3;
    case osg::Material::SPECULAR:
        return 4;
    case osg::Material::EMISSION:
        return 5;
    default:
        return 0;
    }
}

} // namespace

FixedFunctionLook FixedFunctionLook::find(const osgUtil::StateGraph& state, const osg::StateSet* drawable,
                                          int mapUnit)
{
    Gathered gathered;
    for (const osg::StateSet* set : Path(state, drawable))
        gathered.meet(*set);

    FixedFunctionLook look;
    const auto* program = static_cast<const osg::Program*>(gathered.program.value());
    if (program && !program->isFixedFunction())
    {
        look.ownProgram = true;
        return look;
    }
    if (gathered.lighting.value())
    {
        look.lights = 0;
        for (int i = 0; i < 8; ++i)
        {
            if (gathered.lights[static_cast<std::size_t>(i)].value()) look.lights |= 1 << i;
        }
        if (const auto* model = static_cast<const osg::LightModel*>(gathered.model.value()))
        {
            look.twoSided = model->getTwoSided();
            look.localViewer = model->getLocalViewer();
            look.separateSpecular = model->getColorControl() == osg::LightModel::SEPARATE_SPECULAR_COLOR;
        }
        look.colorMaterial = colorMaterialOf(gathered.material.value());
        look.normalize = gathered.normalize.value();
        look.rescale = gathered.rescale.value();
    }
    if (gathered.fog.value()) look.fog = fogOf(gathered.fogSettings.value());
    for (std::size_t i = 0; i < gathered.units.size(); ++i)
    {
        const Gathered::Unit& unit = gathered.units[i];
        if (unit.other.value()) look.unsupported = true;
        if (!unit.texture.value() || !unit.image.value()) continue;
        look.texture[i] = environmentOf(unit.environment.value(), look.unsupported);
        if (unit.genS.value()) look.texGen[i] = texGenOf(unit.gen.value(), look.unsupported);
    }
    look.map =
        mapUnit >= 0 && mapUnit < units && gathered.units[static_cast<std::size_t>(mapUnit)].image.value();
    return look;
}

FixedFunctionLook::Key FixedFunctionLook::key() const
{
    int textures = 0;
    int gens = 0;
    for (int i = 0; i < units; ++i)
    {
        textures = textures * 8 + texture[i];
        gens = gens * 4 + texGen[i];
    }
    const int flags = (twoSided ? 1 : 0) | (localViewer ? 2 : 0) | (separateSpecular ? 4 : 0) |
                      (normalize ? 8 : 0) | (rescale ? 16 : 0) | (map ? 32 : 0);
    return {lights, flags, colorMaterial, fog, textures, gens, ownProgram ? 1 : 0};
}

osg::ref_ptr<osg::StateSet> FixedFunctionLook::createStateSet(osg::Program* program) const
{
    osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    set->setAttributeAndModes(program);
    const auto define = [&](const std::string& name, bool there, int value)
    {
        if (there) set->setDefine(name, std::to_string(value));
    };
    define("GEOFX_LIGHTS", lights >= 0, lights);
    define("GEOFX_TWO_SIDED", twoSided, 1);
    define("GEOFX_LOCAL_VIEWER", localViewer, 1);
    define("GEOFX_SEPARATE_SPECULAR", separateSpecular, 1);
    define("GEOFX_NORMALIZE", normalize, 1);
    define("GEOFX_RESCALE", rescale && !normalize, 1);
    define("GEOFX_COLOR_MATERIAL", colorMaterial > 0, colorMaterial);
    define("GEOFX_FOG", fog > 0, fog);
    define("GEOFX_MAP", map, 1);
    for (int i = 0; i < units; ++i)
    {
        const std::string unit = std::to_string(i);
        define("GEOFX_TEXTURE_" + unit, texture[i] > 0, texture[i]);
        define("GEOFX_TEXGEN_" + unit, texGen[i] > 0, texGen[i]);
    }
    return set;
}

} // namespace osgGeoFX
