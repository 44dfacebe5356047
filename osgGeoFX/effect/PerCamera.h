// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Group>
#include <osg/observer_ptr>
#include <osgUtil/CullVisitor>

#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** Data that an effect keeps for each camera, and for each scene that hosts the effect.

    A camera is known by its cull visitor of OSG. So one thread at a time uses the data, for one of the frames that
    are in flight. Another Owner may take the place of the cull visitor, for example a camera's state set.

    Data of an owner that no longer exists is deleted when any owner asks next. Data of a scene that no longer exists is deleted
    when the same owner asks next, or is gone: until then a thread may still draw the owner's last frame with it.

    @ingroup effect */
template<class Data, class Owner = osgUtil::CullVisitor>
class PerCamera
{
public:
    /// The data of an owner, made at the first call. Other threads may ask for theirs at the same time.
    Data& of(Owner& owner, const osg::Group* scene = nullptr)
    {
        // Let go of when the lock is, since it may take others.
        std::vector<std::unique_ptr<Camera>> gone;
        const std::lock_guard<std::mutex> lock(_mutex);
        for (auto entry = _all.begin(); entry != _all.end();)
        {
            const bool lives = entry->second->lives(entry->first, &owner);
            if (!lives) gone.push_back(std::move(entry->second));
            entry = lives ? std::next(entry) : _all.erase(entry);
        }
        std::unique_ptr<Camera>& found = _all[{&owner, scene}];
        if (!found)
        {
            found = std::make_unique<Camera>();
            found->owner = &owner;
            found->scene = scene;
        }
        return found->data;
    }
    Data& of(Owner& owner, const osg::Group& scene) { return of(owner, &scene); }

    /// Deletes all data of a scene. Only where whatever a frame on its way still draws with is kept by that frame.
    void forget(const osg::Group& scene)
    {
        std::vector<std::unique_ptr<Camera>> gone;
        const std::lock_guard<std::mutex> lock(_mutex);
        for (auto entry = _all.begin(); entry != _all.end();)
        {
            const bool stays = entry->first.second != &scene;
            if (!stays) gone.push_back(std::move(entry->second));
            entry = stays ? std::next(entry) : _all.erase(entry);
        }
    }

    /// Calls an action with the data of each.
    template<class Action>
    void each(const Action& action)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto& [key, camera] : _all)
            action(camera->data);
    }
    template<class Action>
    void each(const Action& action) const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto& [key, camera] : _all)
            action(static_cast<const Data&>(camera->data));
    }

    void releaseGLObjects(osg::State* state) const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto& [key, camera] : _all)
            camera->data.releaseGLObjects(state);
    }

    void resizeGLObjectBuffers(unsigned int size)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto& [key, camera] : _all)
            camera->data.resizeGLObjectBuffers(size);
    }

private:
    using Key = std::pair<Owner*, const osg::Group*>;
    struct Camera
    {
        osg::observer_ptr<Owner> owner;
        osg::observer_ptr<const osg::Group>
            scene; ///< observed, since another scene may come to the address of a former one
        Data data;

        bool lives(const Key& key, const Owner* asking) const
        {
            return owner.valid() && (key.first != asking || !key.second || scene.valid());
        }
    };
    mutable std::mutex _mutex;
    std::map<Key, std::unique_ptr<Camera>> _all;
};

} // namespace osgGeoFX
