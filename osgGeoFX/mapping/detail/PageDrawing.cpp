// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/PageDrawing.h>

#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/detail/ProfileProgram.h>
#include <osgGeoFX/scene/detail/PassStage.h>

#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/PolygonMode>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Pages are drawn before all stages of effects, which may show them.
constexpr int pageOrder = -14;
constexpr int mostColumns = 32, mostRows = 64;
constexpr int bytesOfPage = 4 * MappingPage::side * MappingPage::side;

std::string withPrefix(std::string text, const std::string& prefix)
{
    const std::string word = "SLOT_";
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + prefix.size()))
        text.replace(at, word.size(), prefix);
    return text;
}

osg::ref_ptr<osg::Program> createProgram(const std::string& prefix)
{
    const ShaderLibrary library;
    osg::ref_ptr<osg::Program> program = new ProfileProgram;
    program->setName("osgGeoFX pages of mappings");
    const auto add = [&](osg::Shader::Type stage, const std::string& file)
    {
        program->addShader(
            ProfileProgram::createShader(stage, withPrefix(library.source(file), prefix), file));
    };
    add(osg::Shader::VERTEX, "stages/mappings.page.vert");
    add(osg::Shader::FRAGMENT, "stages/mappings.page.frag");
    return program;
}

} // namespace

/// Counts how often the pieces have been drawn.
class PageDrawing::Count : public osg::Drawable::DrawCallback
{
public:
    void drawImplementation(osg::RenderInfo& info, const osg::Drawable* drawable) const override
    {
        drawable->drawImplementation(info);
        ++_count;
    }
    unsigned int count() const { return _count; }

private:
    mutable std::atomic<unsigned int> _count{0};
};

PageDrawing::PageDrawing(int megabytes, int side) : _megabytes(megabytes), _drawn(new Count)
{
    const int slots = std::max(4, static_cast<int>(std::int64_t{megabytes} * 1048576 / bytesOfPage));
    const int along = std::max(2, side / MappingPage::side);
    _columns = std::min({mostColumns, along, slots});
    // As square as can be.
    while (_columns > 2 && _columns * _columns / 2 >= slots)
        _columns /= 2;
    _rows = std::min({mostRows, along, slots / _columns});
    const int width = _columns * MappingPage::side, height = _rows * MappingPage::side;
    _texture = new osg::Texture2D;
    _texture->setTextureSize(width, height);
    _texture->setInternalFormat(GL_RGBA8);
    _texture->setSourceFormat(GL_RGBA);
    _texture->setSourceType(GL_UNSIGNED_BYTE);
    _texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    _texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    _texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    _texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    _texture->setResizeNonPowerOfTwoHint(false);
    _target = new osg::FrameBufferObject;
    _target->setAttachment(osg::Camera::COLOR_BUFFER, osg::FrameBufferAttachment(_texture));
    _viewport = new osg::Viewport(0, 0, width, height);
    _vertices = new osg::Vec4Array;
    _quads = new osg::DrawArrays(GL_TRIANGLES, 0, 0);
    _geometry = new osg::Geometry;
    _geometry->setDataVariance(osg::Object::DYNAMIC);
    _geometry->setVertexArray(_vertices);
    _geometry->addPrimitiveSet(_quads);
    _geometry->setCullingActive(false);
    _geometry->setUseDisplayList(false);
    _geometry->setUseVertexBufferObjects(true);
    _vertices->getVertexBufferObject()->setUsage(GL_DYNAMIC_DRAW);
    _geometry->setDrawCallback(_drawn);
}

PageDrawing::~PageDrawing() = default;

void PageDrawing::makeState(const std::string& prefix)
{
    if (_state && _prefix == prefix) return;
    _prefix = prefix;
    _state = new osg::StateSet;
    constexpr auto forced = osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    _state->setAttributeAndModes(createProgram(prefix), osg::StateAttribute::ON | forced);
    _state->setAttributeAndModes(new osg::PolygonMode, osg::StateAttribute::ON | forced);
    // Not the camera's, which the states above have.
    _state->setAttribute(_viewport, forced);
    _state->setAttribute(new osg::ColorMask, forced);
    for (const GLenum mode : {GL_DEPTH_TEST, GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST,
                              GL_ALPHA_TEST, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_COLOR_LOGIC_OP})
        _state->setMode(mode, osg::StateAttribute::OFF | forced);
}

void PageDrawing::addPiece(const PageResidency::Piece& piece)
{
    const PlaneBox whole = piece.page.whole();
    const int firstColumn = piece.slot % _columns, firstRow = piece.slot / _columns;
    const osg::Vec2d origin(firstColumn, firstRow);
    const auto corner = [&](double x, double y)
    {
        // In whole texels of the page.
        const osg::Vec2d place(x, y);
        const osg::Vec2d texels = (place - whole.low) / piece.page.texel();
        const double column = origin.x() + texels.x() / MappingPage::side;
        const double row = origin.y() + texels.y() / MappingPage::side;
        return osg::Vec4(osg::Vec4d(2.0 * column / _columns - 1.0, 2.0 * row / _rows - 1.0, x, y));
    };
    // Whole texels, so that each is drawn or not.
    const double texel = piece.page.texel();
    const auto down = [&](double at, double from)
    {
        return from + std::floor((at - from) / texel + 1e-6) * texel;
    };
    const auto up = [&](double at, double from)
    {
        return from + std::ceil((at - from) / texel - 1e-6) * texel;
    };
    const double left = down(piece.part.low.x(), whole.low.x()),
                 low = down(piece.part.low.y(), whole.low.y());
    const double right = up(piece.part.high.x(), whole.low.x()),
                 high = up(piece.part.high.y(), whole.low.y());
    const osg::Vec4 a = corner(left, low), b = corner(right, low), c = corner(right, high),
                    d = corner(left, high);
    for (const osg::Vec4& vertex : {a, b, c, a, c, d})
        _vertices->push_back(vertex);
}

void PageDrawing::draw(const ScenePass& pass, const std::vector<PageResidency::Piece>& pieces,
                       const osg::Vec2d& blank)
{
    if (pieces.empty() && _blank) return;
    makeState(pass.prefix);
    _vertices->clear();
    if (!_blank)
    {
        const float right = 2.0f / static_cast<float>(_columns) - 1.0f;
        const float top = 2.0f / static_cast<float>(_rows) - 1.0f;
        const osg::Vec2f at(blank);
        for (const auto& [x, y] : {std::pair(-1.0f, -1.0f), std::pair(right, -1.0f), std::pair(right, top),
                                   std::pair(-1.0f, -1.0f), std::pair(right, top), std::pair(-1.0f, top)})
            _vertices->push_back(osg::Vec4(x, y, at.x(), at.y()));
        _blank = true;
    }
    for (const PageResidency::Piece& piece : pieces)
        addPiece(piece);
    _vertices->dirty();
    _quads->setCount(static_cast<GLsizei>(_vertices->size()));
    _quads->dirty();
    if (!_stage) _stage = createStage();
    startStage(*_stage, pass.outer, pass.depth, osg::Vec4());
    _stage->setClearMask(0);
    _stage->setViewport(_viewport);
    _stage->setFrameBufferObject(_target);
    pass.outer.getCurrentRenderBin()->getStage()->addPreRenderStage(_stage, pageOrder);
    ScenePass::Drawing drawing;
    drawing.state = _state;
    drawing.stage = _stage;
    pass.draw({{_geometry, osg::Matrixd(), nullptr}}, drawing);
    _before = _drawn->count();
    _context = pass.outer.getState() ? pass.outer.getState()->getContextID() : 0;
}

bool PageDrawing::holds(const ScenePass& pass) const
{
    if (!_before) return true;
    const osg::State* state = pass.outer.getState();
    return _drawn->count() != *_before && (!state || state->getContextID() == _context);
}

void PageDrawing::forget()
{
    _blank = false;
    _before.reset();
}

void PageDrawing::releaseGLObjects(osg::State* state) const
{
    _texture->releaseGLObjects(state);
    _target->releaseGLObjects(state);
    _geometry->releaseGLObjects(state);
    if (_state) _state->releaseGLObjects(state);
}

void PageDrawing::resizeGLObjectBuffers(unsigned int size)
{
    _texture->resizeGLObjectBuffers(size);
    _target->resizeGLObjectBuffers(size);
    _geometry->resizeGLObjectBuffers(size);
    if (_state) _state->resizeGLObjectBuffers(size);
}

} // namespace osgGeoFX
