// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Still.h"

#include <cstring>
#include <stdexcept>

namespace flightgear
{

bool same(const osg::Image& a, const osg::Image& b)
{
    return a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
           std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0;
}

osg::ref_ptr<osg::Image> drawStill(osgGeoFX::SceneRenderer& renderer, const osg::Matrixd& view)
{
    osgGeoFX::FrameStatistics statistics;
    std::string error;
    osg::ref_ptr<osg::Image> former;
    for (int i = 0; i < 10; ++i)
    {
        const osg::ref_ptr<osg::Image> image = renderer.render(view, 0.0, statistics, error);
        if (!image) throw std::runtime_error(error);
        if (former && same(*former, *image)) return image;
        former = image;
    }
    throw std::runtime_error("The picture does not stand still; something below the scene moves.");
}

} // namespace flightgear
