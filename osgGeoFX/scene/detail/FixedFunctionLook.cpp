// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/FixedFunctionLook.h>

#include <osgGeoFX/effect/detail/AssemblyProgram.h>
#include <osgGeoFX/effect/detail/TileNormals.h>
#include <osgGeoFX/scene/detail/OwnPrograms.h>

#include <osg/Fog>
#include <osg/Image>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/Point>
#include <osg/TexEnv>
#include <osg/TexGen>
#include <osg/Texture>

#include <algorithm>
#include <iterator>
#include <string>

namespace osgGeoFX
{

namespace
{

// OpenGL's names for these numbers are not in OSG's headers.
constexpr GLenum colorSumMode = 0x8458;         // GL_COLOR_SUM
constexpr GLenum programTwoSideMode = 0x8643;   // GL_VERTEX_PROGRAM_TWO_SIDE
constexpr GLenum programPointSizeMode = 0x8642; // GL_VERTEX_PROGRAM_POINT_SIZE

/// OpenGL's base formats, as far as texture environments treat them differently.
enum class BaseFormat
{
    Full, ///< or luminance with alpha
    Opaque,
    Alpha,
    Intensity
};

BaseFormat baseFormat(GLint format)
{
    switch (format)
    {
    case GL_ALPHA:
    case GL_ALPHA4:
    case GL_ALPHA8:
    case GL_ALPHA12:
    case GL_ALPHA16:
    case GL_ALPHA16F_ARB:
    case GL_ALPHA32F_ARB:
        return BaseFormat::Alpha;
    case GL_INTENSITY:
    case GL_INTENSITY4:
    case GL_INTENSITY8:
    case GL_INTENSITY12:
    case GL_INTENSITY16:
    case GL_INTENSITY16F_ARB:
    case GL_INTENSITY32F_ARB:
        return BaseFormat::Intensity;
    case 1:
    case 3:
    case GL_LUMINANCE:
    case GL_LUMINANCE4:
    case GL_LUMINANCE8:
    case GL_LUMINANCE12:
    case GL_LUMINANCE16:
    case GL_LUMINANCE16F_ARB:
    case GL_LUMINANCE32F_ARB:
    case GL_RGB:
    case GL_BGR:
    case GL_R3_G3_B2:
    case GL_RGB4:
    case GL_RGB5:
    case GL_RGB8:
    case GL_RGB10:
    case GL_RGB12:
    case GL_RGB16:
    case GL_RGB16F_ARB:
    case GL_RGB32F_ARB:
    case GL_SRGB:
    case GL_SRGB8:
    case GL_SLUMINANCE:
    case GL_SLUMINANCE8:
    case GL_RED:
    case GL_R8:
    case GL_R16:
    case GL_R16F:
    case GL_R32F:
    case GL_RG:
    case GL_RG8:
    case GL_RG16:
    case GL_RG16F:
    case GL_RG32F:
    case GL_R11F_G11F_B10F:
    case GL_COMPRESSED_RGB:
    case GL_COMPRESSED_RGB_S3TC_DXT1_EXT:
    case GL_COMPRESSED_RED:
    case GL_COMPRESSED_RG:
    case GL_COMPRESSED_RED_RGTC1_EXT:
    case GL_COMPRESSED_RED_GREEN_RGTC2_EXT:
    case GL_COMPRESSED_LUMINANCE:
    case GL_DEPTH_COMPONENT:
    case GL_DEPTH_COMPONENT16:
    case GL_DEPTH_COMPONENT24:
    case GL_DEPTH_COMPONENT32:
        return BaseFormat::Opaque;
    case GL_COMPRESSED_ALPHA:
        return BaseFormat::Alpha;
    case GL_COMPRESSED_INTENSITY:
        return BaseFormat::Intensity;
    default:
        return BaseFormat::Full;
    }
}

/// The base format of a texture. OSG settles it at the upload; this is known before.
BaseFormat baseFormat(const osg::Texture& texture)
{
    if (texture.getShadowComparison())
    {
        switch (texture.getShadowTextureMode())
        {
        case osg::Texture::INTENSITY:
            return BaseFormat::Intensity;
        case osg::Texture::ALPHA:
            return BaseFormat::Alpha;
        default:
            return BaseFormat::Opaque;
        }
    }
    const osg::Image* image = texture.getImage(0);
    switch (texture.getInternalFormatMode())
    {
    case osg::Texture::USE_USER_DEFINED_FORMAT:
        return baseFormat(texture.getInternalFormat());
    case osg::Texture::USE_IMAGE_DATA_FORMAT:
        return baseFormat(image ? image->getInternalTextureFormat() : texture.getInternalFormat());
    default:
        return baseFormat(image ? static_cast<GLint>(image->getPixelFormat()) : texture.getInternalFormat());
    }
}

/// The texture that OpenGL draws with where GL_TEXTURE_2D is on. A texture without pixels counts as off.
const osg::Texture* texture2D(const osg::StateAttribute* attribute)
{
    const auto* texture = static_cast<const osg::Texture*>(attribute);
    if (!texture || texture->getTextureTarget() != GL_TEXTURE_2D) return nullptr;
    const osg::Image* image = texture->getImage(0);
    const bool pixels = image ? image->s() > 0 : texture->getTextureWidth() > 0;
    return pixels || texture->getReadPBuffer() ? texture : nullptr;
}

int modeOf(const osg::StateAttribute* attribute, bool& unsupported)
{
    if (!attribute) return 1;
    // osg::TexEnvCombine has the same type.
    const auto* environment = dynamic_cast<const osg::TexEnv*>(attribute);
    switch (environment ? environment->getMode() : -1)
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

int fogOf(const osg::StateAttribute* attribute)
{
    const auto* fog = static_cast<const osg::Fog*>(attribute);
    if (!fog) return 2;
    const int source = fog->getFogCoordinateSource() == osg::Fog::FOG_COORDINATE ? 4 : 0;
    if (fog->getMode() == osg::Fog::EXP) return source + 2;
    return source + (fog->getMode() == osg::Fog::LINEAR ? 1 : 3);
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

/// OpenGL's default material does not shine.
bool shines(const osg::StateAttribute* attribute)
{
    const auto* material = static_cast<const osg::Material*>(attribute);
    if (!material) return false;
    if (material->getColorMode() == osg::Material::SPECULAR) return true;
    const auto dark = [](const osg::Vec4& color)
    {
        return color.r() == 0.0f && color.g() == 0.0f && color.b() == 0.0f;
    };
    return !dark(material->getSpecular(osg::Material::FRONT)) ||
           !dark(material->getSpecular(osg::Material::BACK));
}

} // namespace

enum FixedFunctionState::ModeBit : unsigned int
{
    Lighting,
    Normalize,
    Rescale,
    FogMode,
    ColorSum,
    Light0, ///< eight lights
    // From here on each texture unit has eight bits.
    Texture2D = 16,
    OtherTexture,
    Generates ///< s, t, r, q
};

enum FixedFunctionState::Attribute : unsigned int
{
    Program,
    Material,
    Model,
    Fog,
    Point,
    // From here on each texture unit has three attributes.
    Image,
    Environment,
    Gen
};

void FixedFunctionState::setMode(unsigned int bit, unsigned int flags)
{
    const std::uint64_t mask = std::uint64_t(1) << bit;
    if ((_onOverridden & mask) && !(flags & osg::StateAttribute::PROTECTED)) return;
    _on = (flags & osg::StateAttribute::ON) ? _on | mask : _on & ~mask;
    _onOverridden = (flags & osg::StateAttribute::OVERRIDE) ? _onOverridden | mask : _onOverridden & ~mask;
}

void FixedFunctionState::setAttribute(unsigned int index, const osg::StateAttribute* attribute,
                                      unsigned int flags)
{
    const std::uint32_t mask = 1u << index;
    if ((_attributesOverridden & mask) && !(flags & osg::StateAttribute::PROTECTED)) return;
    _attributes[index] = attribute;
    if (flags & osg::StateAttribute::OVERRIDE)
        _attributesOverridden |= mask;
    else
        _attributesOverridden &= ~mask;
}

void FixedFunctionState::meetAll(const osgUtil::StateGraph& state)
{
    if (state._parent) meetAll(*state._parent);
    if (state.getStateSet()) meet(*state.getStateSet());
}

void FixedFunctionState::meetMode(GLenum mode, unsigned int flags)
{
    switch (mode)
    {
    case GL_LIGHTING:
        setMode(Lighting, flags);
        break;
    case GL_NORMALIZE:
        setMode(Normalize, flags);
        break;
    case GL_RESCALE_NORMAL:
        setMode(Rescale, flags);
        break;
    case GL_FOG:
        setMode(FogMode, flags);
        break;
    case colorSumMode:
        setMode(ColorSum, flags);
        break;
    default:
        if (mode >= GL_LIGHT0 && mode < GL_LIGHT0 + 8) setMode(Light0 + (mode - GL_LIGHT0), flags);
    }
}

void FixedFunctionState::meetTextureMode(unsigned int unit, GLenum mode, unsigned int flags)
{
    switch (mode)
    {
    case GL_TEXTURE_2D:
        setMode(Texture2D + 8 * unit, flags);
        break;
    case GL_TEXTURE_1D:
    case GL_TEXTURE_3D:
    case GL_TEXTURE_CUBE_MAP:
    case GL_TEXTURE_RECTANGLE:
        setMode(OtherTexture + 8 * unit, flags);
        break;
    default:
        if (mode >= GL_TEXTURE_GEN_S && mode <= GL_TEXTURE_GEN_Q)
            setMode(Generates + 8 * unit + (mode - GL_TEXTURE_GEN_S), flags);
    }
}

void FixedFunctionState::meet(const osg::StateSet& set)
{
    for (const auto& [mode, flags] : set.getModeList())
        meetMode(mode, flags);
    for (const auto& [type, entry] : set.getAttributeList())
    {
        switch (type.first)
        {
        case osg::StateAttribute::PROGRAM:
            setAttribute(Program, entry.first.get(), entry.second);
            break;
        case osg::StateAttribute::MATERIAL:
            setAttribute(Material, entry.first.get(), entry.second);
            break;
        case osg::StateAttribute::LIGHTMODEL:
            setAttribute(Model, entry.first.get(), entry.second);
            break;
        case osg::StateAttribute::FOG:
            setAttribute(Fog, entry.first.get(), entry.second);
            break;
        case osg::StateAttribute::POINT:
            setAttribute(Point, entry.first.get(), entry.second);
            break;
        default:
            break;
        }
    }
    if (const auto* assembly = AssemblyProgram::of(set))
        setAttribute(Program, assembly->first.get(), assembly->second);
    const auto& modes = set.getTextureModeList();
    for (unsigned int i = 0; i < modes.size(); ++i)
    {
        if (i < FixedFunctionLook::units)
        {
            for (const auto& [mode, flags] : modes[i])
                meetTextureMode(i, mode, flags);
            continue;
        }
        const auto found = modes[i].find(GL_TEXTURE_2D);
        if (found != modes[i].end() && (found->second & osg::StateAttribute::ON)) _beyond = true;
    }
    const auto& textures = set.getTextureAttributeList();
    for (unsigned int i = 0; i < textures.size() && i < FixedFunctionLook::units; ++i)
    {
        for (const auto& [type, entry] : textures[i])
        {
            if (type.first == osg::StateAttribute::TEXTURE)
                setAttribute(Image + 3 * i, entry.first.get(), entry.second);
            if (type.first == osg::StateAttribute::TEXENV)
                setAttribute(Environment + 3 * i, entry.first.get(), entry.second);
            if (type.first == osg::StateAttribute::TEXGEN)
                setAttribute(Gen + 3 * i, entry.first.get(), entry.second);
        }
    }
}

int FixedFunctionState::environment(unsigned int unit, bool& unsupported) const
{
    const osg::Texture* texture = texture2D(_attributes[Image + 3 * unit]);
    if (!texture) return 0;
    return modeOf(_attributes[Environment + 3 * unit], unsupported) +
           8 * static_cast<int>(baseFormat(*texture)) + (texture->getShadowComparison() ? 32 : 0);
}

int FixedFunctionState::texGen(unsigned int unit) const
{
    int coordinates = 0;
    for (unsigned int i = 0; i < 4; ++i)
    {
        if (on(Generates + 8 * unit + i)) coordinates |= 8 << i;
    }
    if (coordinates == 0) return 0;
    const auto* gen = static_cast<const osg::TexGen*>(_attributes[Gen + 3 * unit]);
    switch (gen ? gen->getMode() : osg::TexGen::EYE_LINEAR)
    {
    case osg::TexGen::OBJECT_LINEAR:
        return coordinates + 1;
    case osg::TexGen::SPHERE_MAP:
        return coordinates + 3;
    case osg::TexGen::NORMAL_MAP:
        return coordinates + 4;
    case osg::TexGen::REFLECTION_MAP:
        return coordinates + 5;
    default:
        // OpenGL's default, which an osg::TexGenNode leaves in force, too.
        return coordinates + 2;
    }
}

FixedFunctionLook FixedFunctionState::look(int mapUnit) const
{
    FixedFunctionLook look;
    if (OwnPrograms::isOwn(_attributes[Program]))
    {
        look.ownProgram = true;
        return look;
    }
    meetLights(look);
    look.unsupported = _beyond;
    if (on(FogMode)) look.fog = fogOf(_attributes[Fog]);
    for (unsigned int i = 0; i < FixedFunctionLook::units; ++i)
    {
        if (on(OtherTexture + 8 * i)) look.unsupported = true;
        if (!on(Texture2D + 8 * i)) continue;
        look.texture[i] = environment(i, look.unsupported);
        if (look.texture[i] > 0) look.texGen[i] = texGen(i);
    }
    const osg::Texture* normals = texture2D(_attributes[Image + 3 * TileNormals::unit]);
    look.normalMap = normals && normals->getName() == TileNormals::texture;
    const osg::Texture* map = mapUnit >= 0 && mapUnit < FixedFunctionLook::units
                                  ? texture2D(_attributes[Image + 3 * static_cast<unsigned int>(mapUnit)])
                                  : nullptr;
    // What a database's tiles have for shaders is no map.
    look.map = map && map->getName().rfind("geofx ", 0) != 0;
    return look;
}

const osg::StateAttribute* FixedFunctionState::program() const
{
    return _attributes[Program];
}

FixedFunctionLook FixedFunctionState::vertexLook() const
{
    FixedFunctionLook look;
    meetLights(look);
    // Fragments may read the distance and all coordinates, whatever modes there are.
    look.fog = on(FogMode) ? fogOf(_attributes[Fog]) : 1;
    for (unsigned int i = 0; i < FixedFunctionLook::units; ++i)
    {
        look.texture[i] = 1;
        look.texGen[i] = texGen(i);
    }
    return look;
}

void FixedFunctionState::meetLights(FixedFunctionLook& look) const
{
    if (on(Lighting))
    {
        look.lights = static_cast<int>(_on >> Light0 & 0xFFu);
        if (const auto* model = static_cast<const osg::LightModel*>(_attributes[Model]))
        {
            look.twoSided = model->getTwoSided();
            look.localViewer = model->getLocalViewer();
            look.colorSum = model->getColorControl() == osg::LightModel::SEPARATE_SPECULAR_COLOR;
        }
        look.colorMaterial = colorMaterialOf(_attributes[Material]);
        look.specular = shines(_attributes[Material]);
    }
    else
    {
        look.colorSum = on(ColorSum);
    }
    look.normalize = on(Normalize);
    look.rescale = on(Rescale) && !look.normalize;
    if (const auto* point = static_cast<const osg::Point*>(_attributes[Point]))
    {
        look.pointSize = point->getDistanceAttenuation() != osg::Vec3(1.0f, 0.0f, 0.0f);
    }
}

FixedFunctionLook::Key FixedFunctionLook::key() const
{
    Key key = {lights,
               (twoSided ? 1 : 0) | (localViewer ? 2 : 0) | (colorSum ? 4 : 0) | (normalize ? 8 : 0) |
                   (rescale ? 16 : 0) | (map ? 32 : 0) | (pointSize ? 64 : 0) | (specular ? 128 : 0) |
                   (normalMap ? 256 : 0) | (noNormal ? 512 : 0),
               colorMaterial, fog};
    std::copy(std::begin(texture), std::end(texture), key.begin() + 4);
    std::copy(std::begin(texGen), std::end(texGen), key.begin() + 4 + units);
    return key;
}

osg::ref_ptr<osg::StateSet> FixedFunctionLook::createStateSet(osg::Program* program) const
{
    osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    // Even an OVERRIDE that sets no program means the fixed functions, and this program stands for them.
    constexpr unsigned int always =
        osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    set->setAttributeAndModes(program, always);
    // Switched off where it is not needed: the shader writes no colors for the back then.
    set->setMode(programTwoSideMode, twoSided ? always : always & ~osg::StateAttribute::ON);
    if (pointSize) set->setMode(programPointSizeMode, always);
    const auto define = [&](const std::string& name, bool there, int value)
    {
        if (there) set->setDefine(name, std::to_string(value));
    };
    define("GEOFX_LIGHTS", lights >= 0, lights);
    define("GEOFX_SPECULAR", specular, 1);
    define("GEOFX_TWO_SIDED", twoSided, 1);
    define("GEOFX_LOCAL_VIEWER", localViewer, 1);
    define("GEOFX_COLOR_SUM", colorSum, 1);
    define("GEOFX_POINT_SIZE", pointSize, 1);
    define("GEOFX_NORMALIZE", normalize, 1);
    define("GEOFX_RESCALE", rescale, 1);
    define("GEOFX_COLOR_MATERIAL", colorMaterial > 0, colorMaterial);
    define("GEOFX_FOG", fog > 0, fog);
    define("GEOFX_MAP", map, 1);
    define("GEOFX_NORMAL_MAP", normalMap, 1);
    define("GEOFX_NO_NORMAL", noNormal, 1);
    for (int i = 0; i < units; ++i)
    {
        const std::string unit = std::to_string(i);
        define("GEOFX_TEXTURE_" + unit, texture[i] > 0, texture[i]);
        define("GEOFX_TEXGEN_" + unit, texGen[i] > 0, texGen[i]);
    }
    return set;
}

} // namespace osgGeoFX
