// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Layers that change in time: blends between steps, what is read when, and steps that cannot be.
#include <osgGeoFX/mapping/LayerSequence.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/SceneData.h>
#include <tools/NotifyWatch.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>
#include <thread>

using namespace osgGeoFX;

namespace
{

constexpr float none = std::numeric_limits<float>::quiet_NaN();

osg::ref_ptr<osg::Image> numbers(const std::vector<float>& values)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(values.size()), 1, 1, GL_RED, GL_FLOAT);
    std::copy(values.begin(), values.end(), reinterpret_cast<float*>(image->data()));
    return image;
}

osg::ref_ptr<osg::Image> color(unsigned char r, unsigned char g, unsigned char b, unsigned char a)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    const unsigned char bytes[] = {r, g, b, a};
    std::copy(bytes, bytes + 4, image->data());
    return image;
}

/// Steps that tell which of them were read.
class WatchedSteps : public SequenceSteps
{
public:
    explicit WatchedSteps(std::size_t count)
    {
        for (std::size_t i = 0; i < count; ++i)
            _times.push_back(10.0 * static_cast<double>(i));
    }
    const std::vector<double>& times() const override { return _times; }
    DataLayer::Kind kind() const override { return DataLayer::VALUE; }
    osg::ref_ptr<osg::Image> read(std::size_t step, std::string& error) override
    {
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            _read.insert(step);
        }
        if (step == broken)
        {
            error = "step.tif: it is broken; mend it.";
            return nullptr;
        }
        if (step == larger) return numbers({1.0f, 2.0f});
        return numbers({static_cast<float>(step)});
    }
    std::multiset<std::size_t> takeRead()
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return std::exchange(_read, {});
    }

    std::size_t broken = 1000, larger = 1000;

protected:
    ~WatchedSteps() override = default;

private:
    std::vector<double> _times;
    std::mutex _mutex;
    std::multiset<std::size_t> _read;
};

osg::ref_ptr<LayerSequence> sequenceOf(SequenceSteps* steps)
{
    osg::ref_ptr<LayerSequence> sequence = new LayerSequence(steps);
    sequence->setWaiting(true);
    sequence->getClock()->setPlaying(false);
    return sequence;
}

float valueAt(LayerSequence& sequence, double time, int texel = 0)
{
    sequence.getClock()->setTime(time);
    EXPECT_TRUE(sequence.update());
    return reinterpret_cast<const float*>(sequence.getLayer()->getImage()->data())[texel];
}

} // namespace

TEST(LayerSequence, BlendsNumbersBetweenSteps)
{
    const osg::ref_ptr<LayerSequence> sequence = sequenceOf(new ImageSteps(
        {numbers({0.0f, none, 5.0f}), numbers({8.0f, 4.0f, none}), numbers({-8.0f, none, none})},
        {100.0, 140.0, 150.0}, DataLayer::VALUE));
    EXPECT_EQ(sequence->getClock()->getBegin(), 100.0);
    EXPECT_EQ(sequence->getClock()->getEnd(), 150.0);
    EXPECT_EQ(sequence->getLayer()->getKind(), DataLayer::VALUE);
    EXPECT_EQ(valueAt(*sequence, 100.0), 0.0f);
    EXPECT_FLOAT_EQ(valueAt(*sequence, 110.0), 2.0f);
    EXPECT_EQ(valueAt(*sequence, 140.0), 8.0f);
    EXPECT_FLOAT_EQ(valueAt(*sequence, 145.0), 0.0f);
    EXPECT_EQ(valueAt(*sequence, 150.0), -8.0f);
    // Where one of both has no data, the nearer one counts.
    EXPECT_TRUE(std::isnan(valueAt(*sequence, 119.0, 1)));
    EXPECT_EQ(valueAt(*sequence, 121.0, 1), 4.0f);
    EXPECT_EQ(valueAt(*sequence, 119.0, 2), 5.0f);
    EXPECT_TRUE(std::isnan(valueAt(*sequence, 121.0, 2)));
    sequence->setBlending(false);
    EXPECT_EQ(valueAt(*sequence, 139.0), 0.0f);
}

TEST(LayerSequence, BlendsColorsByTheirAlpha)
{
    const osg::ref_ptr<LayerSequence> sequence = sequenceOf(
        new ImageSteps({color(200, 0, 0, 255), color(0, 100, 50, 0)}, {0.0, 1.0}, DataLayer::COLOR));
    sequence->getClock()->setTime(0.5);
    EXPECT_TRUE(sequence->update());
    const unsigned char* half = sequence->getLayer()->getImage()->data();
    EXPECT_EQ(half[0], 200) << "what is transparent has no color";
    EXPECT_EQ(half[1], 0);
    EXPECT_EQ(half[3], 128);
}

TEST(LayerSequence, ClassesAreNeverBlended)
{
    const osg::ref_ptr<LayerSequence> sequence =
        sequenceOf(new ImageSteps({numbers({1.0f}), numbers({5.0f})}, {0.0, 1.0}, DataLayer::CLASS));
    EXPECT_EQ(valueAt(*sequence, 0.45), 1.0f);
    EXPECT_EQ(valueAt(*sequence, 0.55), 5.0f);
}

TEST(LayerSequence, ItsImageChangesOnlyWithTheTime)
{
    const osg::ref_ptr<LayerSequence> sequence = sequenceOf(new WatchedSteps(5));
    valueAt(*sequence, 12.0);
    const unsigned int count = sequence->getLayer()->getImage()->getModifiedCount();
    const unsigned int revision = sequence->getLayer()->revision();
    valueAt(*sequence, 12.0);
    EXPECT_EQ(sequence->getLayer()->getImage()->getModifiedCount(), count);
    valueAt(*sequence, 13.0);
    EXPECT_NE(sequence->getLayer()->getImage()->getModifiedCount(), count);
    EXPECT_EQ(sequence->getLayer()->revision(), revision) << "its texels alone are uploaded";
}

TEST(LayerSequence, ReadsEachStepOnceOnTheWayAndFewAhead)
{
    const osg::ref_ptr<WatchedSteps> steps = new WatchedSteps(100);
    const osg::ref_ptr<LayerSequence> sequence = sequenceOf(steps);
    for (int i = 0; i <= 300; ++i)
        EXPECT_FLOAT_EQ(valueAt(*sequence, static_cast<double>(i)), static_cast<float>(i) / 10.0f);
    const std::multiset<std::size_t> read = steps->takeRead();
    for (std::size_t step = 0; step <= 30; ++step)
        EXPECT_EQ(read.count(step), 1u) << step;
    EXPECT_LE(read.size(), 36u);
    EXPECT_LE(*read.rbegin(), 35u);
}

TEST(LayerSequence, OneThatDoesNotWaitKeepsTheLastPicture)
{
    const osg::ref_ptr<LayerSequence> sequence = sequenceOf(new WatchedSteps(10));
    sequence->setWaiting(false);
    for (int i = 0; i < 1000 && !sequence->update(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    EXPECT_TRUE(sequence->update());
    EXPECT_EQ(reinterpret_cast<const float*>(sequence->getLayer()->getImage()->data())[0], 0.0f);
}

TEST(LayerSequence, StepsThatCannotBeReadAreSaidOnce)
{
    const osg::ref_ptr<WatchedSteps> steps = new WatchedSteps(10);
    steps->broken = 3;
    steps->larger = 5;
    const osg::ref_ptr<LayerSequence> sequence = sequenceOf(steps);
    geofx::test::NotifyWatch watch;
    const std::vector<std::string> said = watch.messagesOf(
        [&]
        {
            EXPECT_EQ(valueAt(*sequence, 20.0), 2.0f);
            EXPECT_EQ(valueAt(*sequence, 25.0), 2.0f) << "the one before it";
            EXPECT_EQ(valueAt(*sequence, 80.0), 8.0f);
            EXPECT_EQ(valueAt(*sequence, 30.0), 2.0f) << "whatever was shown before";
            EXPECT_EQ(valueAt(*sequence, 35.0), 2.0f);
            EXPECT_EQ(valueAt(*sequence, 50.0), 4.0f) << "another size";
            EXPECT_EQ(valueAt(*sequence, 60.0), 6.0f);
        });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("step.tif: it is broken; mend it."), std::string::npos) << said[0];
    EXPECT_EQ(sequence->fault(), "step.tif: it is broken; mend it.");
}

TEST(LayerSequence, SequencesShareAClock)
{
    const osg::ref_ptr<LayerPlayer> player = new LayerPlayer(nullptr);
    const osg::ref_ptr<LayerSequence> one = sequenceOf(new WatchedSteps(5));
    const osg::ref_ptr<LayerSequence> other =
        sequenceOf(new ImageSteps({numbers({1.0f}), numbers({2.0f})}, {20.0, 80.0}, DataLayer::VALUE));
    player->add(one);
    player->add(other);
    EXPECT_EQ(one->getClock(), other->getClock());
    EXPECT_EQ(player->getClock()->getEnd(), 80.0);
    player->getClock()->setSpeed(1.0);
    player->update(0.0);
    player->update(35.0);
    EXPECT_FLOAT_EQ(reinterpret_cast<const float*>(one->getLayer()->getImage()->data())[0], 3.5f);
    EXPECT_FLOAT_EQ(reinterpret_cast<const float*>(other->getLayer()->getImage()->data())[0], 1.25f);
    geofx::test::NotifyWatch watch;
    EXPECT_EQ(watch.messagesOf([&] { one->setClock(nullptr); }).size(), 1u);
    EXPECT_EQ(one->getClock(), other->getClock());
}

TEST(LayerSequence, WithoutStepsThatCanBeReadNothingIsShown)
{
    geofx::test::NotifyWatch watch;
    const osg::ref_ptr<LayerSequence> none = sequenceOf(new ImageSteps({}, {}, DataLayer::VALUE));
    EXPECT_EQ(watch.messagesOf([&] { EXPECT_TRUE(none->update()); }).size(), 1u);
    EXPECT_TRUE(none->settled());
    EXPECT_EQ(none->getLayer()->getImage()->s(), 0);
    // The first one cannot be read: the next one that can.
    const osg::ref_ptr<WatchedSteps> steps = new WatchedSteps(4);
    steps->broken = 0;
    const osg::ref_ptr<LayerSequence> sequence = sequenceOf(steps);
    watch.messagesOf([&] { EXPECT_EQ(valueAt(*sequence, 0.0), 1.0f); });
}

// A program that draws pictures asks whether a frame had all that it needed.
TEST(LayerSequence, PicturesWaitForTheirSteps)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    EXPECT_TRUE(hasAllData(*scene));
    const osg::ref_ptr<WatchedSteps> steps = new WatchedSteps(20);
    const osg::ref_ptr<LayerSequence> sequence = new LayerSequence(steps);
    const osg::ref_ptr<LayerPlayer> player = LayerPlayer::onto(*scene);
    EXPECT_EQ(LayerPlayer::onto(*scene), player) << "one is enough";
    EXPECT_TRUE(player->add(sequence, LayerPlayer::usualTime));
    EXPECT_EQ(player->getClock()->getSpeed(), 190.0 / LayerPlayer::usualTime);
    EXPECT_FALSE(hasAllData(*scene)) << "nothing has been read";
    int turns = 0;
    for (player->update(11.0); !hasAllData(*scene) && turns < 5000; ++turns)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        player->update(11.0);
    }
    ASSERT_TRUE(hasAllData(*scene));
    EXPECT_FLOAT_EQ(reinterpret_cast<const float*>(sequence->getLayer()->getImage()->data())[0], 10.45f);
}

// Seconds since 1970 and hours of a forecast are no common time.
TEST(LayerSequence, DatedAndUndatedOnesDoNotShareAClock)
{
    const osg::ref_ptr<LayerPlayer> player = new LayerPlayer(nullptr);
    EXPECT_TRUE(player->add(new LayerSequence(new WatchedSteps(5))));
    const osg::ref_ptr<LayerSequence> dated =
        new LayerSequence(new ImageSteps({numbers({1.0f})}, {1.7e9}, DataLayer::VALUE, true));
    EXPECT_NE(player->faultOf(*dated).find("show them apart"), std::string::npos);
    geofx::test::NotifyWatch watch;
    EXPECT_EQ(watch.messagesOf([&] { EXPECT_FALSE(player->add(dated)); }).size(), 1u);
    EXPECT_EQ(player->getNumSequences(), 1u);
    EXPECT_EQ(player->getClock()->getEnd(), 40.0);
}
