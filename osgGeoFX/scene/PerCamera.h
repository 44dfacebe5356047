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

namespace osgGeoFX
{

/** What an effect keeps for each camera: for each cull visitor of OSG, and so for one thread at a time and for one of the frames
    that are on their way, and for each scene that hosts the effect. What belongs to visitors that are gone goes, too. */
template<class Data>
class PerCamera
{
public:
    /// The camera's own; other threads may ask for theirs at the same time.
    Data& of(osgUtil::CullVisitor& visitor, const osg::Group& scene)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        std::unique_ptr<Camera>& found = _all[{&visitor, &scene}];
        if (!found || !found->visitor.valid())
        {
            for (auto entry = _all.begin(); entry != _all.end();)
            {
                const bool gone =
                    entry->second && !entry->second->visitor.valid() && &entry->second != &found;
                entry = gone ? _all.erase(entry) : std::next(entry);
            }
            found = std::make_unique<Camera>();
            found->visitor = &visitor;
        }
        return found->data;
    }

    void releaseGLObjects(osg::State* state) const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto& [key, camera] : _all)
            camera->data.releaseGLObjects(state);
    }

private:
    struct Camera
    {
        osg::observer_ptr<osgUtil::CullVisitor> visitor;
        Data data;
    };
    mutable std::mutex _mutex;
    std::map<std::pair<osgUtil::CullVisitor*, const osg::Group*>, std::unique_ptr<Camera>> _all;
};

} // namespace osgGeoFX
