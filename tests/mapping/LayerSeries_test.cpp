// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The values of a sequence at a place: what is read, by whom, and how it is written down.
#include <osgGeoFX/mapping/LayerSeries.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <limits>
#include <mutex>
#include <sstream>
#include <thread>

using namespace osgGeoFX;

namespace
{

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// Step i has 10 i at the left and 10 i + 4 at the right; a gate can hold readers up.
class GatedSteps : public SequenceSteps
{
public:
    explicit GatedSteps(std::size_t count, bool dated = false) : _dated(dated)
    {
        for (std::size_t i = 0; i < count; ++i)
            _times.push_back((dated ? 1768197600.0 : 0.0) + 3600.0 * static_cast<double>(i));
    }
    const std::vector<double>& times() const override { return _times; }
    bool dated() const override { return _dated; }
    DataLayer::Kind kind() const override { return DataLayer::VALUE; }
    osg::ref_ptr<osg::Image> read(std::size_t step, std::string& error) override
    {
        EXPECT_FALSE(_busy.exchange(true)) << "one thread at a time";
        {
            std::unique_lock<std::mutex> lock(_mutex);
            ++started;
            _news.notify_all();
            _news.wait(lock, [this] { return _open; });
        }
        _busy = false;
        if (step == broken)
        {
            error = "step.tif: it is broken; mend it.";
            return nullptr;
        }
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(2, 1, 1, GL_RED, GL_FLOAT);
        auto* const texels = reinterpret_cast<float*>(image->data());
        texels[0] = step == empty ? none : 10.0f * static_cast<float>(step);
        texels[1] = texels[0] + 4.0f;
        return image;
    }
    void open(bool on)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _open = on;
        _news.notify_all();
    }
    void waitForStarted(int count)
    {
        std::unique_lock<std::mutex> lock(_mutex);
        _news.wait(lock, [&] { return started >= count; });
    }

    std::size_t broken = 1000, empty = 1000;
    int started = 0;

protected:
    ~GatedSteps() override = default;

private:
    std::vector<double> _times;
    bool _dated;
    std::atomic<bool> _busy{false};
    std::mutex _mutex;
    std::condition_variable _news;
    bool _open = true;
};

} // namespace

TEST(LayerSeries, HasTheValuesOfAllStepsAtAPlace)
{
    const osg::ref_ptr<GatedSteps> steps = new GatedSteps(30);
    const osg::ref_ptr<LayerSequence> sequence = new LayerSequence(steps);
    const osg::ref_ptr<LayerSeries> series = new LayerSeries(*sequence);
    EXPECT_TRUE(series->points().empty());
    EXPECT_TRUE(series->finished());
    // Of two texels: 0.5 lies in the middle between both.
    for (const auto& [x, added] : {std::pair(0.5, 2.0), std::pair(0.1, 0.0), std::pair(0.625, 3.0)})
    {
        series->setPlace(osg::Vec2d(x, 0.5));
        series->wait();
        const std::vector<LayerSeries::Point> points = series->points();
        ASSERT_EQ(points.size(), 30u);
        for (std::size_t i = 0; i < 30; ++i)
        {
            EXPECT_EQ(points[i].time, 3600.0 * static_cast<double>(i));
            ASSERT_TRUE(points[i].value);
            EXPECT_NEAR(*points[i].value, 10.0 * static_cast<double>(i) + added, 1e-5);
        }
    }
    series->setPlace(std::nullopt);
    EXPECT_TRUE(series->points().empty());
}

TEST(LayerSeries, NobodyWaitsForReaders)
{
    using Clock = std::chrono::steady_clock;
    const osg::ref_ptr<GatedSteps> steps = new GatedSteps(1000);
    const osg::ref_ptr<LayerSequence> sequence = new LayerSequence(steps);
    const osg::ref_ptr<LayerSeries> series = new LayerSeries(*sequence);
    steps->open(false);
    series->setPlace(osg::Vec2d(0.1, 0.5));
    steps->waitForStarted(1);
    // The gate is shut, so whatever waited would wait for ever.
    for (int i = 0; i < 100; ++i)
        series->setPlace(osg::Vec2d(0.9, 0.5));
    EXPECT_FALSE(series->finished());
    EXPECT_EQ(series->points().size(), 1000u);
    EXPECT_FALSE(series->points()[0].known);
    steps->open(true);
    series->wait();
    EXPECT_NEAR(*series->points()[0].value, 4.0, 1e-5) << "which was being read for the first place";
    EXPECT_NEAR(*series->points()[7].value, 74.0, 1e-5) << "of the last place, not of the first";
    // Each place but the last was given up after the step that was being read.
    EXPECT_LE(steps->started, 1002);

    // The sequence itself is never behind a whole series.
    series->setPlace(osg::Vec2d(0.1, 0.5));
    sequence->setWaiting(true);
    sequence->getClock()->setTime(3600.0 * 500.0);
    const auto begin = Clock::now();
    EXPECT_TRUE(sequence->update());
    const bool stillReading = !series->finished();
    EXPECT_NEAR(
        static_cast<double>(*reinterpret_cast<const float*>(sequence->getLayer()->getImage()->data())),
        5000.0, 1e-3);
    EXPECT_TRUE(stillReading || Clock::now() - begin < std::chrono::milliseconds(200));
}

TEST(LayerSeries, WhatCannotBeReadIsAGap)
{
    const osg::ref_ptr<GatedSteps> steps = new GatedSteps(4, true);
    steps->broken = 1;
    steps->empty = 2;
    const osg::ref_ptr<LayerSequence> sequence = new LayerSequence(steps);
    const osg::ref_ptr<LayerSeries> series = new LayerSeries(*sequence);
    series->setPlace(osg::Vec2d(0.0, 0.5));
    series->wait();
    EXPECT_TRUE(series->points()[1].known);
    EXPECT_FALSE(series->points()[1].value);
    EXPECT_FALSE(series->points()[2].value);
    EXPECT_EQ(series->fault(), "step.tif: it is broken; mend it.");
    EXPECT_EQ(series->csv("rain, \"all\"", "mm"), "time,\"rain, \"\"all\"\" (mm)\"\n"
                                                  "2026-01-12T06:00:00Z,0\n"
                                                  "2026-01-12T07:00:00Z,\n"
                                                  "2026-01-12T08:00:00Z,\n"
                                                  "2026-01-12T09:00:00Z,30\n");
}

TEST(LayerSeries, WritesColorsAndRefusesFoldersThatAreNotThere)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    const unsigned char bytes[] = {1, 20, 255, 128};
    std::copy(bytes, bytes + 4, image->data());
    const osg::ref_ptr<LayerSequence> sequence =
        new LayerSequence(new ImageSteps({image, image}, {0.25, 2.5}, DataLayer::COLOR));
    const osg::ref_ptr<LayerSeries> series = new LayerSeries(*sequence);
    series->setPlace(osg::Vec2d(0.5, 0.5));
    series->wait();
    const std::string expected = "time (s),red,green,blue,alpha\n0.25,1,20,255,128\n2.5,1,20,255,128\n";
    EXPECT_EQ(series->csv("photo", ""), expected);
    const geofx::test::TempDir folder;
    std::string error;
    const std::string file = (folder / "series.csv").string();
    ASSERT_TRUE(series->writeCsv(file, "photo", "", error)) << error;
    std::stringstream written;
    written << std::ifstream(file).rdbuf();
    EXPECT_EQ(written.str(), expected);
    const std::string nowhere = (folder / "none" / "series.csv").string();
    EXPECT_FALSE(series->writeCsv(nowhere, "photo", "", error));
    EXPECT_NE(error.find(nowhere), std::string::npos);
    EXPECT_NE(error.find("No such file"), std::string::npos) << error;
}
