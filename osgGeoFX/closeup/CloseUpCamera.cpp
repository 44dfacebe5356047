// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/CloseUpCamera.h>

#include <osgGeoFX/closeup/CloseUpExtent.h>
#include <osgGeoFX/closeup/LiftFrame.h>
#include <osgGeoFX/effect/GlobeFrame.h>
#include <osgGeoFX/effect/ShaderLibrary.h>

#include <osg/BlendFunc>
#include <osg/GLExtensions>
#include <osg/LineWidth>
#include <osg/Notify>
#include <osg/PatchParameter>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace osgGeoFX
{

namespace
{

/// As many layers as any GPU with OpenGL 3 has.
constexpr int layersOfAll = 256;
/// Items that the geometry stage takes at once: more would be more vertices than some GPUs hand out.
constexpr std::size_t groupSize = 3;

/// Texels of a mask, and pixels, that a part of an edge spans where tessellation has its way.
constexpr float texelsOfPart = 1.0f, pixelsOfPart = 6.0f;

PassShaders plainShaders(unsigned int binding)
{
    PassShaders shaders;
    shaders.vertex = {"stages/closeup.items.glsl", "stages/closeup.vert.glsl"};
    shaders.fragment = {"stages/closeup.items.glsl", "stages/closeup.frag.glsl"};
    shaders.blocks = {{"Items", binding}};
    return shaders;
}

PassShaders amplifyingShaders(unsigned int binding, bool tessellated)
{
    PassShaders shaders = plainShaders(binding);
    shaders.geometry = {"stages/closeup.items.glsl", "stages/closeup.geom.glsl"};
    if (tessellated)
    {
        shaders.tessellationControl = {"stages/closeup.items.glsl", "stages/closeup.tesc.glsl"};
        shaders.tessellationEvaluation = {"stages/closeup.tese.glsl"};
    }
    return shaders;
}

PassShaders fenceShaders(unsigned int binding)
{
    PassShaders shaders = plainShaders(binding);
    shaders.vertexMain = "stages/closeup.fence.vert";
    shaders.fragmentMain = "stages/closeup.fence.frag";
    return shaders;
}

/// What the context can do; null where it has not drawn yet.
const osg::GLExtensions* extensionsOf(osgUtil::CullVisitor& outer)
{
    const osg::State* state = outer.getRenderInfo().getState();
    return state ? osg::GLExtensions::Get(state->getContextID(), false) : nullptr;
}

/// Where OSG's own culling is off, all that there is is drawn for all regions.
bool culls(const ScenePass& pass)
{
    return pass.compensate && (pass.outer.getCullingMode() & osg::CullSettings::VIEW_FRUSTUM_CULLING) != 0;
}

bool tessellates(osgUtil::CullVisitor& outer)
{
    const osg::GLExtensions* extensions = extensionsOf(outer);
    return extensions && extensions->glVersion >= 4.0f;
}

/// Layers that one texture array may have here.
int gpuLayers(osgUtil::CullVisitor& outer)
{
    const osg::GLExtensions* extensions = extensionsOf(outer);
    return extensions && extensions->maxLayerCount > 0 ? extensions->maxLayerCount : layersOfAll;
}

osg::ref_ptr<osg::Program> createLayerProgram()
{
    try
    {
        const ShaderLibrary library;
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->setName("osgGeoFX layer");
        program->addShader(library.createShader(osg::Shader::VERTEX, "stages/closeup.layer.vert"));
        program->addShader(library.createShader(osg::Shader::FRAGMENT, "stages/closeup.layer.frag"));
        return program;
    }
    catch (const ShaderError& error)
    {
        OSG_WARN << "osgGeoFX: " << error.what() << std::endl;
        return nullptr;
    }
}

/// The sun's direction in the frame of the surface data; x east, y north, z up, as good as the region's there.
osg::Vec3d sunOf(const CloseUp& closeUp)
{
    const double azimuth = closeUp.getSunAzimuth() + closeUp.getRegion()->getHeading();
    const double level = std::cos(closeUp.getSunElevation());
    return {level * std::sin(azimuth), level * std::cos(azimuth), std::sin(closeUp.getSunElevation())};
}

} // namespace

void CloseUpCamera::Traversal::use(const std::string& names, const Task& task)
{
    std::vector<int> wanted(std::begin(task.units), std::end(task.units));
    wanted.push_back(static_cast<int>(task.binding));
    if (prefix == names && places == wanted) return;
    prefix = names;
    places = std::move(wanted);
    base = new osg::StateSet;
    groups.clear();
    layerStates.clear();
    fenceStates.clear();
}

bool CloseUpCamera::singleIsCheaper() const
{
    // The geometry stage costs more than another pass over a few drawables, unless several passes would draw the same ones.
    constexpr double worthIt = 1.8;
    const bool magnified =
        std::any_of(_items.begin(), _items.end(),
                    [](const CloseUpItem& item)
                    { return std::max(item.closeUp().getScaleX(), item.closeUp().getScaleY()) > 1.0; });
    return _sharing >= worthIt && !(_levels && magnified);
}

void CloseUpCamera::setUp(const ScenePass& pass, const Task& task, std::size_t items)
{
    Traversal& now = *_now;
    now.values.resize(items);
    now.fences.resize(items);
    osg::StateSet& base = *now.base;
    const auto forced =
        osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    // A layer has the nearest fragment; how it mixes with the picture is decided when the layer is shown.
    base.setMode(GL_BLEND, forced);
    const std::string& prefix = pass.prefix;
    const char* const names[3] = {"masks", "tables", "surfaces"};
    osg::Texture* const textures[3] = {task.textures.masks, task.textures.tables, task.textures.surfaces};
    for (const int former : now.units)
        base.removeTextureAttribute(static_cast<unsigned int>(former), osg::StateAttribute::TEXTURE);
    for (std::size_t i = 0; i < 3; ++i)
    {
        now.units[i] = task.units[i];
        base.setTextureAttribute(static_cast<unsigned int>(task.units[i]), textures[i]);
        base.getOrCreateUniform(prefix + names[i], osg::Uniform::INT)->set(task.units[i]);
    }
    base.getOrCreateUniform(prefix + "quality", osg::Uniform::FLOAT_VEC4)
        ->set(osg::Vec4(static_cast<float>(task.samples), static_cast<float>(task.textures.normalLayer),
                        static_cast<float>(CloseUpTextures::tableWidth), 0.0f));
    base.getOrCreateUniform(prefix + "only", osg::Uniform::INT)->set(-1);
    if (_tessellated)
    {
        const bool perspective = pass.view.projection(3, 3) == 0.0;
        const double pixels = (perspective ? 1.0 : -1.0) * pass.outer.getViewport()->height() *
                              std::abs(pass.view.projection(1, 1)) / 2.0;
        const double roundness = std::accumulate(_items.begin(), _items.end(), 0.0,
                                                 [](double most, const CloseUpItem& item)
                                                 { return std::max(most, item.closeUp().getRoundness()); });
        base.setAttribute(new osg::PatchParameter(3));
        base.getOrCreateUniform(prefix + "fineness", osg::Uniform::FLOAT_VEC4)
            ->set(osg::Vec4(static_cast<float>(task.tessellation), texelsOfPart, pixelsOfPart,
                            static_cast<float>(pixels)));
        base.getOrCreateUniform(prefix + "roundness", osg::Uniform::FLOAT)
            ->set(static_cast<float>(roundness));
    }
    // Code that nothing needs is not compiled: some GPUs run through all branches.
    const auto define = [&](const char* name, bool needed)
    {
        base.setDefine(prefix + name, needed ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
    };
    define("MASKED",
           std::any_of(_items.begin(), _items.end(),
                       [](const CloseUpItem& item) { return item.cutByVertices() || item.stretched(); }));
    define("DATA", task.data != nullptr);
    define("ROUND", task.data && pass.view.ground.ellipsoid);
    osg::Vec4d globe, curve, area;
    osg::Matrixd toSurface;
    if (const SurfaceData* data = task.data)
    {
        const osg::EllipsoidModel* ellipsoid = pass.view.ground.ellipsoid;
        toSurface = osg::Matrixd::inverse(data->frameToWorld(ellipsoid) * *pass.outer.getModelViewMatrix());
        const osg::Vec2d size = data->getHigh() - data->getLow();
        area.set(data->getLow().x(), data->getLow().y(), 1.0 / size.x(), 1.0 / size.y());
        if (ellipsoid)
        {
            glsl::geofx_Exaggeration frame{};
            setGlobe(frame, *ellipsoid, std::sin(data->getLatitude()));
            globe.set(0.0, std::cos(data->getLatitude()), std::sin(data->getLatitude()), frame.flattening);
            curve.set(frame.curvature, frame.scale, 0.0, 0.0);
        }
    }
    base.getOrCreateUniform(prefix + "toSurface", osg::Uniform::FLOAT_MAT4)->set(osg::Matrixf(toSurface));
    base.getOrCreateUniform(prefix + "globe", osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(globe));
    base.getOrCreateUniform(prefix + "curve", osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(curve));
    base.getOrCreateUniform(prefix + "surfaceArea", osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(area));
}

CompensatingCullVisitor::Task CloseUpCamera::passTask(const ScenePass& pass, const Task&) const
{
    CompensatingCullVisitor::Task result;
    result.chain = &pass.chain;
    result.state = &pass.state;
    result.following = &pass.following;
    result.untouched = &pass.untouched;
    result.mapUnit = pass.mapUnit;
    result.compensate = true;
    result.tileError = pass.tileError;
    result.passState = _now->base;
    return result;
}

osg::StateSet* CloseUpCamera::groupState(const ScenePass& pass, const Task& task,
                                         const std::vector<std::size_t>& group)
{
    osg::ref_ptr<osg::StateSet>& state = _now->groups[group];
    if (!state)
    {
        state = new osg::StateSet;
        int targets[4] = {0, 0, 0, static_cast<int>(group.size())};
        for (std::size_t i = 0; i < group.size(); ++i)
            targets[i] = CloseUpItems::placeInBlock(group[i]);
        state->getOrCreateUniform(pass.prefix + "targets", osg::Uniform::INT_VEC4)
            ->set(targets[0], targets[1], targets[2], targets[3]);
        state->setAttribute(_now->values.binding(CloseUpItems::blockOf(group.front()), task.binding));
    }
    return state;
}

void CloseUpCamera::collectGroups(const ScenePass& pass, const Task& task,
                                  const std::vector<std::size_t>& touched,
                                  std::vector<osg::StateSet*>& states)
{
    std::vector<std::size_t> group;
    for (const std::size_t item : touched)
    {
        const bool full =
            group.size() == groupSize ||
            (!group.empty() && CloseUpItems::blockOf(group.front()) != CloseUpItems::blockOf(item));
        if (full)
        {
            states.push_back(groupState(pass, task, group));
            group.clear();
        }
        group.push_back(item);
    }
    if (!group.empty()) states.push_back(groupState(pass, task, group));
}

void CloseUpCamera::setLayerStates(const ScenePass& pass, const Task& task, std::size_t items)
{
    auto& states = _now->layerStates;
    while (states.size() < 2 * items)
    {
        const std::size_t item = states.size() / 2;
        osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        state->getOrCreateUniform(pass.prefix + "layer", osg::Uniform::INT)
            ->set(2 * CloseUpItems::placeInBlock(item) + static_cast<int>(states.size() % 2));
        state->getOrCreateUniform(pass.prefix + "only", osg::Uniform::INT)
            ->set(static_cast<int>(states.size() % 2));
        state->getOrCreateUniform(pass.prefix + "targets", osg::Uniform::INT_VEC4)
            ->set(CloseUpItems::placeInBlock(item), 0, 0, 1);
        state->setAttribute(_now->values.binding(CloseUpItems::blockOf(item), task.binding));
        states.push_back(state);
    }
    for (std::size_t i = 0; i < 2 * items; ++i)
    {
        const bool masked = i % 2 == 0 ? _items[i / 2].cutByVertices() : _items[i / 2].stretched();
        states[i]->setDefine(pass.prefix + "MASKED",
                             masked ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
    }
    while (_now->fenceStates.size() < 2 * items)
        _now->fenceStates.push_back(new osg::StateSet);
}

void CloseUpCamera::drawFence(const ScenePass& pass, const Task& task, const Seen& seen,
                              const RegionContents& found, osgUtil::RenderStage& stage)
{
    const CloseUpItem& item = _items[seen.item];
    const double width = item.closeUp().getAnchor()->getLineWidth();
    if (!item.fenced() && width <= 0.0) return;
    ContourFence& fence = _now->fences[seen.item];
    if (!fence.update(*item.closeUp().getRegion(), found.ground)) return;
    if (!_fenceProgram) return;
    std::vector<CompensatingCullVisitor::Piece> pieces;
    const auto add = [&](osg::Geometry* geometry, std::size_t which)
    {
        osg::StateSet& state = *_now->fenceStates[2 * seen.item + which];
        const auto on =
            osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
        state.merge(*_now->layerStates[2 * seen.item + 1]);
        state.setAttributeAndModes(_fenceProgram, on);
        state.setMode(GL_CULL_FACE, osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE |
                                        osg::StateAttribute::PROTECTED);
        state.setMode(GL_DEPTH_TEST, on);
        if (which == 1)
            state.setAttributeAndModes(new osg::LineWidth(static_cast<float>(width * task.samples)), on);
        pieces.push_back({geometry, item.regionToEye(), &state});
    };
    if (item.fenced()) add(fence.wall(), 0);
    if (width > 0.0) add(fence.line(), 1);
    CompensatingCullVisitor::Task run = passTask(pass, task);
    run.stage = &stage;
    _pieces->run(pass.outer, pieces, run);
    _statistics.drawables += static_cast<int>(pieces.size());
}

void CloseUpCamera::drawItem(const ScenePass& pass, const Task& task, Seen& seen, RegionContents& found)
{
    const CloseUpItem& item = _items[seen.item];
    const auto draw = [&](int layer, const DeformationChain& chain)
    {
        osg::StateSet* state = _now->layerStates[2 * seen.item + static_cast<std::size_t>(layer)];
        RegionFilter filter(_items, {seen.item}, culls(pass), _now->copies, _tessellated,
                            [&](const std::vector<std::size_t>&, std::vector<osg::StateSet*>& states)
                            { states.push_back(state); });
        CompensatingCullVisitor::Task run = passTask(pass, task);
        run.chain = &chain;
        run.program = _program;
        run.filter = &filter;
        run.stage = seen.stages[layer];
        _single->run(pass.outer, pass.scene, run);
        found.lowest = std::min(found.lowest, filter.contents[seen.item].lowest);
        found.highest = std::max(found.highest, filter.contents[seen.item].highest);
        _statistics.drawables += static_cast<int>(filter.count);
    };
    if (item.showsCloseUp())
    {
        seen.stages[0] = _now->layers.newStage(pass.outer);
        osg::ref_ptr<DeformationChain> lift = new DeformationChain;
        lift->add(new LiftFrame(item));
        draw(0, *lift);
    }
    seen.stages[1] = _now->layers.newStage(pass.outer);
    if (item.stretched()) draw(1, pass.chain);
    drawFence(pass, task, seen, found, *seen.stages[1]);
}

void CloseUpCamera::show(const ScenePass& pass, const Task& task, const std::vector<Seen>& all)
{
    if (!_layerProgram) _layerProgram = createLayerProgram();
    if (!_layerProgram) return;
    using Turn = CloseUpLayers::Turn;
    enum class What
    {
        All,
        Covered, // what hides all that lies behind it
        Edges    // what is behind them shows
    };
    // But for rounding to 255 values: the edges' cover is between none and all.
    const auto coverOf = [&](const Seen& seen)
    {
        return 0.985 * _items[seen.item].closeUp().getOpacity();
    };
    const auto put = [&](const Seen& seen, What what, Turn turn = Turn::Any,
                         const std::vector<CloseUpLayers::Other>& others = {})
    {
        const CloseUpItem& item = _items[seen.item];
        if (!item.showsCloseUp() || !seen.lifted) return;
        const double covered = coverOf(seen);
        _now->layers.show(pass.outer, _layerProgram,
                          {seen.layer, *seen.lifted, osg::Vec2i(seen.part.x, seen.part.y), task.samples,
                           task.opacity, task.depthTest, what != What::Edges,
                           what == What::Covered ? covered : 0.0, what == What::Edges ? covered : 1.0, turn,
                           seen.layer + 1, others});
    };
    const auto putAnchor =
        [&](const Seen& seen, Turn turn = Turn::Any, const std::vector<CloseUpLayers::Other>& others = {})
    {
        if (!_items[seen.item].marksGround()) return;
        _now->layers.show(pass.outer, _layerProgram,
                          {seen.layer + 1, seen.part, osg::Vec2i(seen.part.x, seen.part.y), task.samples,
                           task.opacity, task.depthTest, false, 0.0, 1.0, turn, -1, others});
    };
    if (!task.depthTest)
    {
        for (const Seen& seen : all)
        {
            putAnchor(seen);
            put(seen, What::All);
        }
        return;
    }
    if (all.size() == 1 && !_items[all.front().item].marksGround())
    {
        put(all.front(), What::All);
        return;
    }
    // The farthest first, as far as one is farther than another as a whole.
    std::vector<Seen> sorted = all;
    const auto depthOf = [&](const Seen& seen)
    {
        const CloseUpItem& item = _items[seen.item];
        return item.lifted(item.regionToEye().getTrans()).z();
    };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const Seen& one, const Seen& other) { return depthOf(one) < depthOf(other); });
    for (const Seen& seen : sorted)
        put(seen, What::Covered);
    // What keeps no depth: anchors, and then edges, since one that kept its own anchor off would be a pale line between them. Where
    // they cross those of a close-up that comes later, those pixels that are nearer wait for it. That is right for any two.
    std::vector<std::vector<CloseUpLayers::Other>> others(sorted.size());
    for (std::size_t i = 0; i < sorted.size(); ++i)
    {
        for (std::size_t k = i + 1; k < sorted.size(); ++k)
        {
            const Seen& other = sorted[k];
            if (sorted[i].part.overlaps(other.part) && _now->layers.together(sorted[i].layer, other.layer))
                others[i].push_back({other.layer, other.part, osg::Vec2i(other.part.x, other.part.y),
                                     _items[other.item].showsCloseUp() ? coverOf(other) : 0.0});
        }
    }
    for (const Turn turn : {Turn::First, Turn::Second})
    {
        for (std::size_t i = 0; i < sorted.size(); ++i)
        {
            if (turn == Turn::Second && others[i].empty()) continue;
            putAnchor(sorted[i], turn, others[i]);
            put(sorted[i], What::Edges, turn, others[i]);
        }
    }
}

std::string CloseUpCamera::cull(const ScenePass& pass, const Task& task)
{
    const bool starts = _overview->startsFrame(pass.outer);
    _single->startsFrame(pass.outer);
    _pieces->startsFrame(pass.outer);
    if (starts) _used = 0;
    if (_used == _traversals.size()) _traversals.push_back(std::make_unique<Traversal>());
    _now = _traversals[_used++].get();
    _now->use(pass.prefix, task);
    _now->layers.startFrame();
    // What was drawn in the last frame is no longer on its way, and copies keep the arrays of what has been deleted.
    for (std::size_t i = 0; starts && i < _traversals.size(); ++i)
        _traversals[i]->copies.purge();

    _items.clear();
    const osg::FrameStamp* stamp = pass.outer.getFrameStamp();
    const double time = stamp ? stamp->getSimulationTime() : 0.0;
    for (const osg::ref_ptr<CloseUp>& closeUp : task.closeUps)
        _items.emplace_back(*closeUp, pass.view, *pass.outer.getModelViewMatrix(), pass.chain, time);
    _tessellated = task.tessellation > 1 && tessellates(pass.outer) &&
                   std::any_of(_items.begin(), _items.end(),
                               [](const CloseUpItem& item) { return item.wantsVertices(); });
    setUp(pass, task, _items.size());
    setLayerStates(pass, task, _items.size());

    std::string sentence;
    const int perArray = std::max(2, std::min(task.maxLayers, gpuLayers(pass.outer)) / 2 * 2);
    bool single =
        task.pipeline == CloseUps::SINGLE_PASS || (task.pipeline == CloseUps::AUTOMATIC && singleIsCheaper());
    if (single && 2 * _items.size() > static_cast<std::size_t>(perArray))
    {
        single = false;
        sentence = "CloseUps has more layers than a texture array of this GPU (" + std::to_string(perArray) +
                   "), so the multi-pass pipeline draws.";
    }

    // What lies over the regions as the overview has it; with a single pass, this draws it.
    _statistics = {};
    std::vector<std::size_t> wanted(_items.size());
    std::iota(wanted.begin(), wanted.end(), std::size_t{0});
    RegionFilter filter(_items, wanted, culls(pass), _now->copies, _tessellated,
                        [&](const std::vector<std::size_t>& touched, std::vector<osg::StateSet*>& states)
                        {
                            if (single) collectGroups(pass, task, touched, states);
                        });
    CompensatingCullVisitor::Task run = passTask(pass, task);
    run.filter = &filter;
    osgUtil::RenderStage* layered = nullptr;
    if (single)
    {
        layered = _now->layers.newStage(pass.outer);
        run.stage = layered;
    }
    // Without a stage, too: it says what has shaders of its own.
    _program = pass.program(single || _tessellated ? amplifyingShaders(task.binding, _tessellated)
                                                   : plainShaders(task.binding));
    _fenceProgram = pass.program(fenceShaders(task.binding));
    run.program = _program;
    _overview->run(pass.outer, pass.scene, run);
    _levels = filter.levels;
    const bool shares = filter.drawables > 0 && !filter.foreign;
    _sharing = shares ? 1.0 * filter.touches / filter.drawables : 1.0;
    if (filter.foreign && (single || _tessellated))
    {
        _tessellated = false;
        _program = pass.program(plainShaders(task.binding));
    }
    if (single && filter.foreign)
    {
        single = false;
        if (task.pipeline == CloseUps::SINGLE_PASS)
            sentence = "Something in a close-up's region is not made of triangles or has a shader of its "
                       "own, so the multi-pass pipeline draws.";
    }

    std::vector<Seen> all;
    for (const std::size_t i : wanted)
    {
        RegionContents& found = filter.contents[i];
        if (found.empty()) continue;
        // Finer tiles may stand out a little.
        const double slack = 20.0 + 0.1 * (found.highest - found.lowest);
        if (!partOf(pass, _items[i], found.lowest - slack, found.highest + slack, found.longestEdge, true))
            continue;
        Seen seen = {i, {}, std::nullopt, 0, {nullptr, nullptr}};
        if (!single) drawItem(pass, task, seen, found);
        const std::optional<PixelRectangle> part =
            partOf(pass, _items[i], found.lowest, found.highest, found.longestEdge, true);
        if (!part) continue;
        seen.part = *part;
        seen.lifted = partOf(pass, _items[i], found.lowest, found.highest, found.longestEdge, false);
        seen.layer = static_cast<int>(2 * all.size());
        all.push_back(seen);
        widenDepths(pass, _items[i], found.lowest, found.highest, found.longestEdge);
    }
    if (all.empty()) return sentence;

    int width = 1, height = 1;
    for (const Seen& seen : all)
    {
        width = std::max(width, seen.part.width);
        height = std::max(height, seen.part.height);
    }
    const auto layers = static_cast<int>(2 * all.size());
    _now->layers.resize(layers, width * task.samples, height * task.samples, perArray);
    for (std::size_t i = 0; i < _items.size(); ++i)
        _now->values.set(i, {}); // what is not in sight draws nothing
    const osg::Viewport& viewport = *pass.outer.getViewport();
    for (const Seen& seen : all)
    {
        const osg::Vec2d shift(-2.0 * seen.part.x / viewport.width(), -2.0 * seen.part.y / viewport.height());
        CloseUpItem::Places places = task.textures.places[seen.item];
        places.sun = sunOf(_items[seen.item].closeUp());
        _now->values.set(seen.item,
                         _items[seen.item].values(places, shift, seen.layer, seen.layer + 1, task.samples));
    }

    const auto picture = CloseUpLayers::viewport(pass.outer, -1, osg::Vec2i(), task.samples);
    _now->base->setAttribute(picture);
    if (single) _now->layers.draw(pass.outer, *layered, -1, picture);
    for (Seen& seen : all)
    {
        const osg::Vec2i corner(seen.part.x, seen.part.y);
        const auto moved = CloseUpLayers::viewport(pass.outer, seen.layer, corner, task.samples);
        if (single)
        {
            // The layered stage has cleared all layers, and the anchor's own geometry comes into what it drew.
            seen.stages[1] = _now->layers.newStage(pass.outer);
            seen.stages[1]->setClearMask(0);
            drawFence(pass, task, seen, filter.contents[seen.item], *seen.stages[1]);
        }
        for (std::size_t which = 0; which < 2; ++which)
        {
            _now->layerStates[2 * seen.item + which]->setAttribute(moved);
            _now->fenceStates[2 * seen.item + which]->setAttribute(moved);
            if (!seen.stages[which]) continue;
            _now->layers.draw(pass.outer, *seen.stages[which], seen.layer + static_cast<int>(which), moved);
        }
    }
    show(pass, task, all);

    if (single) _statistics.drawables += static_cast<int>(filter.count);
    _statistics.pipeline = single ? CloseUps::SINGLE_PASS : CloseUps::MULTI_PASS;
    _statistics.closeUps = static_cast<int>(all.size());
    _statistics.layers = layers;
    _statistics.tessellated = _tessellated;
    _statistics.width = _now->layers.width();
    _statistics.height = _now->layers.height();
    return sentence;
}

void CloseUpCamera::resizeGLObjectBuffers(unsigned int size)
{
    for (const std::unique_ptr<Traversal>& each : _traversals)
    {
        each->values.resizeGLObjectBuffers(size);
        each->layers.resizeGLObjectBuffers(size);
        each->copies.resizeGLObjectBuffers(size);
        for (ContourFence& fence : each->fences)
            fence.resizeGLObjectBuffers(size);
    }
    osg::resizeGLObjectBuffers(_layerProgram, size);
}

void CloseUpCamera::releaseGLObjects(osg::State* state) const
{
    for (const std::unique_ptr<Traversal>& each : _traversals)
    {
        each->values.releaseGLObjects(state);
        each->layers.releaseGLObjects(state);
        each->copies.releaseGLObjects(state);
        for (const ContourFence& fence : each->fences)
            fence.releaseGLObjects(state);
    }
    if (_layerProgram) _layerProgram->releaseGLObjects(state);
}

} // namespace osgGeoFX
