// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Anchors: the tables of their opacities, and what they refuse.
#include <osgGeoFX/closeup/Anchor.h>
#include <tools/NotifyWatch.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace osgGeoFX;
using geofx::test::NotifyWatch;

namespace
{

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

osg::ref_ptr<Anchor> makeAnchor(Anchor::Style style, double opacity = 1.0)
{
    osg::ref_ptr<Anchor> anchor = new Anchor;
    EXPECT_TRUE(anchor->setStyle(style));
    EXPECT_TRUE(anchor->setOpacity(opacity));
    return anchor;
}

TEST(Anchor, StylesAreWhatTheirNamesSay)
{
    struct Row
    {
        Anchor::Style style;
        double ground, quarter, half, top;
    };
    const Row rows[] = {{Anchor::SOLID, 1, 1, 1, 1},       {Anchor::VEIL, 0.35, 0.35, 0.35, 0.35},
                        {Anchor::RISING, 0, 0.25, 0.5, 1}, {Anchor::FALLING, 1, 0.75, 0.5, 0},
                        {Anchor::ENDS, 1, 0.5, 0, 1},      {Anchor::MIDDLE, 0, 0.5, 1, 0},
                        {Anchor::RINGS, 0, 0, 0, 0},       {Anchor::TABLE, 1, 0.75, 0.5, 0}};
    for (const Row& row : rows)
    {
        SCOPED_TRACE(row.style);
        for (const double opacity : {1.0, 0.5})
        {
            const osg::ref_ptr<Anchor> anchor = makeAnchor(row.style, opacity);
            EXPECT_NEAR(anchor->opacityAt(0.0), row.ground * opacity, 1e-6);
            EXPECT_NEAR(anchor->opacityAt(0.25), row.quarter * opacity, 1e-6);
            EXPECT_NEAR(anchor->opacityAt(0.5), row.half * opacity, 1e-6);
            EXPECT_NEAR(anchor->opacityAt(1.0), row.top * opacity, 1e-6);
            // Beyond the ends as at them.
            EXPECT_EQ(anchor->opacityAt(-3.0), anchor->opacityAt(0.0));
            EXPECT_EQ(anchor->opacityAt(1e300), anchor->opacityAt(1.0));
            EXPECT_EQ(anchor->opacityAt(std::numeric_limits<double>::quiet_NaN()), anchor->opacityAt(0.0));
        }
    }
}

TEST(Anchor, RingsAreEightBandsAsWideAsTheirGaps)
{
    const osg::ref_ptr<Anchor> anchor = makeAnchor(Anchor::RINGS);
    int bands = 0, solid = 0;
    bool before = false;
    for (int i = 0; i < 1000; ++i)
    {
        const bool now = anchor->opacityAt((i + 0.5) / 1000) > 0.5;
        bands += now && !before;
        solid += now;
        before = now;
    }
    EXPECT_EQ(bands, 8);
    EXPECT_NEAR(solid, 500, 10);
}

TEST(Anchor, ATableIsLinearBetweenItsValues)
{
    const osg::ref_ptr<Anchor> anchor = new Anchor;
    const unsigned int revision = anchor->revision();
    ASSERT_TRUE(anchor->setTable({0.0f, 1.0f, 0.5f, 0.25f, 0.75f}));
    EXPECT_EQ(anchor->getStyle(), Anchor::TABLE);
    EXPECT_EQ(anchor->revision(), revision + 1);
    anchor->setOpacity(0.5);
    EXPECT_NEAR(anchor->opacityAt(0.25), 0.5, 1e-9);
    EXPECT_NEAR(anchor->opacityAt(0.375), 0.375, 1e-9);
    EXPECT_NEAR(anchor->opacityAt(0.9), 0.5 * (0.25 + 0.6 * 0.5), 1e-9);
    EXPECT_NEAR(anchor->opacityAt(1.0), 0.375, 1e-9);
    // It stays beside another style.
    anchor->setStyle(Anchor::SOLID);
    EXPECT_NEAR(anchor->opacityAt(0.0), 0.5, 1e-9);
    anchor->setStyle(Anchor::TABLE);
    EXPECT_EQ(anchor->opacityAt(0.0), 0.0);
    EXPECT_TRUE(anchor->setTable(std::vector<float>(256, 1.0f)));
}

TEST(Anchor, RefusesWhatMakesNoSense)
{
    NotifyWatch watch;
    const osg::ref_ptr<Anchor> anchor = new Anchor;
    const std::function<bool()> attempts[] = {
        [&] { return anchor->setTable({}); },
        [&] { return anchor->setTable({1.0f}); },
        [&] { return anchor->setTable(std::vector<float>(257, 0.5f)); },
        [&] {
            return anchor->setTable({0.0f, 1.01f});
        },
        [&] {
            return anchor->setTable({-0.01f, 1.0f});
        },
        [&] {
            return anchor->setTable({notANumber, 1.0f});
        },
        [&] { return anchor->setOpacity(1.1); },
        [&] { return anchor->setOpacity(static_cast<double>(notANumber)); },
        [&] { return anchor->setLineWidth(65.0); },
        [&] { return anchor->setLineWidth(-1.0); },
        [&] { return anchor->setKind(static_cast<Anchor::Kind>(3)); },
        [&] { return anchor->setStyle(static_cast<Anchor::Style>(8)); },
    };
    for (const auto& attempt : attempts)
    {
        const auto messages = watch.messagesOf([&] { EXPECT_FALSE(attempt()); });
        ASSERT_EQ(messages.size(), 1u);
        EXPECT_NE(messages[0].find("osgGeoFX: Anchor: "), std::string::npos) << messages[0];
    }
    EXPECT_EQ(anchor->revision(), 0u);
    EXPECT_EQ(anchor->getStyle(), Anchor::FALLING);
    EXPECT_EQ(anchor->getTable(), (std::vector<float>{1.0f, 0.0f}));
}

TEST(Anchor, CopiesHaveTheTableToo)
{
    const osg::ref_ptr<Anchor> anchor = new Anchor;
    anchor->setTable({0.25f, 0.5f, 1.0f});
    anchor->setKind(Anchor::STRETCHED);
    anchor->setLineWidth(7.0);
    for (const auto flags : {osg::CopyOp::SHALLOW_COPY, osg::CopyOp::DEEP_COPY_ALL})
    {
        const osg::ref_ptr<Anchor> copy = osg::clone(anchor.get(), osg::CopyOp(flags));
        EXPECT_EQ(copy->getTable(), anchor->getTable());
        for (const Property& property : anchor->properties())
            EXPECT_EQ(property.get(*copy), property.get(*anchor)) << property.name;
    }
}

} // namespace
