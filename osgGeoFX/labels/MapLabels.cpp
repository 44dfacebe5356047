// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/MapLabels.h>

#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/labels/detail/LabelAtlas.h>

#include <osg/BlendFunc>
#include <osg/Depth>
#include <osg/Geometry>
#include <osg/Program>
#include <osg/View>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <cmath>
#include <deque>
#include <mutex>
#include <unordered_map>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Names that are looked at in a frame; more would find no room.
constexpr std::size_t mostCandidates = 700;
/// Frames whose places are kept until their depths are known.
constexpr std::size_t longestWait = 8;

// In the core profile's language, which both profiles compile.
const char* const vertexText = R"(#version 330 core
layout(location = 0) in vec4 place; // clip coordinates; the atlas'
layout(location = 1) in vec4 tint;
out vec2 texel;
out vec4 color;
void main()
{
    texel = place.zw;
    color = tint;
    gl_Position = vec4(place.xy, 0.0, 1.0);
}
)";
const char* const fragmentText = R"(#version 330 core
uniform sampler2D geofx_names;
in vec2 texel;
in vec4 color;
out vec4 shown;
void main()
{
    shown = texture(geofx_names, texel) * color;
}
)";

/// What one camera draws: quads of the atlas.
class Quads
{
public:
    Quads()
    {
        geometry->setDataVariance(osg::Object::DYNAMIC);
        geometry->setUseDisplayList(false);
        geometry->setUseVertexBufferObjects(true);
        geometry->setCullingActive(false);
        geometry->setVertexAttribArray(0, _places, osg::Array::BIND_PER_VERTEX);
        geometry->setVertexAttribArray(1, _tints, osg::Array::BIND_PER_VERTEX);
        geometry->addPrimitiveSet(_triangles);
        geometry->setComputeBoundingBoxCallback(new NoBox);
        // They change in each frame.
        _places->getVertexBufferObject()->setUsage(GL_STREAM_DRAW_ARB);
        _triangles->getElementBufferObject()->setUsage(GL_STREAM_DRAW_ARB);
    }

    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;

    void begin()
    {
        _places->clear();
        _tints->clear();
        _triangles->clear();
    }
    /// A strip of four corners: lower left, lower right, upper left, upper right; clip coordinates, and the atlas'.
    void add(const osg::Vec4 (&corners)[4], const osg::Vec4& tint)
    {
        const auto first = static_cast<GLuint>(_places->size());
        for (const osg::Vec4& corner : corners)
        {
            _places->push_back(corner);
            _tints->push_back(tint);
        }
        for (const GLuint k : {0u, 1u, 2u, 2u, 1u, 3u})
            _triangles->push_back(first + k);
    }
    void end()
    {
        _places->dirty();
        _tints->dirty();
        _triangles->dirty();
    }
    bool empty() const { return _triangles->empty(); }

    void releaseGLObjects(osg::State* state) const { geometry->releaseGLObjects(state); }
    void resizeGLObjectBuffers(unsigned int size) { geometry->resizeGLObjectBuffers(size); }

private:
    struct NoBox : public osg::Drawable::ComputeBoundingBoxCallback
    {
        osg::BoundingBox computeBound(const osg::Drawable&) const override { return {}; }
    };
    osg::ref_ptr<osg::Vec4Array> _places = new osg::Vec4Array;
    osg::ref_ptr<osg::Vec4Array> _tints = new osg::Vec4Array;
    osg::ref_ptr<osg::DrawElementsUInt> _triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
};

/// The names of a view's picture, from frame to frame.
struct ViewNames
{
    LabelLayout layout;
    unsigned int frame = ~0u; ///< of what follows
    std::vector<NameSet::Seen> seen;
    std::unordered_map<std::size_t, std::size_t> index; ///< of a name in `seen`
    std::vector<PlacedLabel> placed;

    struct Sight
    {
        bool visible = false;
        unsigned int frame = 0; ///< whose depths told
    };
    std::unordered_map<std::size_t, Sight> sight;
    /// Where names were drawn in frames whose depths are awaited.
    std::deque<std::pair<unsigned int, std::vector<NameSet::Seen>>> history;
};

/// A map from the view's clip coordinates, x and y, to those of a camera that draws a part of the view's picture.
struct PictureMap
{
    double scaleX = 1.0, scaleY = 1.0, moveX = 0.0, moveY = 0.0;

    /// Nothing if the camera shows the view from elsewhere.
    static std::optional<PictureMap> between(const osg::Camera& view, const osg::Camera& camera)
    {
        if (&view == &camera) return PictureMap();
        osg::Matrixd inverse;
        inverse.invert(view.getViewMatrix() * view.getProjectionMatrix());
        const osg::Matrixd way = inverse * camera.getViewMatrix() * camera.getProjectionMatrix();
        const double w = way(3, 3);
        constexpr double small = 1e-6;
        if (std::abs(way(0, 1)) > small || std::abs(way(1, 0)) > small || std::abs(way(0, 3)) > small ||
            std::abs(way(1, 3)) > small || std::abs(way(2, 3)) > small || std::abs(way(2, 0)) > small ||
            std::abs(way(2, 1)) > small || !(w > 0.0))
            return std::nullopt;
        return PictureMap{way(0, 0) / w, way(1, 1) / w, way(3, 0) / w, way(3, 1) / w};
    }
};

} // namespace

struct MapLabels::Views
{
    mutable std::mutex mutex;
    LabelAtlas atlas;
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    PerCamera<Quads> quads;
    std::map<const osg::Camera*, std::pair<osg::observer_ptr<const osg::Camera>, ViewNames>> views;

    Views()
    {
        const osg::ref_ptr<osg::Program> program = new osg::Program;
        program->setName("osgGeoFX names");
        program->addShader(new osg::Shader(osg::Shader::VERTEX, vertexText));
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragmentText));
        constexpr auto on = osg::StateAttribute::ON | osg::StateAttribute::PROTECTED;
        state->setAttributeAndModes(program, on);
        state->setTextureAttribute(0, &atlas.texture(), on);
        state->addUniform(new osg::Uniform("geofx_names", 0));
        state->setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA), on);
        state->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, false), on);
        state->setMode(GL_CULL_FACE, osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED);
        state->setRenderBinDetails(900001, "TraversalOrderBin");
    }

    ViewNames& of(const osg::Camera& camera)
    {
        for (auto entry = views.begin(); entry != views.end();)
            entry = entry->second.first.valid() ? std::next(entry) : views.erase(entry);
        auto& [observer, names] = views[&camera];
        observer = &camera;
        return names;
    }
};

MapLabels::MapLabels(EffectScene& scene, NameSet* names)
    : _scene(&scene), _names(names), _reader(new DepthReader), _views(std::make_unique<Views>())
{
    setCullingActive(false);
    // A name waits longer before it comes or goes, and reading costs.
    _reader->setInterval(3);
    _reader->setDepthConvention(scene.getDepthConvention());
}

MapLabels::~MapLabels() = default;

void MapLabels::setNames(NameSet* names)
{
    const std::lock_guard<std::mutex> lock(_views->mutex);
    _names = names;
    _views->views.clear();
    _views->atlas.clear();
}

void MapLabels::setRules(const LabelLayout::Rules& rules)
{
    const std::lock_guard<std::mutex> lock(_views->mutex);
    _rules = rules;
}

std::vector<MapLabels::Shown> MapLabels::shown(const osg::Camera& camera) const
{
    const std::lock_guard<std::mutex> lock(_views->mutex);
    std::vector<Shown> result;
    const auto found = _views->views.find(&camera);
    if (found == _views->views.end()) return result;
    for (const PlacedLabel& label : found->second.second.placed)
        result.push_back({label.id, label});
    return result;
}

namespace
{

/// What is known of places whose frames' depths have come.
void lookAtDepths(ViewNames& view, const DepthReader& reader, const std::vector<const osg::Camera*>& cameras)
{
    std::vector<std::shared_ptr<const DepthPicture>> pictures;
    for (const osg::Camera* const camera : cameras)
    {
        const auto picture = reader.picture(*camera);
        if (!picture) return;
        pictures.push_back(picture);
        // Parts of one picture are parts of one frame.
        if (picture->frame != pictures.front()->frame) return;
    }
    if (pictures.empty()) return;
    const unsigned int frame = pictures.front()->frame;
    while (!view.history.empty() && view.history.front().first < frame)
        view.history.pop_front();
    if (view.history.empty() || view.history.front().first != frame) return;
    for (const NameSet::Seen& seen : view.history.front().second)
        view.sight[seen.name] = {NameSet::isShown(seen, NameSet::placesShown(seen, pictures)), frame};
    view.history.pop_front();
    // What has not been in the picture for long is to be looked at anew.
    for (auto entry = view.sight.begin(); entry != view.sight.end();)
        entry = entry->second.frame + 120 < frame ? view.sight.erase(entry) : std::next(entry);
}

} // namespace

void MapLabels::traverse(osg::NodeVisitor& visitor)
{
    osg::Group::traverse(visitor);
    auto* const cull = dynamic_cast<osgUtil::CullVisitor*>(&visitor);
    osg::ref_ptr<EffectScene> scene;
    if (!cull || !_names || !_scene.lock(scene)) return;
    // Shadow maps and pictures in textures have no names.
    const osg::Camera* const camera = cull->getRenderStage()->getCamera();
    const osg::NodePath& path = cull->getNodePath();
    if (!camera || cull->getCurrentCamera() != camera || !camera->getViewport() ||
        std::any_of(path.begin(), path.end(), [](osg::Node* node) { return node->asCamera() != nullptr; }))
        return;
    const osg::View* const osgView = camera->getView();
    const osg::Camera* master = osgView ? osgView->getCamera() : nullptr;
    if (!master || !master->getViewport() || camera->getReferenceFrame() != osg::Transform::RELATIVE_RF ||
        !PictureMap::between(*master, *camera))
        master = camera;
    const PictureMap way = *PictureMap::between(*master, *camera);

    _reader->accept(visitor);
    Quads& quads = _views->quads.of(*cull);
    const osg::FrameStamp* const stamp = visitor.getFrameStamp();
    const unsigned int frame = stamp ? stamp->getFrameNumber() : 0;
    const double width = master->getViewport()->width(), height = master->getViewport()->height();
    const std::lock_guard<std::mutex> lock(_views->mutex);
    ViewNames& view = _views->of(*master);
    if (view.frame != frame)
    {
        view.frame = frame;
        // The cameras that draw the view's picture.
        std::vector<const osg::Camera*> cameras;
        if (osgView && master == osgView->getCamera() && camera != master)
        {
            for (unsigned int i = 0; i < osgView->getNumSlaves(); ++i)
            {
                const osg::Camera* const slave = osgView->getSlave(i)._camera.get();
                if (slave->getReferenceFrame() == osg::Transform::RELATIVE_RF && slave->getViewport() &&
                    osgView->getSlave(i)._useMastersSceneData && PictureMap::between(*master, *slave))
                    cameras.push_back(slave);
            }
        }
        else
            cameras.push_back(master);
        lookAtDepths(view, *_reader, cameras);

        view.seen = _names->inPicture(*scene, master->getViewMatrix(), master->getProjectionMatrix(), width,
                                      height, mostCandidates, stamp ? stamp->getSimulationTime() : 0.0);
        view.index.clear();
        std::vector<LabelCandidate> candidates;
        for (std::size_t i = 0; i < view.seen.size(); ++i)
        {
            NameSet::Seen& seen = view.seen[i];
            const auto known = view.sight.find(seen.name);
            seen.label.visible =
                seen.label.visible && _shown && known != view.sight.end() && known->second.visible;
            candidates.push_back(seen.label);
            view.index[seen.name] = i;
        }
        view.history.emplace_back(frame, view.seen);
        if (view.history.size() > longestWait) view.history.pop_front();
        view.layout.setRules(_rules);
        view.placed = view.layout.place(candidates, width, height, stamp ? stamp->getReferenceTime() : 0.0);
    }

    // All pictures before the first quad: where there is no room, they get other places.
    LabelAtlas& atlas = _views->atlas;
    const auto fill = [&]
    {
        for (const PlacedLabel& label : view.placed)
        {
            if (atlas.find(label.id)) continue;
            const osg::ref_ptr<osg::Image> picture = _names->text(label.id).image(1);
            if (picture && !atlas.add(label.id, *picture)) return false;
        }
        return true;
    };
    if (!fill())
    {
        atlas.clear();
        fill();
    }
    quads.begin();
    const double side = atlas.side();
    const auto corner = [&](const osg::Vec2d& pixel, double u, double v)
    {
        const double x = (2.0 * pixel.x() / width - 1.0) * way.scaleX + way.moveX;
        const double y = (2.0 * pixel.y() / height - 1.0) * way.scaleY + way.moveY;
        return osg::Vec4(osg::Vec4d(x, y, u, v));
    };
    const osg::Vec2d white = atlas.white();
    const auto rectangle =
        [&](const osg::Vec2d& low, const osg::Vec2d& high, const osg::Vec4& color, double alpha)
    {
        const osg::Vec4 corners[4] = {
            corner(low, white.x(), white.y()), corner({high.x(), low.y()}, white.x(), white.y()),
            corner({low.x(), high.y()}, white.x(), white.y()), corner(high, white.x(), white.y())};
        const float a = color.a() * static_cast<float>(alpha);
        quads.add(corners, {color.r() * a, color.g() * a, color.b() * a, a});
    };
    for (const PlacedLabel& label : view.placed)
    {
        const auto found = view.index.find(label.id);
        if (found == view.index.end()) continue;
        const NameStyle& style = _names->styleOf(_names->names()[label.id]);
        // The halo first, so that it lies below the line.
        const double half = 0.5 * style.lineWidth * _names->getScale();
        if (label.leader)
        {
            const osg::Vec2d foot = label.anchor, top(label.anchor.x(), label.corner.y());
            rectangle(foot - osg::Vec2d(2.0 * half, half), top + osg::Vec2d(2.0 * half, 0.0), style.text.halo,
                      0.7 * label.alpha);
            rectangle(foot - osg::Vec2d(half, 0.0), top + osg::Vec2d(half, 0.0), style.text.color,
                      label.alpha);
        }
        if (style.dot > 0.0)
        {
            const double radius = style.dot * _names->getScale();
            const osg::Vec2d ring(radius + half, radius + half), dot(radius, radius);
            rectangle(label.anchor - ring, label.anchor + ring, style.text.halo, label.alpha);
            rectangle(label.anchor - dot, label.anchor + dot, style.text.color, label.alpha);
        }
    }
    for (const PlacedLabel& label : view.placed)
    {
        const auto found = view.index.find(label.id);
        if (found == view.index.end()) continue;
        const std::optional<LabelAtlas::Place> place = atlas.find(label.id);
        if (!place) continue;
        const LabelText& text = _names->text(label.id);
        const auto alpha = static_cast<float>(label.alpha);
        const osg::Vec4 tint(alpha, alpha, alpha, alpha);
        const double u0 = place->x / side, u1 = (place->x + place->width) / side;
        const double v0 = place->y / side, v1 = (place->y + place->height) / side;
        // From the picture's corner to the text's origin, where image() puts it.
        const osg::Vec2d origin(std::ceil(text.left()) + 1.0,
                                place->height - (std::ceil(text.above()) + 1.0));
        const std::vector<osg::Vec2d>& curve = view.seen[found->second].label.curve;
        if (curve.empty())
        {
            const osg::Vec2d low =
                label.corner + osg::Vec2d(text.left(), text.height() - text.above()) - origin;
            const osg::Vec2d high = low + osg::Vec2d(place->width, place->height);
            const osg::Vec4 corners[4] = {corner(low, u0, v0), corner({high.x(), low.y()}, u1, v0),
                                          corner({low.x(), high.y()}, u0, v1), corner(high, u1, v1)};
            quads.add(corners, tint);
            continue;
        }
        const auto last = static_cast<double>(curve.size() - 1);
        const double middle = 0.5 * place->height;
        osg::Vec2d lows[2], highs[2];
        for (std::size_t i = 0; i < curve.size(); ++i)
        {
            osg::Vec2d along = curve[std::min(i + 1, curve.size() - 1)] - curve[i > 0 ? i - 1 : 0];
            along.normalize();
            const osg::Vec2d up(-along.y(), along.x());
            lows[0] = lows[1];
            highs[0] = highs[1];
            lows[1] = curve[i] - up * middle;
            highs[1] = curve[i] + up * middle;
            if (i == 0) continue;
            const double from = u0 + (u1 - u0) * static_cast<double>(i - 1) / last;
            const double to = u0 + (u1 - u0) * static_cast<double>(i) / last;
            const osg::Vec4 corners[4] = {corner(lows[0], from, v0), corner(lows[1], to, v0),
                                          corner(highs[0], from, v1), corner(highs[1], to, v1)};
            quads.add(corners, tint);
        }
    }
    quads.end();
    if (quads.empty()) return;
    cull->pushStateSet(_views->state.get());
    quads.geometry->accept(visitor);
    cull->popStateSet();
}

void MapLabels::resizeGLObjectBuffers(unsigned int size)
{
    osg::Group::resizeGLObjectBuffers(size);
    _reader->resizeGLObjectBuffers(size);
    _views->state->resizeGLObjectBuffers(size);
    _views->quads.resizeGLObjectBuffers(size);
}

void MapLabels::releaseGLObjects(osg::State* state) const
{
    osg::Group::releaseGLObjects(state);
    _reader->releaseGLObjects(state);
    _views->state->releaseGLObjects(state);
    _views->quads.releaseGLObjects(state);
}

} // namespace osgGeoFX
