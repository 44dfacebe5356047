// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/MarkImages.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

osg::ref_ptr<osg::Image> makeMark(int side, const MarkColor& color)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    const double texel = 2.0 / (side * markReach);
    unsigned char* byte = image->data();
    for (int row = 0; row < side; ++row)
    {
        for (int column = 0; column < side; ++column)
        {
            const osg::Vec4 rgba =
                color((column + 0.5 - side / 2.0) * texel, (row + 0.5 - side / 2.0) * texel, texel);
            for (int i = 0; i < 4; ++i)
                *byte++ = static_cast<unsigned char>(std::lround(std::clamp(rgba[i], 0.0f, 1.0f) * 255.0f));
        }
    }
    return image;
}

osg::ref_ptr<osg::Image> makeDisc(int side, const osg::Vec4& color, const osg::Vec4& rim, double inner)
{
    return makeMark(side,
                    [&](double x, double y, double texel)
                    {
                        const double radius = std::hypot(x, y);
                        const auto within = static_cast<float>(markCover(inner - radius, texel));
                        osg::Vec4 result = color * within + rim * (1.0f - within);
                        result.a() *= static_cast<float>(markCover(1.0 - radius, texel));
                        return result;
                    });
}

} // namespace osgGeoFX
