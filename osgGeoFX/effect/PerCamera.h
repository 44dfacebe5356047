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
    are in flight. Another Owner may take the place of the cull visitor, for example a camera's state set. Data of an
    owner that no longer exists is deleted when any owner asks next.

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
            const bool lives = entry->second->owner.valid();
            if (!lives) gone.push_back(std::move(entry->second));
            entry = lives ? std::next(entry) : _all.erase(entry);
        }
        std::unique_ptr<Camera>& found = _all[{&owner, scene}];
        if (!found)
        {
            found = std::make_unique<Camera>();
            found->owner = &owner;
        }
        return found->data;
    }
    Data& of(Owner& owner, const osg::Group& scene) { return of(owner, &scene); }

    /// Calls an action with the data of each.
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
    struct Camera
    {
        osg::observer_ptr<Owner> owner;
        Data data;
    };
    mutable std::mutex _mutex;
    std::map<std::pair<Owner*, const osg::Group*>, std::unique_ptr<Camera>> _all;
};

} // namespace osgGeoFX
