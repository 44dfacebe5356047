// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/detail/ProfileProgram.h>
#include <osgGeoFX/scene/detail/ContextWatch.h>

#include <osg/ContextData>
#include <osg/GLObjects>
#include <osg/State>

#include <iterator>
#include <map>
#include <mutex>

namespace osgGeoFX
{

namespace
{

/// An object of one graphics context. OSG calls it while a closing context is still current.
class Closing : public osg::GraphicsObjectManager
{
public:
    explicit Closing(unsigned int context) : osg::GraphicsObjectManager("osgGeoFX effects", context) {}

    void add(const std::vector<osg::observer_ptr<Effect>>& effects)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const osg::observer_ptr<Effect>& effect : effects)
        {
            osg::observer_ptr<Effect>& known = _effects[effect.get()];
            if (known.valid()) continue;
            known = effect;
            forgetGone();
        }
    }

    void flushDeletedGLObjects(double, double&) override {}
    void flushAllDeletedGLObjects() override {}
    void deleteAllGLObjects() override { release(); }
    void discardAllGLObjects() override { release(); }

private:
    void forgetGone()
    {
        for (auto entry = _effects.begin(); entry != _effects.end();)
            entry = entry->second.valid() ? std::next(entry) : _effects.erase(entry);
    }

    void release()
    {
        std::map<const Effect*, osg::observer_ptr<Effect>> effects;
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            effects.swap(_effects);
        }
        // The context's own osg::State is not known here. Effects ask a state only for the number of its context.
        const osg::ref_ptr<osg::State> state = new osg::State;
        state->setContextID(_contextID);
        for (const auto& [address, watched] : effects)
        {
            osg::ref_ptr<Effect> effect;
            if (watched.lock(effect)) effect->releaseGLObjects(state);
        }
        ProfileProgram::releaseAll(*state);
    }

    std::mutex _mutex;
    std::map<const Effect*, osg::observer_ptr<Effect>> _effects;
};

} // namespace

ContextWatch::ContextWatch(const std::vector<osg::ref_ptr<Effect>>& effects)
    : _effects(effects.begin(), effects.end()), _ofScene(true)
{
}

ContextWatch::ContextWatch(const ContextWatch& other, const osg::CopyOp& copy)
    : osg::StateAttribute(other, copy), _effects(other._effects), _ofScene(other._ofScene)
{
}

ContextWatch::~ContextWatch() = default;

int ContextWatch::compare(const osg::StateAttribute& other) const
{
    COMPARE_StateAttribute_Types(ContextWatch, other);
    if (_ofScene != rhs._ofScene) return _ofScene ? 1 : -1;
    if (_effects == rhs._effects) return 0;
    return _effects < rhs._effects ? -1 : 1;
}

void ContextWatch::apply(osg::State& state) const
{
    // OSG also applies a watch of no scene.
    if (_ofScene) osg::get<Closing>(state.getContextID())->add(_effects);
}

} // namespace osgGeoFX
