// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/CloseUpStates.h>

#include <osgGeoFX/effect/detail/GlobeFrame.h>

#include <osg/PatchParameter>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace osgGeoFX
{

namespace
{

/// The texels of a mask, and the pixels, that one part of a tessellated edge spans.
constexpr float texelsOfPart = 1.0f, pixelsOfPart = 6.0f;

} // namespace

void CloseUpStates::use(const std::string& prefix, const CloseUpTask& task)
{
    std::vector<int> units(std::begin(task.units), std::end(task.units));
    if (_prefix == prefix && _units == units && _binding == task.binding) return;
    _prefix = prefix;
    _units = std::move(units);
    _binding = task.binding;
    _base = new osg::StateSet;
    _groups.clear();
    _layers.clear();
    _fences.clear();
}

void CloseUpStates::setUp(const ScenePass& pass, const CloseUpTask& task,
                          const std::vector<CloseUpItem>& items, bool tessellated)
{
    values.resize(items.size());
    const auto forced =
        osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    // A layer keeps the nearest fragment. It is blended with the picture when it is shown.
    _base->setMode(GL_BLEND, forced);
    setTextures(task);
    _base->getOrCreateUniform(_prefix + "quality", osg::Uniform::FLOAT_VEC4)
        ->set(osg::Vec4(static_cast<float>(task.samples), static_cast<float>(task.textures.normalLayer),
                        static_cast<float>(CloseUpTextures::tableWidth), 0.0f));
    const osg::Viewport& viewport = *pass.outer.getViewport();
    _base->getOrCreateUniform(_prefix + "window", osg::Uniform::FLOAT_VEC4)
        ->set(osg::Vec4(
            osg::Vec4d(viewport.x(), viewport.y(), 0.5 * viewport.width(), 0.5 * viewport.height())));
    _base->getOrCreateUniform(_prefix + "only", osg::Uniform::INT)->set(-1);
    if (tessellated) setTessellation(pass, task, items);
    setDefines(pass, task, items);
    setSurface(pass, task.data);
    setLayers(items);
}

void CloseUpStates::setTextures(const CloseUpTask& task)
{
    const char* const names[3] = {"masks", "tables", "surfaces"};
    osg::Texture* const textures[3] = {task.textures.masks, task.textures.tables, task.textures.surfaces};
    for (std::size_t i = 0; i < 3; ++i)
    {
        _base->setTextureAttribute(static_cast<unsigned int>(task.units[i]), textures[i]);
        _base->getOrCreateUniform(_prefix + names[i], osg::Uniform::INT)->set(task.units[i]);
    }
}

void CloseUpStates::setTessellation(const ScenePass& pass, const CloseUpTask& task,
                                    const std::vector<CloseUpItem>& items)
{
    const osg::Matrixd& projection = pass.view.image.projection;
    const bool perspective = projection(3, 3) == 0.0;
    const double pixels =
        (perspective ? 1.0 : -1.0) * pass.outer.getViewport()->height() * std::abs(projection(1, 1)) / 2.0;
    const double roundness = std::accumulate(items.begin(), items.end(), 0.0,
                                             [](double most, const CloseUpItem& item)
                                             { return std::max(most, item.closeUp().getRoundness()); });
    _base->setAttribute(new osg::PatchParameter(3));
    _base->getOrCreateUniform(_prefix + "fineness", osg::Uniform::FLOAT_VEC4)
        ->set(osg::Vec4(static_cast<float>(task.tessellation), texelsOfPart, pixelsOfPart,
                        static_cast<float>(pixels)));
    _base->getOrCreateUniform(_prefix + "roundness", osg::Uniform::FLOAT)->set(static_cast<float>(roundness));
}

void CloseUpStates::define(osg::StateSet& state, const char* name, bool needed) const
{
    state.setDefine(_prefix + name, needed ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
}

void CloseUpStates::setDefines(const ScenePass& pass, const CloseUpTask& task,
                               const std::vector<CloseUpItem>& items)
{
    // Code that no item needs is not compiled, since some GPUs run through all branches.
    define(*_base, "MASKED",
           std::any_of(items.begin(), items.end(),
                       [](const CloseUpItem& item) { return item.cutByVertices() || item.stretched(); }));
    define(*_base, "DATA", task.data != nullptr);
    _base->setDefine("GEOFX_LAYER", osg::StateAttribute::ON);
    define(*_base, "ROUND", task.data && pass.view.ground.ellipsoid);
}

void CloseUpStates::setSurface(const ScenePass& pass, const SurfaceData* data)
{
    osg::Vec4d globe, curve, area;
    osg::Matrixd toSurface;
    if (data)
    {
        const osg::EllipsoidModel* ellipsoid = pass.view.ground.ellipsoid;
        toSurface = osg::Matrixd::inverse(data->frameToWorld(ellipsoid) * pass.view.modelView);
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
    _base->getOrCreateUniform(_prefix + "toSurface", osg::Uniform::FLOAT_MAT4)->set(osg::Matrixf(toSurface));
    _base->getOrCreateUniform(_prefix + "globe", osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(globe));
    _base->getOrCreateUniform(_prefix + "curve", osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(curve));
    _base->getOrCreateUniform(_prefix + "surfaceArea", osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(area));
}

void CloseUpStates::setLayers(const std::vector<CloseUpItem>& items)
{
    while (_layers.size() < 2 * items.size())
    {
        const std::size_t item = _layers.size() / 2;
        const auto which = static_cast<int>(_layers.size() % 2);
        const int place = CloseUpItems::placeInBlock(item);
        osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        state->getOrCreateUniform(_prefix + "layer", osg::Uniform::INT)->set(2 * place + which);
        state->getOrCreateUniform(_prefix + "only", osg::Uniform::INT)->set(which);
        state->getOrCreateUniform(_prefix + "targets", osg::Uniform::INT_VEC4)->set(place, 0, 0, 1);
        state->setAttribute(values.binding(CloseUpItems::blockOf(item), _binding));
        _layers.push_back(state);
    }
    for (std::size_t i = 0; i < items.size(); ++i)
    {
        define(layer(i, 0), "MASKED", items[i].cutByVertices());
        define(layer(i, 1), "MASKED", items[i].stretched());
    }
    while (_fences.size() < 2 * items.size())
        _fences.push_back(new osg::StateSet);
}

osg::StateSet* CloseUpStates::group(const std::vector<std::size_t>& items)
{
    osg::ref_ptr<osg::StateSet>& state = _groups[items];
    if (!state)
    {
        state = new osg::StateSet;
        int targets[4] = {0, 0, 0, static_cast<int>(items.size())};
        for (std::size_t i = 0; i < items.size(); ++i)
            targets[i] = CloseUpItems::placeInBlock(items[i]);
        state->getOrCreateUniform(_prefix + "targets", osg::Uniform::INT_VEC4)
            ->set(targets[0], targets[1], targets[2], targets[3]);
        state->setAttribute(values.binding(CloseUpItems::blockOf(items.front()), _binding));
    }
    return state;
}

} // namespace osgGeoFX
