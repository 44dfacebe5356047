// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Maps of values, their lines and their legends.
#include <osgGeoFX/mapping/ValueMap.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/Texture2D>
#include <osg/ValueObject>
#include <osgText/Text>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

using namespace osgGeoFX;
using geofx::test::Random;
using osg::Vec2d;

namespace
{

/// Values that rise by one for each metre to the right, on 64² texels of 10 m.
osg::ref_ptr<DataLayer> slope()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(64, 64, 1, GL_LUMINANCE, GL_FLOAT);
    for (int row = 0; row < 64; ++row)
    {
        for (int column = 0; column < 64; ++column)
            *reinterpret_cast<float*>(image->data(column, row)) = 10.0f * (static_cast<float>(column) + 0.5f);
    }
    osg::ref_ptr<DataLayer> layer = new DataLayer(image);
    layer->setKind(DataLayer::VALUE);
    return layer;
}

double floatAt(const osg::Image& image, int column, int row)
{
    return static_cast<double>(*reinterpret_cast<const float*>(image.data(column, row)));
}

/// Whether a setter refuses, with one warning.
bool refused(const std::function<bool()>& set)
{
    geofx::test::NotifyWatch watch;
    bool taken = true;
    const std::vector<std::string> messages = watch.messagesOf([&] { taken = set(); });
    return !taken && messages.size() == 1;
}

} // namespace

TEST(ValueMap, linesLieWhereTheValuesAre)
{
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    osg::ref_ptr<ColorTable> colors = ColorTable::named("viridis", 0.0, 640.0);
    {
        osg::ref_ptr<ValueMap> map = new ValueMap(*mappings, slope(), colors, 3);
        map->mapping().setRectangle({0, 0}, 320.0, 320.0);
        EXPECT_EQ(map->getHigh(), 640.0);
        EXPECT_EQ(mappings->getNumMappings(), 1u);
        ASSERT_TRUE(map->setLines(100.0, 8.0));
        ASSERT_TRUE(map->lines());
        EXPECT_EQ(mappings->getNumMappings(), 2u);
        EXPECT_EQ(mappings->mappingsAt({0, 0}).front(), map->lines());
        const osg::Image& image = *map->lines()->getLayer()->getImage();
        ASSERT_EQ(image.s(), 512);
        // The slope is 1: what the value lacks to the line is how far it is. The last texels have no neighbours.
        for (int column = 8; column < image.s() - 8; ++column)
        {
            const double value = (column + 0.5) * 640.0 / image.s();
            const double to = std::abs(value - std::clamp(std::round(value / 100.0), 1.0, 6.0) * 100.0);
            if (to < 20.0)
            {
                ASSERT_NEAR(floatAt(image, column, 100), to, 0.01) << value;
            }
        }
        EXPECT_LT(map->lines()->getTransfer()->getRampHigh(), 4.0);
        EXPECT_GT(map->lines()->getTransfer()->getRampLow(), 4.0);

        // They follow the map, and are made anew where its size changes.
        map->mapping().setCenter({50, 60});
        EXPECT_EQ(map->lines()->getCenter(), Vec2d(50, 60));
        map->mapping().setOpacity(0.5);
        EXPECT_NEAR(map->lines()->getOpacity(), 0.3, 1e-6);
        map->mapping().setRectangle({0, 0}, 640.0, 320.0);
        EXPECT_NEAR(floatAt(*map->lines()->getLayer()->getImage(), 84, 100), 2.0 * (84.5 * 1.25 - 100.0),
                    0.02);
        map->setRange(150.0, 250.0);
        EXPECT_EQ(map->mapping().getTransfer()->getLowValue(), 150.0);
        EXPECT_GT(floatAt(*map->lines()->getLayer()->getImage(), 80, 100), 8.0) << "a line below the range";
        map->setLines(0.0);
        EXPECT_FALSE(map->lines());
        EXPECT_EQ(mappings->getNumMappings(), 1u);
        map->setLines(100.0);
        EXPECT_TRUE(refused([&] { return static_cast<bool>(map->setRange(3.0, 3.0)); }));
        EXPECT_TRUE(refused([&] { return static_cast<bool>(map->setColors(nullptr)); }));
        EXPECT_TRUE(refused([&] { return static_cast<bool>(map->setLines(-1.0)); }));
    }
    EXPECT_EQ(mappings->getNumMappings(), 0u);
}

TEST(ValueLegend, ticksAreRound)
{
    const auto ticks = [](double low, double high, int most)
    {
        std::string text;
        const std::vector<double> values = roundTicks(low, high, most);
        for (const double value : values)
            text += tickText(value, values.size() > 1 ? values[1] - values[0] : 0.0) + " ";
        return text;
    };
    EXPECT_EQ(ticks(0.0, 100.0, 6), "0 20 40 60 80 100 ");
    EXPECT_EQ(ticks(40.0, 85.0, 6), "40 50 60 70 80 ");
    EXPECT_EQ(ticks(-0.03, 0.031, 7), "\u22120.03 \u22120.02 \u22120.01 0.00 0.01 0.02 0.03 ");
    EXPECT_EQ(ticks(0.0, 0.5, 3), "0.0 0.2 0.4 ");
    EXPECT_EQ(ticks(1234.0, 5678.0, 5), "2000 3000 4000 5000 ");
    EXPECT_EQ(ticks(5.0, 5.0, 5), "");
    Random random(9);
    for (int i = 0; i < geofx::test::sampleCount(); ++i)
    {
        const double low = random.sign() * random.logarithmic(1e-6, 1e6);
        const double high = low + random.logarithmic(1e-6, 1e6);
        const int most = random.integer(2, 12);
        const std::vector<double> values = roundTicks(low, high, most);
        ASSERT_LE(values.size(), static_cast<std::size_t>(most));
        ASSERT_GE(values.size(), 1u) << low << " to " << high << ", at most " << most;
        ASSERT_GE(values.front(), low - 1e-6 * (high - low));
        ASSERT_LE(values.back(), high + 1e-6 * (high - low));
    }
}

TEST(ValueLegend, hasTheMapsColorsAndTicksWhereTheyBelong)
{
    const osg::ref_ptr<ColorTable> colors = ColorTable::named("viridis", 40.0, 85.0);
    LegendStyle style;
    style.title = "Noise";
    style.unit = "dB(A)";
    const osg::ref_ptr<osg::Group> legend = makeLegend(*colors, 40.0, 85.0, style);
    ASSERT_TRUE(legend);
    double height = 0.0;
    EXPECT_TRUE(legend->getUserValue("height", height));
    EXPECT_GT(height, style.barHeight + 2.0 * style.textSize);
    const osg::Image* bar = nullptr;
    osg::BoundingBox box;
    std::map<std::string, double> texts;
    for (unsigned int i = 0; i < legend->getNumChildren(); ++i)
    {
        if (auto* text = dynamic_cast<osgText::Text*>(legend->getChild(i)))
            texts[text->getText().createUTF8EncodedString()] = static_cast<double>(text->getPosition().x());
        osg::Geometry* geometry = legend->getChild(i)->asGeometry();
        const osg::StateSet* state = geometry ? geometry->getStateSet() : nullptr;
        if (!state) continue;
        const auto* texture =
            dynamic_cast<const osg::Texture2D*>(state->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
        if (!texture) continue;
        bar = texture->getImage();
        box = geometry->getBoundingBox();
    }
    ASSERT_TRUE(bar);
    ASSERT_EQ(texts.count("Noise, dB(A)"), 1u);
    EXPECT_EQ(texts.size(), 6u);
    for (const double value : {40.0, 50.0, 80.0})
    {
        const double share = (value - 40.0) / 45.0;
        const double x =
            static_cast<double>(box.xMin()) + share * static_cast<double>(box.xMax() - box.xMin());
        const std::string text = tickText(value, 10.0);
        ASSERT_EQ(texts.count(text), 1u) << text;
        EXPECT_NEAR(texts[text], x, 0.01);
        const int column = std::min(static_cast<int>(share * bar->s()), bar->s() - 1);
        const osg::Vec4 drawn = bar->getColor(static_cast<unsigned int>(column), 0);
        EXPECT_LT((drawn - colors->at(value)).length(), 0.02f) << value;
    }
    EXPECT_TRUE(refused([&] { return makeLegend(*colors, 1.0, 1.0, style).valid(); }));
}

TEST(ValueLegend, namesClasses)
{
    osg::ref_ptr<ColorTable> colors = new ColorTable;
    colors->addStop(1.0, {1, 0, 0, 1});
    colors->addStop(4.0, {0, 1, 0, 1});
    colors->addStop(9.0, {0, 0, 1, 1});
    colors->setMode(ColorTable::EXACT);
    LegendStyle style;
    style.names = {{1.0, "Water"}, {4.0, "Wood"}};
    const osg::ref_ptr<osg::Group> legend = makeLegend(*colors, 0.0, 10.0, style);
    ASSERT_TRUE(legend);
    std::set<std::string> texts;
    for (unsigned int i = 0; i < legend->getNumChildren(); ++i)
    {
        if (auto* text = dynamic_cast<osgText::Text*>(legend->getChild(i)))
            texts.insert(text->getText().createUTF8EncodedString());
    }
    EXPECT_EQ(texts, (std::set<std::string>{"Water", "Wood", "9"}));
}
