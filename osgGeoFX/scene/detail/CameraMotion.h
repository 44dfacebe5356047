// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/FrameStamp>
#include <osg/Matrixd>
#include <osg/Vec3d>

#include <deque>
#include <optional>

namespace osgGeoFX
{

/** Where a camera has been in its last frames, and where it will be if it goes on like that.

    Speeds are medians over half a second, so single frames that came early or late do not count. A camera that jumps begins
    anew. A turn comes to its end within some seconds, for people turn to look at something. Matrices lead from the world to
    eye space, metres, without scale. For one thread at a time. */
class CameraMotion
{
public:
    /// A frame. Of two frames of one time the latter counts. Times are those of the simulation, or the reference times
    /// where the simulation stands still.
    void add(const osg::FrameStamp& stamp, const osg::Matrixd& modelView);

    /// The matrix in some seconds. Nothing as long as the motion is not known, and for a camera that stands still.
    std::optional<osg::Matrixd> at(double seconds) const;

private:
    struct Sample
    {
        double time;
        osg::Matrixd modelView;
        osg::Vec3d eye;  ///< in the world
        osg::Vec3d move; ///< from the sample before, metres a second, in eye space
        osg::Vec3d turn; ///< the same, an axis in eye space with the length of radians a second
    };
    bool jumps(const Sample& next, double duration) const;
    /// Whether the medians are known.
    bool settled() const;
    osg::Vec3d median(osg::Vec3d Sample::*value) const;
    double timeOf(const osg::FrameStamp& stamp) const;

    std::deque<Sample> _samples; ///< the first one has no move and no turn
    double _simulation = 0.0, _reference = 0.0;
};

} // namespace osgGeoFX
