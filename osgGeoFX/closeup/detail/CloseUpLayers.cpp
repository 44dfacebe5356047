// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/CloseUpLayers.h>

#include <osgGeoFX/closeup/detail/ArrayStorage.h>
#include <osgGeoFX/scene/detail/PassStage.h>

#include <osg/BlendFunc>
#include <osg/Depth>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

/// The render bin of the layers in the camera's picture: after opaque geometry, before transparent geometry.
constexpr int layerBin = 9;
constexpr unsigned int colorUnit = 0, depthUnit = 1;

osg::ref_ptr<osg::Texture2DArray> createTexture(GLint internalFormat, GLenum format, GLenum type, int width,
                                                int height, int layers)
{
    osg::ref_ptr<osg::Texture2DArray> texture = new osg::Texture2DArray;
    texture->setTextureSize(width, height, layers);
    texture->setInternalFormat(internalFormat);
    texture->setSubloadCallback(new ArrayStorage(format, type));
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

osg::ref_ptr<osg::FrameBufferObject> createTarget(osg::Texture2DArray& colors, osg::Texture2DArray& depths,
                                                  unsigned int layer)
{
    osg::ref_ptr<osg::FrameBufferObject> target = new osg::FrameBufferObject;
    // OpenGL wants both attachments layered, or neither.
    target->setAttachment(osg::Camera::COLOR_BUFFER, osg::FrameBufferAttachment(&colors, layer, 0));
    target->setAttachment(osg::Camera::DEPTH_BUFFER, osg::FrameBufferAttachment(&depths, layer, 0));
    return target;
}

/// Rounds up, so that a growing close-up does not need new textures for every pixel.
int rounded(int texels)
{
    constexpr int step = 64;
    return (texels + step - 1) / step * step;
}

} // namespace

CloseUpLayers::CloseUpLayers() : _square(createSquare(0.0f)) {}

void CloseUpLayers::resize(int layers, int width, int height, int perArray, const CameraDepth& depth,
                           GLenum colorFormat)
{
    width = rounded(width);
    height = rounded(height);
    const GLenum depthFormat = depth.format();
    const bool fits = width <= _width && height <= _height && layers <= _layers && perArray == _perArray &&
                      depthFormat == _depthFormat && colorFormat == _colorFormat;
    // Layers that are much too large give their memory back.
    const bool wasteful = 4.0 * layers * width * height < 1.0 * _layers * _width * _height;
    if (fits && !wasteful) return;
    _layers = layers;
    _width = width;
    _height = height;
    _perArray = perArray;
    _depthFormat = depthFormat;
    _colorFormat = colorFormat;
    _arrays.clear();
    for (int first = 0; first < layers; first += perArray)
    {
        const int count = std::min(perArray, layers - first);
        Array array;
        array.colors =
            createTexture(static_cast<GLint>(colorFormat), GL_RGBA, GL_FLOAT, width, height, count);
        array.depths = createTexture(static_cast<GLint>(depthFormat), GL_DEPTH_COMPONENT, GL_FLOAT, width,
                                     height, count);
        array.all =
            createTarget(*array.colors, *array.depths, osg::Camera::FACE_CONTROLLED_BY_GEOMETRY_SHADER);
        for (int layer = 0; layer < count; ++layer)
            array.single.push_back(
                createTarget(*array.colors, *array.depths, static_cast<unsigned int>(layer)));
        _arrays.push_back(array);
    }
}

void CloseUpLayers::startFrame()
{
    _stagesUsed = 0;
    _showsUsed = 0;
}

osgUtil::RenderStage* CloseUpLayers::newStage(osgUtil::CullVisitor& outer, const CameraDepth& depth)
{
    if (_stagesUsed == _stages.size()) _stages.push_back(createStage());
    osgUtil::RenderStage& stage = *_stages[_stagesUsed++];
    // The scene's lights shine in the layers, too.
    startStage(stage, outer, depth, osg::Vec4(0.0f, 0.0f, 0.0f, 0.0f));
    return &stage;
}

osgUtil::RenderStage* CloseUpLayers::surveyStage(osgUtil::CullVisitor& outer, const CameraDepth& depth)
{
    if (!_surveyStage) _surveyStage = createStage();
    startStage(*_surveyStage, outer, depth, osg::Vec4());
    return _surveyStage;
}

osg::ref_ptr<osg::Viewport> CloseUpLayers::viewport(osgUtil::CullVisitor& outer, int layer,
                                                    const osg::Vec2i& corner, int samples)
{
    const osg::Viewport& viewport = *outer.getViewport();
    // For one layer, the viewport moves its first pixel to the corner. For all layers together, the geometry stage
    // moves the picture.
    const double x = layer < 0 ? 0.0 : -corner.x() * samples;
    const double y = layer < 0 ? 0.0 : -corner.y() * samples;
    return new osg::Viewport(x, y, viewport.width() * samples, viewport.height() * samples);
}

void CloseUpLayers::draw(osgUtil::CullVisitor& outer, osgUtil::RenderStage& stage, int layer,
                         osg::Viewport* viewport)
{
    stage.setViewport(viewport);
    const Array& array = _arrays[layer < 0 ? 0 : static_cast<std::size_t>(layer / _perArray)];
    stage.setFrameBufferObject(layer < 0 ? array.all
                                         : array.single[static_cast<std::size_t>(layer % _perArray)]);
    outer.getCurrentRenderBin()->getStage()->addPreRenderStage(&stage, layerOrder);
}

void CloseUpLayers::show(osgUtil::CullVisitor& outer, osg::Program* program, const CameraDepth& depth,
                         const Show& what)
{
    if (_showsUsed == _shows.size()) _shows.push_back(new osg::StateSet);
    osg::StateSet& state = *_shows[_showsUsed++];
    const Array& array = _arrays[static_cast<std::size_t>(what.layer / _perArray)];
    const auto forced = osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    const auto on = osg::StateAttribute::ON | forced;
    const auto off = osg::StateAttribute::OFF | forced;
    state.setRenderBinDetails(layerBin, "RenderBin", osg::StateSet::OVERRIDE_PROTECTED_RENDERBIN_DETAILS);
    state.setNestRenderBins(false);
    state.setAttributeAndModes(program, on);
    state.setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA), on);
    state.setAttributeAndModes(
        new osg::Depth(what.depthTest ? depth.notBehind() : osg::Depth::ALWAYS, 0.0, 1.0, what.depthWrite),
        on);
    state.setMode(GL_DEPTH_TEST, on);
    depth.put(state);
    state.setMode(GL_CULL_FACE, off);
    state.setMode(GL_ALPHA_TEST, off);
    state.setTextureAttribute(colorUnit, array.colors, forced);
    state.setTextureAttribute(depthUnit, array.depths, forced);
    state.getOrCreateUniform("geofx_layerColors", osg::Uniform::INT)->set(static_cast<int>(colorUnit));
    state.getOrCreateUniform("geofx_layerDepths", osg::Uniform::INT)->set(static_cast<int>(depthUnit));
    const osg::Viewport& viewport = *outer.getViewport();
    state.getOrCreateUniform("geofx_layerOrigin", osg::Uniform::INT_VEC4)
        ->set(static_cast<int>(viewport.x()) + what.corner.x(),
              static_cast<int>(viewport.y()) + what.corner.y(), what.layer % _perArray, what.samples);
    state.getOrCreateUniform("geofx_layerOpacity", osg::Uniform::FLOAT)
        ->set(static_cast<float>(what.opacity));
    state.getOrCreateUniform("geofx_layerAlphas", osg::Uniform::FLOAT_VEC2)
        ->set(osg::Vec2(osg::Vec2d(what.above, what.upTo)));
    state.getOrCreateUniform("geofx_layerTurn", osg::Uniform::INT)->set(static_cast<int>(what.turn));
    state.getOrCreateUniform("geofx_layerAnchor", osg::Uniform::INT)
        ->set(what.anchorLayer < 0 ? -1 : what.anchorLayer % _perArray);
    const std::size_t others = std::min(what.others.size(), mostOthers);
    state.getOrCreateUniform("geofx_others", osg::Uniform::INT)->set(static_cast<int>(others));
    osg::Uniform* const origins =
        state.getOrCreateUniform("geofx_otherOrigins", osg::Uniform::INT_VEC4, mostOthers);
    osg::Uniform* const parts =
        state.getOrCreateUniform("geofx_otherParts", osg::Uniform::INT_VEC4, mostOthers);
    osg::Uniform* const covers =
        state.getOrCreateUniform("geofx_otherCovers", osg::Uniform::FLOAT, mostOthers);
    const int left = static_cast<int>(viewport.x()), bottom = static_cast<int>(viewport.y());
    for (std::size_t i = 0; i < others; ++i)
    {
        const Other& other = what.others[i];
        const auto at = static_cast<unsigned int>(i);
        origins->setElement(at, left + other.corner.x(), bottom + other.corner.y(), other.layer % _perArray,
                            0);
        parts->setElement(at, left + other.part.x, bottom + other.part.y,
                          left + other.part.x + other.part.width, bottom + other.part.y + other.part.height);
        covers->setElement(at, static_cast<float>(other.covers));
    }
    const auto share = [](int pixel, double size)
    {
        return static_cast<float>(2.0 * pixel / size - 1.0);
    };
    state.getOrCreateUniform("geofx_layerPart", osg::Uniform::FLOAT_VEC4)
        ->set(osg::Vec4(share(what.part.x, viewport.width()), share(what.part.y, viewport.height()),
                        share(what.part.x + what.part.width, viewport.width()),
                        share(what.part.y + what.part.height, viewport.height())));
    outer.pushStateSet(&state);
    outer.addDrawableAndDepth(_square, outer.getModelViewMatrix(), 0.0f);
    outer.popStateSet();
}

void CloseUpLayers::resizeGLObjectBuffers(unsigned int size)
{
    _square->resizeGLObjectBuffers(size);
    for (const Array& array : _arrays)
    {
        array.colors->resizeGLObjectBuffers(size);
        array.depths->resizeGLObjectBuffers(size);
        array.all->resizeGLObjectBuffers(size);
        for (const auto& target : array.single)
            target->resizeGLObjectBuffers(size);
    }
}

void CloseUpLayers::releaseGLObjects(osg::State* state) const
{
    _square->releaseGLObjects(state);
    for (const Array& array : _arrays)
    {
        array.colors->releaseGLObjects(state);
        array.depths->releaseGLObjects(state);
        array.all->releaseGLObjects(state);
        for (const auto& target : array.single)
            target->releaseGLObjects(state);
    }
}

} // namespace osgGeoFX
