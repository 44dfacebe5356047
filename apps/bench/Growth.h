// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <utility>
#include <vector>

namespace geofx::bench
{

/// A quantity that is looked at from time to time while frames are drawn.
class Growth
{
public:
    /// Frames come in order.
    void add(double frame, double value) { _samples.emplace_back(frame, value); }

    /// The slope of the line of least squares through all samples from a frame on, for 10,000 frames. 0 for fewer than two.
    double slopeFrom(double frame) const;

    /// The median of the slopes between any two samples from a frame on, for 10,000 frames (Theil and Sen). A single step, or a peak,
    /// moves the line of least squares; what grows all the time moves both. 0 for fewer than two samples.
    double typicalSlopeFrom(double frame) const;

    /// The median of the values of the frames from `first` to before `end`. 0 where there are none.
    double medianWithin(double first, double end) const;

    const std::vector<std::pair<double, double>>& samples() const { return _samples; }

private:
    std::vector<std::pair<double, double>> _samples; ///< frame, value
};

} // namespace geofx::bench
