// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A panorama map is calm: when a camera zooms evenly, no step changes the picture much more than the others do. Tiles, strokes
// and the brush's sizes come and go meanwhile, and must not pop.
#include <tools/GlRequired.h>
#include <tools/OahuScene.h>
#include <tools/SampledCases.h>

#include <gtest/gtest.h>
#include <osg/Math>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 480, HEIGHT = 300;
/// Of the paper's range of a factor of 8.
constexpr int STEPS = 200;
constexpr double HIGHEST = 20000.0;

/// Mean absolute difference, in 1/255.
double difference(const osg::Image& a, const osg::Image& b)
{
    double sum = 0.0;
    for (int row = 0; row < a.t(); ++row)
    {
        const unsigned char* x = a.data(0, static_cast<unsigned int>(row));
        const unsigned char* y = b.data(0, static_cast<unsigned int>(row));
        for (int i = 0; i < 3 * a.s(); ++i)
            sum += std::abs(x[i] - y[i]);
    }
    return sum / (3.0 * a.s() * a.t());
}

class PanoramaZoom : public ::testing::TestWithParam<bool>
{
};

} // namespace

TEST_P(PanoramaZoom, NoStepChangesThePictureMuchMoreThanTheOthers)
{
    const std::optional<Scene> oahu = loadOahu("oahu");
    if (!oahu) return;
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    map->setStrokes(GetParam());
    oahu->effects->addEffect(map);
    SceneRenderer::Options options;
    options.width = WIDTH;
    options.height = HEIGHT;
    std::string error;
    const std::unique_ptr<SceneRenderer> renderer = SceneRenderer::create(*oahu, options, error);
    if (!renderer)
    {
        if (geofx::test::glIsRequired()) FAIL() << error;
        GTEST_SKIP() << error;
    }

    // Some steps in the middle, where tiles of all levels come in, or all of them.
    const int first = fullTest() ? 0 : 100;
    const int last = fullTest() ? STEPS : 104;
    std::vector<double> changes;
    osg::ref_ptr<osg::Image> former;
    for (int i = first; i <= last; ++i)
    {
        ViewPoint point;
        point.longitude = osg::DegreesToRadians(-157.93);
        point.latitude = osg::DegreesToRadians(21.36);
        point.height = HIGHEST * std::pow(8.0, -static_cast<double>(i) / STEPS);
        point.heading = osg::DegreesToRadians(40.0);
        point.pitch = osg::DegreesToRadians(-40.0);
        osg::Matrixd view;
        ASSERT_TRUE(point.viewMatrix(*oahu->reference, view));
        FrameStatistics statistics;
        const osg::ref_ptr<osg::Image> image = renderer->render(view, 0.0, statistics, error);
        ASSERT_TRUE(image) << error;
        if (former) changes.push_back(difference(*former, *image));
        former = image;
    }
    std::vector<double> sorted = changes;
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[sorted.size() / 2];
    const auto most = std::max_element(changes.begin(), changes.end());
    std::cout << (GetParam() ? "with strokes: " : "without strokes: ") << changes.size() << " steps, median "
              << median << "/255, most " << *most / median << " times that, at step "
              << first + (most - changes.begin()) << '\n';
    EXPECT_GT(median, 0.1) << "nothing moves";
    EXPECT_LE(*most, 2.0 * median);
}

INSTANTIATE_TEST_SUITE_P(Oahu, PanoramaZoom, ::testing::ValuesIn(sampledCases<bool>({false, true}, 2, 1)),
                         [](const auto& each) { return std::string(each.param ? "strokes" : "plain"); });
