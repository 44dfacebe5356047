// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Node>
#include <tools/GlFixture.h>

#include <vector>

namespace geofx::test
{

/// Pictures of how far away the ground is, and how they differ.
class DistancePictures : public GlFixture
{
protected:
    /// The camera's near and far planes, metres, are the same in all pictures. `tolerance`: of distances, as a share.
    DistancePictures(int width, int height, double nearPlane, double farPlane, double tolerance)
        : GlFixture(width, height), _columns(width), _rows(height), _near(nearPlane), _far(farPlane),
          _tolerance(tolerance)
    {
    }

    /// Distances before the eye, metres; HUGE_VAL where nothing is drawn.
    std::vector<double> distancesOf(osg::Node* node);

    /// Pixels of one picture of which nothing like it lies within a pixel in the other.
    struct Strangers
    {
        int outlines = 0; ///< ground where the other has none, or none where it has ground
        int depths = 0;
    };
    Strangers strangers(const std::vector<double>& picture, const std::vector<double>& other) const;
    /// In either direction.
    Strangers apart(const std::vector<double>& one, const std::vector<double>& other) const;

private:
    const int _columns, _rows;
    const double _near, _far, _tolerance;
};

} // namespace geofx::test
