// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A flight over a whole Earth, from 20,000 km to Honolulu and along the Pali: no step changes the picture much more than the
// others do, and near and far planes cut nothing off.
#include <osgGeoFX/paging/PagerMonitor.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>
#include <tools/PixelsApart.h>
#include <tools/RandomSamples.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 320, HEIGHT = 200;
constexpr double FIELD_OF_VIEW = 40.0; // degrees
constexpr int STEPS = 400;

/// Down to Honolulu for three fifths of the way, then over the city into the mountains.
ViewPoint placeOf(int step)
{
    constexpr int arrival = 240;
    constexpr double highest = 2e7, lowest = 1200.0;
    const auto smooth = [](double x)
    {
        const double t = std::clamp(x, 0.0, 1.0);
        return t * t * (3.0 - 2.0 * t);
    };
    const double down = std::min(1.0, static_cast<double>(step) / arrival);
    const double along = std::max(0.0, static_cast<double>(step - arrival) / (STEPS - arrival));
    ViewPoint place;
    place.height = highest * std::pow(lowest / highest, down);
    place.longitude = osg::DegreesToRadians(-157.87 + 0.07 * along);
    place.latitude = osg::DegreesToRadians(21.29 + 0.075 * along);
    // Towards the mountains while the ground comes near.
    place.pitch = osg::DegreesToRadians(-89.9 + 75.9 * smooth((down - 0.3) / 0.7));
    place.heading = osg::DegreesToRadians(43.0 * smooth((down - 0.3) / 0.7));
    return place;
}

/// Tells near and far planes as another callback has them.
class Recorder : public osg::CullSettings::ClampProjectionMatrixCallback
{
public:
    explicit Recorder(osg::CullSettings::ClampProjectionMatrixCallback* other) : _other(other) {}
    bool clampProjectionMatrixImplementation(osg::Matrixf& projection, double& near,
                                             double& far) const override
    {
        return _other->clampProjectionMatrixImplementation(projection, near, far);
    }
    bool clampProjectionMatrixImplementation(osg::Matrixd& projection, double& near,
                                             double& far) const override
    {
        const bool done = _other->clampProjectionMatrixImplementation(projection, near, far);
        last = projection;
        return done;
    }
    mutable osg::Matrixd last;

private:
    osg::ref_ptr<osg::CullSettings::ClampProjectionMatrixCallback> _other;
};

class GlobeFlight : public GlFixture
{
protected:
    GlobeFlight() : GlFixture(WIDTH, HEIGHT) {}

    bool load()
    {
        _scene = loadOahu("oahu_globe");
        if (!_scene) return false;
        osg::Camera& camera = *viewer().getCamera();
        _scene->setUpView(viewer());
        camera.setProjectionMatrixAsPerspective(FIELD_OF_VIEW, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e8);
        camera.setLODScale(_scene->lodScale(HEIGHT, osg::DegreesToRadians(FIELD_OF_VIEW)));
        _recorder = new Recorder(camera.getClampProjectionMatrixCallback());
        camera.setClampProjectionMatrixCallback(_recorder);
        viewer().setSceneData(_scene->node);
        _monitor = std::make_unique<PagerMonitor>(viewer().getDatabasePager(), nullptr, 1);
        return true;
    }

    osg::ref_ptr<osg::Image> draw(const osg::Matrixd& view)
    {
        viewer().getCamera()->setViewMatrix(view);
        _monitor->restart();
        for (viewer().frame(0.0); !_monitor->frameFinished(); viewer().frame(0.0))
            _monitor->waitForReads(1.0);
        return render(_scene->node);
    }

    /// Which pixels show the Earth.
    std::vector<bool> covered(const osg::Image& image)
    {
        const osg::Vec4 clear = viewer().getCamera()->getClearColor();
        std::vector<bool> result;
        for (int i = 0; i < WIDTH * HEIGHT; ++i)
        {
            bool same = true;
            for (int c = 0; c < 3; ++c)
                same = same && std::abs(255.0f * clear[c] - image.data()[4 * i + c]) < 1.0f;
            result.push_back(!same);
        }
        return result;
    }

    std::optional<Scene> _scene;
    osg::ref_ptr<Recorder> _recorder;
    std::unique_ptr<PagerMonitor> _monitor;
};

double difference(const osg::Image& a, const osg::Image& b)
{
    double sum = 0.0;
    for (int i = 0; i < 4 * WIDTH * HEIGHT; ++i)
        sum += std::abs(a.data()[i] - b.data()[i]);
    return sum / (3.0 * WIDTH * HEIGHT);
}

} // namespace

TEST_F(GlobeFlight, IsCalmAndWhole)
{
    if (!load()) return;
    // Each twentieth step in a short test, beside the one before it.
    const int stride = fullTest() ? 1 : 20;
    std::vector<double> changes;
    std::vector<int> steps;
    osg::ref_ptr<osg::Image> former;
    int cut = 0;
    for (int step = 1; step <= STEPS; ++step)
    {
        const bool counts = step % stride == 0;
        if (!counts && (step + 1) % stride != 0) continue;
        osg::Matrixd view;
        ASSERT_TRUE(placeOf(step).viewMatrix(*_scene->reference, view));
        const osg::ref_ptr<osg::Image> image = draw(view);
        if (former && counts)
        {
            changes.push_back(difference(*former, *image));
            steps.push_back(step);
        }
        former = image;
        if (!counts) continue;
        // With planes far apart the same is covered.
        osg::Camera& camera = *viewer().getCamera();
        const osg::Matrixd projection = camera.getProjectionMatrix();
        double left, right, bottom, top, near, far;
        ASSERT_TRUE(_recorder->last.getFrustum(left, right, bottom, top, near, far));
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setProjectionMatrixAsPerspective(FIELD_OF_VIEW, static_cast<double>(WIDTH) / HEIGHT,
                                                0.1 * near, std::max(10.0 * far, 3e7));
        const std::vector<bool> whole = covered(*render(_scene->node));
        camera.setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
        camera.setProjectionMatrix(projection);
        // Nothing is in sight behind the highest mountain that stands above the horizon.
        const auto horizon = [](double height)
        {
            return std::sqrt(height * (2.0 * osg::WGS_84_RADIUS_EQUATOR + height));
        };
        EXPECT_LE(far, 1.03 * (horizon(placeOf(step).height) + horizon(_scene->terrain->maxHeight)));
        const std::vector<bool> drawn = covered(*image);
        for (std::size_t i = 0; i < whole.size(); ++i)
            cut += whole[i] != drawn[i] ? 1 : 0;
        EXPECT_EQ(cut, 0) << "step " << step << ", near " << near << ", far " << far;
        if (cut) return;
    }
    std::vector<double> sorted = changes;
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[sorted.size() / 2];
    const auto most = std::max_element(changes.begin(), changes.end());
    std::cout << changes.size() << " steps, median " << median << "/255, most " << *most / median
              << " times that, at step " << steps[static_cast<std::size_t>(most - changes.begin())] << '\n';
    EXPECT_GT(median, 0.1) << "nothing moves";
    EXPECT_LE(*most, 3.0 * median);
}

// Depths by the logarithm of the distance are fine everywhere, so they show which of two grounds is nearer.
TEST_F(GlobeFlight, NoDepthsFight)
{
    if (!load()) return;
    for (int step = fullTest() ? 5 : 80; step <= STEPS; step += fullTest() ? 5 : 80)
    {
        osg::Matrixd view;
        ASSERT_TRUE(placeOf(step).viewMatrix(*_scene->reference, view));
        const osg::ref_ptr<osg::Image> image = draw(view);
        _scene->effects->setDepthConvention({DepthConvention::LOGARITHMIC_BY_FRAGMENT, 1e8});
        const osg::ref_ptr<osg::Image> fine = render(_scene->node);
        _scene->effects->setDepthConvention({});
        const int fighting = pixelsApart(*image, *fine);
        std::cout << "step " << step << ": " << fighting << " pixels\n";
        EXPECT_LE(fighting, WIDTH * HEIGHT / 1000) << "step " << step;
    }
}
