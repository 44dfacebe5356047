// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/lines/MapLines.h>

#include <osgGeoFX/effect/DepthConvention.h>
#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/BlendFunc>
#include <osg/Depth>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/Program>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// After the ground, what stands on it, and its strokes; before names.
constexpr int casingBin = 20, lineBin = 21;
/// Points of a line in one drawable, so that culling can leave out parts of it.
constexpr std::size_t pointsOfPart = 64;
/// Cells along the longer side of all lines; each has a drawable for each style.
constexpr double cellsAlong = 16.0;
/// By how much the box of a drawable is larger than its points, for the width, as a share of the radius.
constexpr float roomOfWidth = 0.15f;
/// Dashes that are shorter on the picture are doubled.
constexpr double shortestDash = 6.0;

osg::ref_ptr<osg::Program> makeProgram()
{
    osg::ref_ptr<osg::Program> program =
        ShaderLibrary::createProgram("osgGeoFX lines", "stages/lines.vert", "stages/lines.frag");
    if (!program) return new osg::Program;
    try
    {
        program->addShader(ShaderLibrary().createShader(osg::Shader::GEOMETRY, "stages/lines.geom"));
    }
    catch (const ShaderError& error)
    {
        OSG_WARN << "osgGeoFX: " << error.what() << std::endl;
    }
    EffectScene::addFunctions(*program);
    return program;
}

/// What one camera's picture is like.
struct View
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    osg::ref_ptr<osg::Uniform> viewport = new osg::Uniform(osg::Uniform::FLOAT_VEC4, "geofx_linesViewport");
    osg::ref_ptr<osg::Uniform> upward = new osg::Uniform(osg::Uniform::FLOAT_VEC4, "geofx_linesUpward");
    bool reversed = false;

    View()
    {
        state->setDataVariance(osg::Object::DYNAMIC);
        state->addUniform(viewport);
        state->addUniform(upward);
        setDepth();
    }
    void setDepth()
    {
        state->setAttributeAndModes(
            new osg::Depth(reversed ? osg::Depth::GEQUAL : osg::Depth::LEQUAL, 0.0, 1.0, false),
            osg::StateAttribute::ON | osg::StateAttribute::PROTECTED);
    }
    void releaseGLObjects(osg::State* target) const { state->releaseGLObjects(target); }
    void resizeGLObjectBuffers(unsigned int size) { state->resizeGLObjectBuffers(size); }
};

/// Whether the scene above a node has a globe for its ground.
bool isOnGlobe(const osg::NodePath& path)
{
    for (const osg::Node* each : path)
        if (const auto* scene = dynamic_cast<const EffectScene*>(each))
            return scene->ground().ellipsoid.valid();
    return false;
}

/// A drawable in the making: parts of lines of one style, near each other.
class Cell
{
public:
    void add(const std::vector<osg::Vec3d>& places, const std::vector<double>& along, std::size_t first,
             std::size_t last)
    {
        if (_vertices->empty()) _origin = places[first];
        for (std::size_t i = first; i <= last; ++i)
        {
            if (i > first)
            {
                _segments->push_back(static_cast<GLuint>(_vertices->size() - 1));
                _segments->push_back(static_cast<GLuint>(_vertices->size()));
            }
            _vertices->push_back(osg::Vec3(places[i] - _origin));
            _along->push_back(osg::Vec2(static_cast<float>(along[i]), 0.0f));
        }
    }

    osg::ref_ptr<osg::Node> make() const
    {
        const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setUseDisplayList(false);
        geometry->setUseVertexBufferObjects(true);
        geometry->setVertexArray(_vertices);
        geometry->setTexCoordArray(0, _along, osg::Array::BIND_PER_VERTEX);
        geometry->addPrimitiveSet(_segments);
        // A line is wider than its points are, and culling must not cut it at the picture's border.
        osg::BoundingBox box = geometry->getBoundingBox();
        const osg::Vec3 room(roomOfWidth * box.radius(), roomOfWidth * box.radius(),
                             roomOfWidth * box.radius());
        box.expandBy(box._min - room);
        box.expandBy(box._max + room);
        geometry->setInitialBound(box);
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrixd::translate(_origin));
        place->addChild(geometry);
        return place;
    }

private:
    osg::Vec3d _origin;
    osg::ref_ptr<osg::Vec3Array> _vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> _along = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUInt> _segments = new osg::DrawElementsUInt(GL_LINES);
};

/// The cells of each style.
std::map<std::string, std::map<std::vector<int>, Cell>> cellsOf(const std::vector<MapLine>& lines)
{
    osg::BoundingBoxd box;
    for (const MapLine& line : lines)
        for (const osg::Vec3d& place : line.places)
            box.expandBy(place);
    const osg::Vec3d size = box._max - box._min;
    const double side = std::max({size.x(), size.y(), size.z(), 1.0}) / cellsAlong;
    std::map<std::string, std::map<std::vector<int>, Cell>> cells;
    for (const MapLine& line : lines)
    {
        std::vector<double> along = {0.0};
        for (std::size_t i = 1; i < line.places.size(); ++i)
            along.push_back(along.back() + (line.places[i] - line.places[i - 1]).length());
        for (std::size_t first = 0; first + 1 < line.places.size(); first += pointsOfPart)
        {
            const std::size_t last = std::min(first + pointsOfPart, line.places.size() - 1);
            std::vector<int> cell;
            for (int axis = 0; axis < 3; ++axis)
                cell.push_back(
                    static_cast<int>(std::floor((line.places[first][axis] - box._min[axis]) / side)));
            cells[line.style][cell].add(line.places, along, first, last);
        }
    }
    return cells;
}

} // namespace

struct MapLines::Drawing
{
    osg::ref_ptr<osg::Program> program = makeProgram();
    struct Kind
    {
        LineStyle style;
        osg::ref_ptr<osg::Group> lines = new osg::Group;
        osg::ref_ptr<osg::StateSet> line = new osg::StateSet, casing; ///< no casing: null
    };
    std::vector<Kind> kinds;
    PerCamera<View> views;
    std::mutex mutex;
    osg::Vec2d size; ///< of the viewport of the last camera, pixels
};

MapLines::MapLines(std::vector<MapLine> lines, std::map<std::string, LineStyle> styles)
    : _lines(std::move(lines)), _styles(std::move(styles)), _drawing(std::make_unique<Drawing>())
{
    constexpr auto on = osg::StateAttribute::ON | osg::StateAttribute::PROTECTED;
    osg::StateSet& state = *getOrCreateStateSet();
    state.setAttributeAndModes(_drawing->program, on);
    state.setAttributeAndModes(new osg::BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA), on);
    state.setMode(GL_CULL_FACE, osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED);
    // Maps' lines are no ground, which panorama maps would paint.
    state.setDefine("GEOFX_PAINTED", osg::StateAttribute::OFF);
    state.setDefine("GEOFX_DETAIL", osg::StateAttribute::OFF);

    auto cells = cellsOf(_lines);
    std::vector<std::string> order;
    for (const auto& [name, all] : cells)
        order.push_back(name);
    std::stable_sort(order.begin(), order.end(),
                     [&](const std::string& a, const std::string& b)
                     { return lineStyleOf(_styles, a).rank < lineStyleOf(_styles, b).rank; });
    for (const std::string& name : order)
    {
        Drawing::Kind kind;
        kind.style = lineStyleOf(_styles, name);
        if (!kind.style.shown) continue;
        for (const auto& [place, cell] : cells[name])
            kind.lines->addChild(cell.make());
        addChild(kind.lines);
        kind.line->setRenderBinDetails(lineBin, "TraversalOrderBin");
        // All outlines before all lines, so that crossings are open.
        if (kind.style.casingWidth > 0.0)
        {
            kind.casing = new osg::StateSet;
            kind.casing->setRenderBinDetails(casingBin, "TraversalOrderBin");
        }
        _drawing->kinds.push_back(kind);
    }
    describe();
}

MapLines::~MapLines() = default;

void MapLines::setScale(double scale)
{
    if (!(scale > 0.0)) return;
    _scale = scale;
    describe();
}

void MapLines::setNearer(double share)
{
    if (!(share >= 0.0 && share <= 0.1)) return;
    _nearer = share;
    describe();
}

void MapLines::describe()
{
    const auto number = [](double value)
    {
        return static_cast<float>(value);
    };
    for (const Drawing::Kind& kind : _drawing->kinds)
    {
        const LineStyle& style = kind.style;
        for (osg::StateSet* const state : {kind.line.get(), kind.casing.get()})
        {
            if (!state) continue;
            const bool casing = state == kind.casing;
            state->getOrCreateUniform("geofx_linesWidth", osg::Uniform::FLOAT_VEC4)
                ->set(osg::Vec4(number(style.ground), number(_scale * style.least),
                                number(_scale * style.width),
                                number(casing ? _scale * style.casingWidth : 0.0)));
            state->getOrCreateUniform("geofx_linesNearer", osg::Uniform::FLOAT_VEC2)
                ->set(osg::Vec2(number(_nearer), number(style.hand)));
            state->getOrCreateUniform("geofx_linesColor", osg::Uniform::FLOAT_VEC4)
                ->set(casing ? style.casing : style.color);
            state->getOrCreateUniform("geofx_linesDashes", osg::Uniform::FLOAT_VEC3)
                ->set(osg::Vec3(number(casing ? 0.0 : style.dash), number(style.gap),
                                number(_scale * shortestDash)));
        }
    }
}

void MapLines::traverse(osg::NodeVisitor& visitor)
{
    auto* const cull = dynamic_cast<osgUtil::CullVisitor*>(&visitor);
    // Rays meet the ground, not its lines.
    if (visitor.getVisitorType() == osg::NodeVisitor::INTERSECTION_VISITOR) return;
    if (!cull)
    {
        osg::Group::traverse(visitor);
        return;
    }
    if (!_shown) return;
    // The kit's passes cull before they have a viewport; they show the same picture.
    osg::Vec2d size;
    {
        const std::lock_guard<std::mutex> lock(_drawing->mutex);
        if (const osg::Viewport* const viewport = cull->getViewport())
            _drawing->size.set(viewport->width(), viewport->height());
        size = _drawing->size;
    }
    if (!(size.x() > 0.0 && size.y() > 0.0)) return;
    View& view = _drawing->views.of(*cull);
    view.viewport->set(osg::Vec4(osg::Vec4d(size.x(), size.y(), 1.0 / size.x(), 1.0 / size.y())));
    const osg::Matrixd& modelView = *cull->getModelViewMatrix();
    if (isOnGlobe(visitor.getNodePath()))
        view.upward->set(osg::Vec4(osg::Vec4d(modelView.getTrans(), 1.0)));
    else
        view.upward->set(
            osg::Vec4(osg::Vec4d(osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), modelView), 0.0)));
    const bool reversed = cull->getProjectionMatrix() && CameraDepth::reverses(*cull->getProjectionMatrix());
    if (reversed != view.reversed)
    {
        view.reversed = reversed;
        view.setDepth();
    }
    cull->pushStateSet(view.state);
    // States with uniforms are not in the graph: where OSG compiles a graph in a core profile, it sets uniforms of the program for the
    // other profile.
    for (const Drawing::Kind& kind : _drawing->kinds)
    {
        for (osg::StateSet* const state : {kind.casing.get(), kind.line.get()})
        {
            if (!state) continue;
            cull->pushStateSet(state);
            kind.lines->accept(visitor);
            cull->popStateSet();
        }
    }
    cull->popStateSet();
}

void MapLines::resizeGLObjectBuffers(unsigned int size)
{
    osg::Group::resizeGLObjectBuffers(size);
    _drawing->views.resizeGLObjectBuffers(size);
    for (const Drawing::Kind& kind : _drawing->kinds)
        for (osg::StateSet* const state : {kind.casing.get(), kind.line.get()})
            if (state) state->resizeGLObjectBuffers(size);
}

void MapLines::releaseGLObjects(osg::State* state) const
{
    osg::Group::releaseGLObjects(state);
    _drawing->views.releaseGLObjects(state);
    for (const Drawing::Kind& kind : _drawing->kinds)
        for (const osg::StateSet* const each : {kind.casing.get(), kind.line.get()})
            if (each) each->releaseGLObjects(state);
}

} // namespace osgGeoFX
