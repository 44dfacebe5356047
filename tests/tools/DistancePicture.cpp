// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/DistancePicture.h>

#include <osgGeoFX/offscreen/ImageCapture.h>

#include <algorithm>
#include <cmath>

namespace geofx::test
{

std::vector<double> DistancePictures::distancesOf(osg::Node* node)
{
    using osgGeoFX::ImageCapture;
    const osg::ref_ptr<ImageCapture> capture =
        ImageCapture::attach(viewer().getCamera(), ImageCapture::Format::DepthFloat);
    capture->request();
    render(node);
    const osg::ref_ptr<osg::Image> image = capture->take();
    capture->detach(viewer().getCamera());
    std::vector<double> distances;
    for (int i = 0; i < _columns * _rows; ++i)
    {
        const auto depth = static_cast<double>(reinterpret_cast<const float*>(image->data())[i]);
        const double ndc = 2.0 * depth - 1.0;
        distances.push_back(depth >= 1.0 ? HUGE_VAL
                                         : 2.0 * _far * _near / (_far + _near - ndc * (_far - _near)));
    }
    return distances;
}

DistancePictures::Strangers DistancePictures::strangers(const std::vector<double>& picture,
                                                        const std::vector<double>& other) const
{
    Strangers result;
    for (int y = 1; y + 1 < _rows; ++y)
    {
        for (int x = 1; x + 1 < _columns; ++x)
        {
            const double here = picture[static_cast<std::size_t>(y * _columns + x)];
            double low = HUGE_VAL, high = 0.0;
            bool open = false;
            for (int i = 0; i < 9; ++i)
            {
                const double there =
                    other[static_cast<std::size_t>((y + i / 3 - 1) * _columns + x + i % 3 - 1)];
                open = open || there == HUGE_VAL;
                if (there == HUGE_VAL) continue;
                low = std::min(low, there);
                high = std::max(high, there);
            }
            // Where the ground ends, farther ground may show for less than a pixel.
            if (here == HUGE_VAL ? !open : low == HUGE_VAL)
                ++result.outlines;
            else if (here < HUGE_VAL &&
                     !(here >= low * (1.0 - _tolerance) && (open || here <= high * (1.0 + _tolerance))))
                ++result.depths;
        }
    }
    return result;
}

DistancePictures::Strangers DistancePictures::apart(const std::vector<double>& one,
                                                    const std::vector<double>& other) const
{
    const Strangers a = strangers(one, other), b = strangers(other, one);
    return {a.outlines + b.outlines, a.depths + b.depths};
}

} // namespace geofx::test
