// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/PanoramaScenery.h>

#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/panorama/detail/PanoramaEdge.h>
#include <osgGeoFX/panorama/detail/PanoramaProfile.h>
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>
#include <osgGeoFX/panorama/detail/PanoramaTextures.h>
#include <osgGeoFX/panorama/detail/StrokeCompanion.h>
#include <osgGeoFX/scene/detail/PassStage.h>
#include <osgGeoFX/scene/detail/TargetFormat.h>

#include <osg/BlendFunc>
#include <osg/Depth>
#include <osg/FrameBufferObject>
#include <osg/Notify>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// The picture in the water is so many times smaller than the camera's. It is blurred, so it needs no more.
constexpr int mirrorShrink = 4;
constexpr int mostMirrorPixels = 4096;
/// Over so many grounds one map may hang at a time, with strokes that stay.
constexpr std::size_t mostGrounds = 8;
/// The detail of the picture in the water.
constexpr double mirrorDetail = 0.3;
/// The sky is drawn after opaque geometry, and so only where nothing else is.
constexpr int skyBin = 8;

osg::ref_ptr<osg::Texture2D> createTarget(int width, int height, GLenum format)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(width, height);
    texture->setInternalFormat(static_cast<GLint>(format));
    const bool depth = format == GL_DEPTH_COMPONENT24 || format == GL_DEPTH_COMPONENT32F;
    if (format != GL_RGBA8)
    {
        texture->setSourceFormat(depth ? GL_DEPTH_COMPONENT : GL_RGBA);
        texture->setSourceType(GL_FLOAT);
    }
    const auto filter = depth ? osg::Texture::NEAREST : osg::Texture::LINEAR;
    texture->setFilter(osg::Texture::MIN_FILTER, filter);
    texture->setFilter(osg::Texture::MAG_FILTER, filter);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

/// What one camera draws into the water in one frame on its way to the screen.
class Mirror
{
public:
    /// The stage of this frame, cleared, with a picture of the camera's proportions.
    osgUtil::RenderStage& begin(const ScenePass& pass)
    {
        osgUtil::CullVisitor& outer = pass.outer;
        const osg::Viewport& viewport = *outer.getViewport();
        // Of the whole picture, whatever part of it the camera draws: reflections lie beside what they show.
        osg::Vec2d low, high;
        pass.view.picturePart(low, high);
        const auto side = [](double pixels, double share)
        {
            return std::clamp(static_cast<int>(std::lround(pixels / share)) / mirrorShrink, 1,
                              mostMirrorPixels);
        };
        const int width = side(viewport.width(), 0.5 * (high.x() - low.x()));
        const int height = side(viewport.height(), 0.5 * (high.y() - low.y()));
        const GLenum depthFormat = pass.depth.format();
        if (!_colors || _colors->getTextureWidth() != width || _colors->getTextureHeight() != height ||
            static_cast<GLenum>(_depths->getInternalFormat()) != depthFormat ||
            static_cast<GLenum>(_colors->getInternalFormat()) != pass.colorFormat)
        {
            _colors = createTarget(width, height, pass.colorFormat);
            _depths = createTarget(width, height, depthFormat);
            _target = new osg::FrameBufferObject;
            _target->setAttachment(osg::Camera::COLOR_BUFFER, osg::FrameBufferAttachment(_colors));
            _target->setAttachment(osg::Camera::DEPTH_BUFFER, osg::FrameBufferAttachment(_depths));
            _viewport = new osg::Viewport(0, 0, width, height);
        }
        if (!_stage) _stage = createStage();
        startStage(*_stage, outer, pass.depth, osg::Vec4(0.6f, 0.7f, 0.85f, 1.0f));
        _stage->setViewport(_viewport);
        _stage->setFrameBufferObject(_target);
        outer.getCurrentRenderBin()->getStage()->addPreRenderStage(_stage, mirrorOrder);
        return *_stage;
    }

    void resizeGLObjectBuffers(unsigned int size)
    {
        osg::resizeGLObjectBuffers(_colors, size);
        osg::resizeGLObjectBuffers(_depths, size);
        osg::resizeGLObjectBuffers(_target, size);
    }

    osg::Texture2D* colors() const { return _colors; }
    osg::Viewport* viewport() const { return _viewport; }
    osg::StateSet& state() { return *_state; }
    osg::StateSet& skyState(bool mirrored) { return *(mirrored ? _mirroredSky : _sky); }

    void releaseGLObjects(osg::State* state) const
    {
        if (_colors) _colors->releaseGLObjects(state);
        if (_depths) _depths->releaseGLObjects(state);
        if (_target) _target->releaseGLObjects(state);
    }

private:
    osg::ref_ptr<osg::Texture2D> _colors, _depths;
    osg::ref_ptr<osg::FrameBufferObject> _target;
    osg::ref_ptr<osg::Viewport> _viewport;
    osg::ref_ptr<osgUtil::RenderStage> _stage;
    osg::ref_ptr<osg::StateSet> _state = new osg::StateSet;
    osg::ref_ptr<osg::StateSet> _sky = new osg::StateSet;
    osg::ref_ptr<osg::StateSet> _mirroredSky = new osg::StateSet;
};

constexpr auto forced = osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;

/// Sets the uniforms of a snapshot of the projection. Their names begin with the prefix.
void setUniforms(osg::StateSet& state, const std::string& prefix, const PanoramaSnapshot& snapshot)
{
    for (const auto& [name, value] : snapshot.uniforms())
        state.getOrCreateUniform(prefix + name, osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(value));
}

bool reflects(const PanoramaMap& map)
{
    return map.getWater() && map.getReflection() > 0.0 && map.getPaint();
}

/// What the sky of one traversal is drawn with.
struct Sky
{
    const PanoramaMap& map;
    PanoramaTextures& textures;
    const ScenePass& pass;
    const glsl::geofx_Panorama& panorama;
    Mirror& mirror;
    osg::Program* program;

    /// The state for the camera's picture, or for the picture in the water.
    osg::StateSet& state(bool mirrored) const
    {
        osg::StateSet& state = mirror.skyState(mirrored);
        state.setRenderBinDetails(skyBin, "RenderBin");
        state.setAttributeAndModes(program, osg::StateAttribute::ON | forced);
        // All of it is at the far plane, wherever in clip space that is.
        state.setAttributeAndModes(
            new osg::Depth(pass.depth.notBehind(), pass.depth.farthest(), pass.depth.farthest(), false),
            osg::StateAttribute::ON | forced);
        state.setMode(GL_DEPTH_TEST, osg::StateAttribute::ON | forced);
        state.setDefine("GEOFX_HDR", holdsBrightColors(pass.colorFormat) ? osg::StateAttribute::ON
                                                                         : osg::StateAttribute::OFF);
        const bool fades = !mirrored && map.getStrength() < 1.0;
        if (fades)
            state.setAttribute(
                new osg::BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA),
                forced);
        state.setMode(GL_BLEND, (fades ? osg::StateAttribute::ON : osg::StateAttribute::OFF) | forced);
        state.setMode(GL_CULL_FACE, osg::StateAttribute::OFF | forced);
        const bool showsMirror = reflects(map) && !mirrored;
        setTexture(state, 0, "geofx_sky", textures.sky(map));
        setTexture(state, 1, "geofx_skyMirror", showsMirror ? mirror.colors() : textures.noCover().get());
        setTexture(state, 2, "geofx_skyBrush", textures.brush());
        setEdge(state);
        osg::Vec2d low(-1.0, -1.0), high(1.0, 1.0);
        if (!mirrored) pass.view.picturePart(low, high);
        put(state, "geofx_skyPart", low.x(), low.y(), high.x(), high.y());
        put(state, "geofx_skyCurve", panorama.along, panorama.curve, panorama.horizon, panorama.end);
        setKnots(state);
        setWater(state);
        return state;
    }

private:
    static void put(osg::StateSet& state, const char* name, double x, double y, double z, double w)
    {
        state.getOrCreateUniform(name, osg::Uniform::FLOAT_VEC4)->set(osg::Vec4(osg::Vec4d(x, y, z, w)));
    }
    static void put(osg::StateSet& state, const char* name, const osg::Vec4d& value)
    {
        put(state, name, value.x(), value.y(), value.z(), value.w());
    }
    static void setTexture(osg::StateSet& state, int unit, const char* name, osg::Texture* texture)
    {
        state.setTextureAttribute(static_cast<unsigned int>(unit), texture, forced);
        state.getOrCreateUniform(name, osg::Uniform::SAMPLER_2D)->set(unit);
    }

    void setKnots(osg::StateSet& state) const
    {
        // Without points the shader stays what it is, to the bit.
        const bool points = panorama.profile.first > 0.0;
        state.setDefine("GEOFX_CURVE_POINTS", points ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
        const auto knots = knotsOf(panorama.profile);
        osg::Uniform* const uniform = state.getOrCreateUniform("geofx_skyKnots", osg::Uniform::FLOAT_VEC4, 7);
        uniform->setElement(0, osg::Vec4(osg::Vec4d(panorama.profile.first, 0.0, 0.0, 0.0)));
        for (unsigned int i = 1; i < 7; ++i)
            uniform->setElement(i, osg::Vec4(osg::Vec4d(knots[i - 1], 0.0)));
    }

    /// Sets what lies behind the end of the terrain.
    void setEdge(osg::StateSet& state) const
    {
        const PanoramaEdge edge(map, textures, pass.view, pass.view.modelView, panorama);
        put(state, "geofx_skyPlace", edge.sky);
        put(state, "geofx_skyEdgeEye", edge.eye);
        put(state, "geofx_skyEdgeWays", edge.ways);
        put(state, "geofx_skyEdgeKind", edge.kind);
        put(state, "geofx_skyCylinder", edge.cylinder.ring, edge.cylinder.middle, edge.cylinder.halfArc, 0.0);
        setTexture(state, 3, "geofx_skyEdge", edge.map);
    }

    void setWater(osg::StateSet& state) const
    {
        // The axes of the water's ripples on the ground. They are set even if no ground is painted.
        const auto axis = [&](const char* name, const std::string& ground)
        {
            const osg::Uniform* uniform = pass.state.getUniform(pass.prefix + ground);
            osg::Vec4f row;
            if (uniform) uniform->get(row);
            const osg::Vec3d along(osg::Vec3f(row.x(), row.y(), row.z()));
            put(state, name, toOsg(panorama.right) * along / panorama.across, toOsg(panorama.forward) * along,
                static_cast<double>(row.w()) - pass.view.eyeHeight * (pass.view.up * along),
                1.0 / panorama.across);
        };
        axis("geofx_skyAxisX", "brushX");
        axis("geofx_skyAxisY", "brushY");
        put(state, "geofx_skyWater", map.getDeepShore(), map.getReflection(), map.getRipples(), 0.0);
        const osg::FrameStamp* stamp = pass.outer.getFrameStamp();
        put(state, "geofx_skyClock", stamp ? std::fmod(stamp->getSimulationTime(), 3600.0) : 0.0,
            map.getAtmosphere(), reflects(map) ? 1.0 : 0.0, shareOf(map.getStrength()));
    }
};

/// The deformations of a pass as they are in the water. `turned`: whether there is a panorama's among them.
osg::ref_ptr<DeformationChain> mirroredChain(const ScenePass& pass, osg::StateSet& state, bool& turned)
{
    osg::ref_ptr<DeformationChain> chain = new DeformationChain;
    for (const auto& snapshot : pass.chain.snapshots())
    {
        const auto* own = dynamic_cast<const PanoramaSnapshot*>(snapshot.get());
        if (!own)
        {
            chain->add(snapshot);
            continue;
        }
        const osg::ref_ptr<const PanoramaSnapshot> mirrored = own->mirrored(0.0, mirrorDetail);
        setUniforms(state, pass.prefix, *mirrored);
        chain->add(mirrored);
        turned = true;
    }
    return chain;
}

void setMirrorState(Mirror& mirror, const ScenePass& pass, unsigned int unit, PanoramaTextures& textures)
{
    osg::StateSet& state = mirror.state();
    state.setDefine("GEOFX_MIRROR", osg::StateAttribute::ON);
    state.setDefine("GEOFX_IMAGE", osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    state.setMode(GL_CULL_FACE, osg::StateAttribute::OFF | forced);
    state.setMode(GL_BLEND, osg::StateAttribute::OFF | forced);
    state.setAttribute(mirror.viewport(), forced);
    // Another effect may have its texture now at the unit that was used here.
    for (unsigned int former = 0; former < state.getNumTextureAttributeLists(); ++former)
        state.removeTextureAttribute(former, osg::StateAttribute::TEXTURE);
    state.setTextureAttribute(unit, textures.noCover(), forced);
    const osg::Viewport& size = *mirror.viewport();
    state.getOrCreateUniform(pass.prefix + "window", osg::Uniform::FLOAT_VEC4)
        ->set(osg::Vec4(0.0f, 0.0f, static_cast<float>(1.0 / size.width()),
                        static_cast<float>(1.0 / size.height())));
}

} // namespace

class PanoramaMap::Scenery::Cameras
{
public:
    /// What one traversal of a frame needs until it is drawn.
    struct Look
    {
        Mirror mirror;
        StrokeCompanion strokes;
        std::map<std::string, StrokeCompanion> within; ///< in the passes of other effects, by their prefixes
    };

    /// The looks of one camera. Its cull visitor may come several times before anything is drawn: for a camera that
    /// renders to a texture, or for a scene with two parents.
    class Looks
    {
    public:
        /// The look of the current traversal.
        Look& now(const ScenePass& pass)
        {
            if (pass.frame != _frame) _used = 0;
            _frame = pass.frame;
            if (_used == _all.size()) _all.push_back(std::make_unique<Look>());
            return *_all[_used];
        }
        /// Ends the traversal. Its look stays until it is drawn.
        void end() { ++_used; }

        void resizeGLObjectBuffers(unsigned int size)
        {
            for (const std::unique_ptr<Look>& each : _all)
            {
                each->mirror.resizeGLObjectBuffers(size);
                each->strokes.resizeGLObjectBuffers(size);
                for (auto& [prefix, strokes] : each->within)
                    strokes.resizeGLObjectBuffers(size);
            }
        }
        void releaseGLObjects(osg::State* state) const
        {
            for (const std::unique_ptr<Look>& each : _all)
            {
                each->mirror.releaseGLObjects(state);
                each->strokes.releaseGLObjects(state);
                for (const auto& [prefix, strokes] : each->within)
                    strokes.releaseGLObjects(state);
            }
        }

    private:
        unsigned int _frame = 0; ///< ScenePass::frame
        std::vector<std::unique_ptr<Look>> _all;
        std::size_t _used = 0;
    };
    PerCamera<Looks> looks;

    /// The maker of a terrain's strokes, with the map's parameters. Scenes over different grounds have different
    /// makers; their threads may ask at once.
    osg::ref_ptr<StrokeMaker> maker(const PanoramaMap& map, const osgGeoFX::Ground& ground)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        const double latitude = std::clamp(ground.latitude, -1.4, 1.4);
        const auto madeFor = [&](double at)
        {
            return std::find_if(_makers.begin(), _makers.end(),
                                [&](const osg::ref_ptr<StrokeMaker>& each) {
                                    return each->isFor(ground.ellipsoid) &&
                                           each->getParameters().referenceLatitude == at;
                                });
        };
        auto known = madeFor(latitude);
        // A pager may have got a maker before there was a terrain. This maker goes on.
        if (known == _makers.end()) known = madeFor(0.0);
        const osg::ref_ptr<StrokeMaker> maker =
            known == _makers.end() ? new StrokeMaker(ground.ellipsoid) : known->get();
        // The maker that was asked for last comes first.
        if (known != _makers.end()) _makers.erase(known);
        _makers.insert(_makers.begin(), maker);
        if (_makers.size() > mostGrounds) _makers.pop_back();
        StrokeParameters parameters;
        parameters.spacing = map.getStrokeStep();
        parameters.referenceLatitude = latitude;
        parameters.coverUnit = map.getCoverUnit();
        parameters.cliffSlope = 1.2 * map.getCliffSlope();
        parameters.treeLine = map.getTreeLine() >= 0.0 ? map.getTreeLine() : treeLineAt(ground.latitude);
        parameters.lines = map.getLines();
        if (maker->getParameters() != parameters) maker->setParameters(parameters);
        return maker;
    }

    osg::Program* skyProgram()
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (!_skyProgram)
            _skyProgram = ShaderLibrary::createProgram("osgGeoFX sky", "stages/panorama.sky.vert",
                                                       "stages/panorama.sky.frag");
        return _skyProgram;
    }

    osg::Geometry* square() const { return _square; }

    void resizeGLObjectBuffers(unsigned int size)
    {
        looks.resizeGLObjectBuffers(size);
        const std::lock_guard<std::mutex> lock(_mutex);
        osg::resizeGLObjectBuffers(_skyProgram, size);
        _square->resizeGLObjectBuffers(size);
    }

    void releaseGLObjects(osg::State* state) const
    {
        looks.releaseGLObjects(state);
        const std::lock_guard<std::mutex> lock(_mutex);
        if (_skyProgram) _skyProgram->releaseGLObjects(state);
        _square->releaseGLObjects(state);
    }

private:
    mutable std::mutex _mutex;
    std::vector<osg::ref_ptr<StrokeMaker>> _makers;
    osg::ref_ptr<osg::Program> _skyProgram;
    osg::ref_ptr<osg::Geometry> _square = createSquare(-1.0f);
};

PanoramaMap::Scenery::Scenery(const PanoramaMap& map, PanoramaTextures& textures)
    : _map(map), _textures(textures), _cameras(std::make_unique<Cameras>())
{
}

PanoramaMap::Scenery::~Scenery() = default;

const Properties& PanoramaMap::Scenery::properties() const
{
    static const Properties none;
    return none;
}

void PanoramaMap::Scenery::cull(const ScenePass& pass)
{
    Cameras::Looks& looks = _cameras->looks.of(pass.outer, pass.scene);
    Mirror& mirror = looks.now(pass).mirror;
    looks.end();
    if (!pass.outer.getViewport()) return;
    const std::optional<glsl::geofx_Panorama> panorama = panoramaOf(_map, pass.view);
    if (!panorama) return;
    osgUtil::RenderStage* stage = reflects(_map) ? &mirror.begin(pass) : nullptr;
    osg::Program* skyProgram = _map.getSky() ? _cameras->skyProgram() : nullptr;
    const Sky sky{_map, _textures, pass, *panorama, mirror, skyProgram};
    if (skyProgram)
    {
        pass.outer.pushStateSet(&sky.state(false));
        pass.outer.addDrawableAndDepth(_cameras->square(), pass.outer.getModelViewMatrix(), 0.0f);
        pass.outer.popStateSet();
    }
    if (!stage) return;

    const auto unit = static_cast<unsigned int>(pass.units[MirrorUnit]);
    setMirrorState(mirror, pass, unit, _textures);
    bool turned = false;
    const osg::ref_ptr<DeformationChain> chain = mirroredChain(pass, mirror.state(), turned);
    const osg::ref_ptr<osg::Program> program = pass.sceneProgram();
    const ScenePass::Drawing drawing = {program, &mirror.state(), stage, chain, nullptr, true};
    // It is the projection that turns the ground over; without it there is the sky to reflect.
    if (turned) pass.draw(drawing);
    if (skyProgram)
    {
        const ScenePass::Piece piece = {_cameras->square(), *pass.outer.getModelViewMatrix(),
                                        &sky.state(true)};
        pass.draw({piece}, drawing);
    }
    pass.state.setTextureAttribute(unit, mirror.colors());
}

DrawableCompanion* PanoramaMap::Scenery::companion(const ScenePass& pass)
{
    if (!_map.getStrokes() || !_map.getPaint()) return nullptr;
    Cameras::Look& look = _cameras->looks.of(pass.outer, pass.scene).now(pass);
    StrokeCompanion& strokes = pass.within() ? look.within[*pass.within()] : look.strokes;
    return strokes.begin(pass, _map, *_cameras->maker(_map, pass.view.ground)) ? &strokes : nullptr;
}

osg::ref_ptr<TileListener> PanoramaMap::Scenery::tileListener(const osgGeoFX::Ground& ground)
{
    return _cameras->maker(_map, ground);
}

void PanoramaMap::Scenery::resizeGLObjectBuffers(unsigned int size)
{
    _cameras->resizeGLObjectBuffers(size);
}

void PanoramaMap::Scenery::releaseGLObjects(osg::State* state) const
{
    _cameras->releaseGLObjects(state);
}

} // namespace osgGeoFX
