// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Group>
#include <osg/NodeVisitor>
#include <osgDB/Options>

#include <chrono>
#include <mutex>
#include <string>

namespace osgGeoFX
{

/** Draws what the parent of a tile draws, instead of a tile that cannot be read. It asks the pager for the file again,
    when it is in sight after a while, and is the tile's parent when the tile comes. */
class StandIn : public osg::Group
{
public:
    using Clock = std::chrono::steady_clock;

    /// `shown` is not added as a child: that would change its list of parents in the pager's thread. Null draws nothing.
    explicit StandIn(osg::Node* shown);

    /// Asks for the file from this time on. Call it before another thread sees the node.
    void askAgain(const std::string& file, const osgDB::Options* options, Clock::time_point time);
    /// The file failed once more. From the pager's threads.
    void askLater(Clock::time_point time);

    osg::BoundingSphere computeBound() const override;
    void traverse(osg::NodeVisitor& visitor) override;

protected:
    ~StandIn() override;

private:
    void ask(osg::NodeVisitor& visitor);

    const osg::ref_ptr<osg::Node> _shown;
    std::mutex _mutex; ///< of all below; several threads may cull
    std::string _file; ///< empty: never
    osg::ref_ptr<const osgDB::Options> _options;
    Clock::time_point _time;
    osg::ref_ptr<osg::Referenced> _request; ///< the pager's
};

} // namespace osgGeoFX
