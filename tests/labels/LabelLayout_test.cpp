// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/LabelLayout.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr double width = 1600.0, height = 900.0;

std::vector<LabelCandidate> randomCandidates(Random& random, int count)
{
    std::vector<LabelCandidate> candidates;
    for (int i = 0; i < count; ++i)
    {
        LabelCandidate label;
        label.id = static_cast<std::size_t>(i);
        label.anchor.set(random.uniform(-100.0, width + 100.0), random.uniform(-100.0, height + 100.0));
        label.size.set(random.uniform(20.0, 180.0), random.uniform(14.0, 30.0));
        label.manner = random.integer(0, 1) == 0 ? LabelCandidate::LEADER : LabelCandidate::BESIDE;
        label.visible = random.integer(0, 4) > 0;
        candidates.push_back(label);
    }
    return candidates;
}

bool overlap(const PlacedLabel& a, const PlacedLabel& b)
{
    return a.corner.x() < b.corner.x() + b.size.x() && b.corner.x() < a.corner.x() + a.size.x() &&
           a.corner.y() < b.corner.y() + b.size.y() && b.corner.y() < a.corner.y() + a.size.y();
}

/// Whether a's line runs over b's text.
bool crosses(const PlacedLabel& a, const PlacedLabel& b)
{
    return a.leader && a.anchor.x() > b.corner.x() && a.anchor.x() < b.corner.x() + b.size.x() &&
           a.anchor.y() < b.corner.y() + b.size.y() && a.corner.y() > b.corner.y();
}

void expectApart(const std::vector<PlacedLabel>& labels)
{
    for (std::size_t i = 0; i < labels.size(); ++i)
    {
        for (std::size_t k = 0; k < labels.size(); ++k)
        {
            if (i == k) continue;
            EXPECT_FALSE(i < k && overlap(labels[i], labels[k])) << labels[i].id << " " << labels[k].id;
            EXPECT_FALSE(crosses(labels[i], labels[k])) << labels[i].id << " " << labels[k].id;
        }
    }
}

} // namespace

TEST(LabelLayout, NoTwoOverlapAndAllAreWhole)
{
    Random random(21);
    for (int sample = 0; sample < 20; ++sample)
    {
        const std::vector<LabelCandidate> candidates = randomCandidates(random, 500);
        const std::vector<PlacedLabel> placed = LabelLayout::placeOnce(candidates, width, height, {});
        EXPECT_GT(placed.size(), 60u);
        expectApart(placed);
        for (const PlacedLabel& label : placed)
        {
            const LabelCandidate& asked = candidates[label.id];
            EXPECT_TRUE(asked.visible);
            EXPECT_EQ(label.anchor, asked.anchor);
            EXPECT_EQ(label.size, asked.size);
            EXPECT_EQ(label.alpha, 1.0);
            EXPECT_GE(std::min(label.corner.x(), label.corner.y()), 0.0);
            EXPECT_LE(label.corner.x() + label.size.x(), width);
            EXPECT_LE(label.corner.y() + label.size.y(), height);
            if (!label.leader) continue;
            // The line ends at the box.
            EXPECT_GE(label.anchor.x(), label.corner.x());
            EXPECT_LE(label.anchor.x(), label.corner.x() + label.size.x());
            EXPECT_GT(label.corner.y(), label.anchor.y());
        }
    }
}

// The first candidate is always there, whoever stands beside it.
TEST(LabelLayout, TheFirstComeFirst)
{
    Random random(22);
    for (int sample = 0; sample < 50; ++sample)
    {
        std::vector<LabelCandidate> candidates = randomCandidates(random, 200);
        candidates[0].anchor.set(random.uniform(200.0, width - 200.0), random.uniform(100.0, height - 100.0));
        candidates[0].visible = true;
        const auto placed = LabelLayout::placeOnce(candidates, width, height, {});
        ASSERT_FALSE(placed.empty());
        EXPECT_EQ(placed.front().id, 0u);
    }
}

// A pan and a zoom: names move as the ground does, come and go slowly, and never overlap on the way.
TEST(LabelLayout, StandsBesideItsPlaceInAPanAndAZoom)
{
    Random random(23);
    for (const bool zoom : {false, true})
    {
        std::vector<LabelCandidate> start = randomCandidates(random, 500);
        for (LabelCandidate& label : start)
            label.visible = true;
        LabelLayout layout;
        std::map<std::size_t, PlacedLabel> before;
        std::size_t shown = 0, popped = 0;
        for (int frame = 0; frame < 200; ++frame)
        {
            std::vector<LabelCandidate> now = start;
            for (LabelCandidate& label : now)
            {
                const osg::Vec2d middle(0.5 * width, 0.5 * height);
                label.anchor = zoom ? middle + (label.anchor - middle) * std::pow(0.997, frame)
                                    : label.anchor + osg::Vec2d(1.5 * frame, 0.4 * frame);
            }
            const std::vector<PlacedLabel> placed = layout.place(now, width, height, frame / 60.0);
            expectApart(placed);
            std::map<std::size_t, PlacedLabel> after;
            for (const PlacedLabel& label : placed)
            {
                after[label.id] = label;
                const auto last = before.find(label.id);
                if (last == before.end())
                {
                    EXPECT_LT(label.alpha, 0.1) << "it fades in";
                    continue;
                }
                ++shown;
                // To the bit it could not be, since both are sums.
                const osg::Vec2d moved = label.corner - last->second.corner;
                const osg::Vec2d ground = label.anchor - last->second.anchor;
                EXPECT_LT((moved - ground).length(), 1e-9);
                EXPECT_LT(std::abs(label.alpha - last->second.alpha), 0.1);
            }
            for (const auto& [id, label] : before)
                if (!after.count(id) && label.alpha > 0.1) ++popped;
            before = after;
        }
        EXPECT_GT(shown, 5000u);
        // Only where a name that fades would be drawn over another one.
        EXPECT_LT(popped, shown / 200);
    }
}

// What a mountain hides for a moment only does not flicker.
TEST(LabelLayout, IsPatient)
{
    LabelCandidate label;
    label.anchor.set(800.0, 400.0);
    label.size.set(80.0, 20.0);
    LabelLayout layout;
    double time = 0.0;
    const auto after = [&](double seconds, bool visible)
    {
        label.visible = visible;
        std::vector<PlacedLabel> placed;
        for (int i = 0; i < static_cast<int>(std::lround(60.0 * seconds)); ++i)
            placed = layout.place({label}, width, height, time += 1.0 / 60.0);
        return placed.empty() ? 0.0 : placed.front().alpha;
    };
    EXPECT_EQ(after(0.1, true), 0.0);
    EXPECT_EQ(after(0.5, true), 1.0);
    EXPECT_EQ(after(0.1, false), 1.0);
    EXPECT_EQ(after(0.1, true), 1.0);
    const double fading = after(0.3, false);
    EXPECT_GT(fading, 0.0);
    EXPECT_LT(fading, 1.0);
    EXPECT_EQ(after(0.5, false), 0.0);
}

// A way beside a place: its name stands on the other side, and where ways are all around, where it would have stood without.
TEST(LabelLayout, KeepsOffWaysWhereThereIsRoom)
{
    LabelCandidate town;
    town.manner = LabelCandidate::BESIDE;
    town.anchor.set(800.0, 450.0);
    town.size.set(120.0, 20.0);
    const auto cornerOf = [&](const std::vector<LabelBand>& bands)
    {
        const std::vector<PlacedLabel> placed = LabelLayout::placeOnce({town}, width, height, {}, bands);
        EXPECT_EQ(placed.size(), 1u);
        return placed.empty() ? osg::Vec2d() : placed.front().corner;
    };
    const osg::Vec2d usual = cornerOf({});
    EXPECT_GT(usual.x(), 800.0);
    // Across the text, along it within its width, and with its ends far outside.
    for (const LabelBand& band :
         {LabelBand{{860.0, 300.0}, {860.0, 600.0}, 3.0}, LabelBand{{815.0, 463.0}, {1200.0, 463.0}, 6.0},
          LabelBand{{700.0, 340.0}, {1000.0, 540.0}, 1.0}})
    {
        const osg::Vec2d other = cornerOf({band});
        EXPECT_NE(other, usual);
        // No place of the text is nearer to the way than it is wide.
        const osg::Vec2d way = band.to - band.from;
        for (int i = 0; i <= 120; ++i)
            for (int k = 0; k <= 20; ++k)
            {
                const osg::Vec2d to = other + osg::Vec2d(i, k) - band.from;
                const double share = std::clamp((to * way) / way.length2(), 0.0, 1.0);
                EXPECT_GE((to - way * share).length(), band.halfWidth - 1e-9);
            }
    }
    // A way that passes by changes nothing, and ways everywhere neither.
    EXPECT_EQ(cornerOf({{{860.0, 500.0}, {1000.0, 500.0}, 3.0}}), usual);
    EXPECT_EQ(cornerOf({{{0.0, 450.0}, {1600.0, 450.0}, 400.0}}), usual);
    // Summits' names stand in the sky.
    town.manner = LabelCandidate::LEADER;
    const osg::Vec2d above = cornerOf({});
    EXPECT_EQ(cornerOf({{{700.0, 470.0}, {900.0, 470.0}, 6.0}}), above);
}
