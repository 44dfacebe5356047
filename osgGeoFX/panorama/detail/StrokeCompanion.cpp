// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/StrokeCompanion.h>

#include <osgGeoFX/effect/detail/FirstParent.h>
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>

#include <osg/BlendFunc>
#include <osg/Viewport>

#include <cmath>
#include <iterator>

namespace osgGeoFX
{

namespace
{

PassShaders strokeShaders()
{
    PassShaders shaders;
    shaders.vertex = {"stages/panorama.strokes.ground.glsl"};
    shaders.geometry = {"stages/panorama.strokes.geom.glsl"};
    shaders.fragment = {"stages/panorama.strokes.finish.glsl"};
    shaders.vertexMain = "stages/panorama.strokes.vert";
    shaders.fragmentMain = "stages/panorama.strokes.frag";
    return shaders;
}

/// How many times larger than wanted the strokes of a picture are, where there are too few of them.
double growthOf(const ScenePass& pass, const PanoramaMap& map, const osg::Vec2d& picture)
{
    double groundScale = HUGE_VAL; // near the eye of a perspective picture
    if (map.getProjection())
    {
        const std::optional<glsl::geofx_Panorama> view = panoramaOf(map, pass.view);
        if (view) groundScale = 0.5 * std::sqrt(picture.x() * view->across * picture.y() * view->along);
    }
    return glsl::geofx_strokeGrowth(
        glsl::geofx_strokeWanted(map.getStrokeSpacing(), map.getStrokeStep(), groundScale));
}

/// Whether a geometry has a cover, of its own or of a node above it, and no node up to there says that it is not to be
/// painted. By first parents, as CoverSampler has it.
bool isGround(const osg::Geometry& geometry, unsigned int coverUnit)
{
    for (const osg::Node* node = &geometry; node; node = firstParent(*node))
    {
        const osg::StateSet* state = node->getStateSet();
        if (!state) continue;
        const auto define = state->getDefineList().find("GEOFX_PAINTED");
        if (define != state->getDefineList().end() && !(define->second.second & osg::StateAttribute::ON))
            return false;
        if (state->getTextureAttribute(coverUnit, osg::StateAttribute::TEXTURE)) return true;
    }
    return false;
}

/// Half the length of the longest stroke, a cliff's, over the size. Half that of a road's over the spacing, seen at a
/// slant.
constexpr double longestStroke = 2.0, longestLine = 1.5;
/// How far a stroke stands from its point at the most, over the size (handReach of PanoramaGround.cpp).
constexpr double farthestShift = 2.5;

} // namespace

bool StrokeCompanion::begin(const ScenePass& pass, const PanoramaMap& map, StrokeMaker& maker)
{
    const osg::Viewport* viewport = pass.outer.getViewport();
    if (!viewport || viewport->width() < 1.0 || viewport->height() < 1.0) return false;
    const osg::ref_ptr<osg::Program> program = pass.program(strokeShaders());
    if (!program) return false;
    forgetGone();
    _maker = &maker;
    _toWorld.invert(pass.view.modelView);
    _coverUnit = static_cast<unsigned int>(map.getCoverUnit());

    const auto forced = osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    if (_state->getAttribute(osg::StateAttribute::PROGRAM) != program)
    {
        _state->setAttributeAndModes(program, osg::StateAttribute::ON | forced);
        // Colors are premultiplied, and depth is written. The pass of another effect blends as it will.
        if (!pass.within())
            _state->setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA),
                                         osg::StateAttribute::ON | forced);
        _state->setMode(GL_CULL_FACE, osg::StateAttribute::OFF | forced);
        // Strokes are drawn over all ground, since soft edges mix with it. They are drawn in the order of traversal,
        // so that pictures do not depend on addresses.
        _state->setRenderBinDetails(2, "TraversalOrderBin",
                                    osg::StateSet::OVERRIDE_PROTECTED_RENDERBIN_DETAILS);
    }
    // In pixels, whatever part of it the camera draws.
    osg::Vec2d low, high;
    pass.view.picturePart(low, high);
    const osg::Vec2d picture(2.0 * viewport->width() / (high.x() - low.x()),
                             2.0 * viewport->height() / (high.y() - low.y()));
    _reach = longestStroke * map.getStrokeSize() * growthOf(pass, map, picture) +
             farthestShift * map.getStrokeSize() + longestLine * map.getStrokeSpacing() + 2.0;
    const auto put = [&](const char* name, double x, double y, double z, double w)
    {
        _state->getOrCreateUniform(pass.prefix + name, osg::Uniform::FLOAT_VEC4)
            ->set(osg::Vec4(osg::Vec4d(x, y, z, w)));
    };
    put("viewport", viewport->width(), viewport->height(), 1.0 / viewport->width(), 1.0 / viewport->height());
    put("stroke", map.getStrokeSize(), map.getStrokeSpacing(), map.getStrokeStep(),
        shareOf(map.getStrength()));
    put("strokeView",
        map.getProjection() ? 0.0 : 0.5 * viewport->height() * std::abs(pass.view.image.projection(1, 1)),
        picture.x(), picture.y(), 0.0);
    return true;
}

osg::Drawable* StrokeCompanion::companion(osg::Drawable& drawable, const osg::Matrixd& modelView)
{
    osg::Geometry* terrain = drawable.asGeometry();
    if (!terrain || !isGround(*terrain, _coverUnit)) return nullptr;
    // The geometry keeps them alive.
    osg::Drawable* const strokes = _maker->strokes(*terrain, modelView * _toWorld).get();
    if (!strokes) return nullptr;
    osg::observer_ptr<osg::Drawable>& known = _drawn[strokes];
    if (!known.valid()) known = strokes;
    // The meshes of a tile share them.
    return _given.insert(strokes).second ? strokes : nullptr;
}

void StrokeCompanion::forgetGone()
{
    constexpr std::size_t few = 256;
    if (_drawn.size() < 2 * _remembered + few) return;
    for (auto entry = _drawn.begin(); entry != _drawn.end();)
        entry = entry->second.valid() ? std::next(entry) : _drawn.erase(entry);
    _remembered = _drawn.size();
}

void StrokeCompanion::resizeGLObjectBuffers(unsigned int size)
{
    for (const auto& [address, drawn] : _drawn)
    {
        osg::ref_ptr<osg::Drawable> strokes;
        if (drawn.lock(strokes)) strokes->resizeGLObjectBuffers(size);
    }
}

void StrokeCompanion::releaseGLObjects(osg::State* state) const
{
    for (const auto& [address, drawn] : _drawn)
    {
        osg::ref_ptr<osg::Drawable> strokes;
        if (drawn.lock(strokes)) strokes->releaseGLObjects(state);
    }
}

} // namespace osgGeoFX
