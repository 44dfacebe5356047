// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// How many mappings and layers there may be: all are drawn, and what has no room goes in order of importance.
#include <tools/MappingStage.h>
#include <tools/RandomSamples.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace geofx::test;
using namespace osgGeoFX;

class MappingCounts : public MappingStage
{
protected:
    static constexpr double CELL = 5.0;

    /// The middles of cells in rows of `columns`, about the origin.
    static osg::Vec2d cell(int number, int columns)
    {
        const int x = number % columns - columns / 2;
        const int y = number / columns - columns / 2;
        return osg::Vec2d(x, y) * CELL;
    }
    std::vector<osg::ref_ptr<ProjectiveMapping>> addGrid(int count, int columns)
    {
        std::vector<osg::ref_ptr<ProjectiveMapping>> all;
        for (int i = 0; i < count; ++i)
        {
            all.push_back(makeSolid(cell(i, columns), 0.3 * CELL, colorOf(i)));
            _mappings->addMapping(all.back());
        }
        return all;
    }
    /// Of the picture, each cell's color and, at its corner, the ground's.
    void expectCells(const osg::Image& image, int count, int columns)
    {
        int seen = 0;
        for (int i = 0; i < count; ++i)
        {
            const osg::Vec2d middle = cell(i, columns);
            const osg::Vec2d pixel = pixelOf(middle);
            if (!inside(pixel, 6.0)) continue;
            ++seen;
            ASSERT_TRUE(alike(at(image, pixel), colorOf(i))) << "mapping " << i << " of " << count;
            ASSERT_TRUE(alike(at(image, pixelOf(middle + osg::Vec2d(0.48, 0.48) * CELL)), groundColor()))
                << "beside mapping " << i << " of " << count;
        }
        EXPECT_GE(seen, std::min(count, 200)) << count;
    }

    /// Which of the mappings can be seen, by their colors.
    std::vector<bool> shown(int count, int columns)
    {
        const osg::ref_ptr<osg::Image> image = draw();
        std::vector<bool> result;
        for (int i = 0; i < count; ++i)
        {
            const osg::Vec3d color = at(*image, pixelOf(cell(i, columns)));
            result.push_back(alike(color, colorOf(i)));
            EXPECT_TRUE(result.back() || alike(color, groundColor())) << i;
        }
        return result;
    }
    /// The same, and what is said.
    std::vector<bool> shown(int count, int columns, std::vector<std::string>& said)
    {
        std::vector<bool> result;
        said = watch().messagesOf([&] { result = shown(count, columns); });
        return result;
    }
    void resetMappings()
    {
        _scene->removeEffect(_mappings);
        _mappings = new ProjectiveMappings;
        _scene->addEffect(_mappings);
    }
};

TEST_F(MappingCounts, EachOfAThousandIsThere)
{
    for (const int count : {1, 16, 17, 256, 257, 1024})
    {
        const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
        resetMappings();
        addGrid(count, columns);
        lookDown({-0.5 * CELL, -0.5 * CELL}, CELL / 4.5);
        expectCells(*draw(), count, columns);
        EXPECT_EQ(_mappings->capacity().mappingsLeftOut, 0);
    }
}

TEST_F(MappingCounts, AnyOf65537IsThere)
{
    constexpr int count = 65537;
    constexpr int columns = 257;
    const auto all = addGrid(count, columns);
    // In the order in which they were added, though another one covers it.
    const osg::ref_ptr<ProjectiveMapping> last = makeSolid(cell(1234, columns), 0.25 * CELL, {1.0, 1.0, 1.0});
    _mappings->addMapping(last);
    const int windows = fullTest() ? 400 : 25;
    for (int i = 0; i < windows && !HasFailure(); ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const osg::Vec2d at =
            cell(random.integer(12, 244) * columns + random.integer(12, 244), columns) + osg::Vec2d(0.3, 0.3);
        lookDown(at, CELL / 7.0);
        // The one on top is not one of the grid's.
        if ((at - last->getCenter()).length() < 200.0) continue;
        expectCells(*draw(), count, columns);
    }
    lookDown(last->getCenter(), CELL / 7.0);
    EXPECT_TRUE(alike(at(*draw(), pixelOf(last->getCenter())), {1.0, 1.0, 1.0}));
    // The first and the last.
    for (const int i : {0, count - 1})
    {
        lookDown(cell(i, columns), CELL / 7.0);
        EXPECT_TRUE(alike(at(*draw(), pixelOf(cell(i, columns))), colorOf(i))) << i;
    }
    EXPECT_EQ(_mappings->capacity().mappingsLeftOut, 0);
    _mappings->removeMapping(all[0]);
    lookDown(cell(0, columns), CELL / 7.0);
    EXPECT_TRUE(alike(at(*draw(), pixelOf(cell(0, columns))), groundColor()));
}

TEST_F(MappingCounts, Stacked)
{
    // Each adds its share of light; all of them lie on the same sixteen pixels.
    for (const int count : {17, 257, 65537})
    {
        resetMappings();
        osg::ref_ptr<ColorTransfer> share = new ColorTransfer;
        share->setSource(ColorTransfer::CONSTANT);
        share->setBlendFunction(ColorTransfer::CONSTANT_ALPHA, ColorTransfer::ONE);
        share->setConstant({1.0, 0.5, 0.0, 0.6 / count});
        for (int i = 0; i < count; ++i)
        {
            osg::ref_ptr<ProjectiveMapping> mapping = makeSolid({0.0, 0.0}, 2.0, {1.0, 1.0, 1.0});
            mapping->setTransfer(share);
            _mappings->addMapping(mapping);
        }
        lookDown({0.0, 0.0}, 1.0);
        const osg::ref_ptr<osg::Image> image = draw();
        const osg::Vec3d expected = groundColor() + osg::Vec3d(0.6, 0.3, 0.0);
        for (int y = _height / 2 - 2; y < _height / 2 + 2; ++y)
        {
            for (int x = _width / 2 - 2; x < _width / 2 + 2; ++x)
                EXPECT_LE(difference(at(*image, x, y), expected), tolerance) << count;
        }
        EXPECT_TRUE(alike(at(*image, _width / 2 + 3, _height / 2), groundColor())) << count;
    }
}

TEST_F(MappingCounts, TheLeastImportantLayersHaveNoRoom)
{
    constexpr int count = 20;
    constexpr int columns = 5;
    _mappings->setPageSide(64);
    _mappings->setMaxPages(2);
    const auto all = addGrid(count, columns);
    std::vector<int> byImportance;
    Random random(1);
    for (int i = 0; i < count; ++i)
    {
        byImportance.insert(byImportance.begin() + random.integer(0, i), i);
        all[static_cast<std::size_t>(i)]->getTransfer()->setSource(ColorTransfer::LAYER);
    }
    for (int i = 0; i < count; ++i)
    {
        const int which = byImportance[static_cast<std::size_t>(i)];
        osg::ref_ptr<DataLayer> layer = new DataLayer(makeImage(32, colorOf(which)));
        layer->setImportance(1.0 - 0.04 * i);
        all[static_cast<std::size_t>(which)]->setLayer(layer);
    }
    lookDown({0.0, 0.0}, CELL / 7.0);
    std::vector<std::string> said;
    const auto expectShown = [&](int first, int end)
    {
        const std::vector<bool> seen = shown(count, columns, said);
        for (int i = 0; i < count; ++i)
        {
            const int which = byImportance[static_cast<std::size_t>(i)];
            EXPECT_EQ(seen[static_cast<std::size_t>(which)], i >= first && i < end) << i;
        }
        EXPECT_EQ(_mappings->capacity().layersLeftOut, count - end);
    };
    expectShown(0, 8);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("2 pages of 64 texels"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find("12 of 20"), std::string::npos) << said[0];
    EXPECT_EQ(_mappings->capacity().pages, 2);
    EXPECT_EQ(_mappings->capacity().pagesUsed, 2);
    expectShown(0, 8);
    EXPECT_TRUE(said.empty());
    // What is removed makes room for the next ones.
    for (int i = 0; i < count - 8; ++i)
    {
        _mappings->removeMapping(all[static_cast<std::size_t>(byImportance[static_cast<std::size_t>(i)])]);
        expectShown(i + 1, i + 9);
        EXPECT_TRUE(said.empty());
    }
    EXPECT_EQ(_mappings->capacity().layersLeftOut, 0);
}

TEST_F(MappingCounts, LargeLayersTakeNoMoreThanTheirRoom)
{
    // A page of sixteen small layers; then a large and important one comes.
    constexpr int count = 17;
    constexpr int columns = 5;
    for (int sample = 0; sample < 20 && !HasFailure(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        resetMappings();
        _mappings->setPageSide(64);
        _mappings->setMaxPages(1);
        const auto all = addGrid(count, columns);
        std::vector<int> byImportance;
        for (int i = 0; i < count - 1; ++i)
            byImportance.insert(byImportance.begin() + random.integer(0, i), i);
        for (int i = 0; i < count; ++i)
        {
            const bool large = i == count - 1;
            const int which = large ? i : byImportance[static_cast<std::size_t>(i)];
            osg::ref_ptr<DataLayer> layer = new DataLayer(makeImage(large ? 32 : 16, colorOf(which)));
            layer->setImportance(large ? 1.0 : 0.9 - 0.05 * i);
            ProjectiveMapping& mapping = *all[static_cast<std::size_t>(which)];
            mapping.setLayer(layer);
            mapping.getTransfer()->setSource(ColorTransfer::LAYER);
            mapping.setEnabled(!large);
        }
        _mappings->removeMapping(all.back());
        lookDown({0.0, 0.0}, CELL / 7.0);
        std::vector<std::string> said;
        std::vector<bool> seen = shown(count, columns, said);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 16);
        EXPECT_TRUE(said.empty());
        all.back()->setEnabled(true);
        _mappings->addMapping(all.back());
        seen = shown(count, columns, said);
        EXPECT_EQ(said.size(), 1u);
        EXPECT_TRUE(seen.back());
        for (int i = 0; i < count - 1; ++i)
        {
            EXPECT_EQ(seen[static_cast<std::size_t>(byImportance[static_cast<std::size_t>(i)])], i < 12)
                << i << " in sample " << sample;
        }
        EXPECT_EQ(_mappings->capacity().layersLeftOut, 4);
    }
}

TEST_F(MappingCounts, TheLeastImportantMappingsHaveNoRoom)
{
    constexpr int count = 900;
    constexpr int columns = 30;
    _mappings->setMaxDataSize(0.1);
    const auto all = addGrid(count, columns);
    Random random(2);
    std::vector<std::size_t> byImportance;
    for (std::size_t i = 0; i < count; ++i)
    {
        const auto place = random.integer(0, static_cast<int>(i));
        byImportance.insert(byImportance.begin() + place, i);
    }
    for (std::size_t i = 0; i < count; ++i)
        all[byImportance[i]]->setImportance(1.0 - static_cast<double>(i) / count);
    lookDown({-0.5 * CELL, -0.5 * CELL}, CELL / 5.0);
    std::vector<std::string> said;
    int end = 0;
    const auto expectShown = [&](int first)
    {
        const std::vector<bool> seen = shown(count, columns, said);
        end = count - _mappings->capacity().mappingsLeftOut;
        for (int i = 0; i < count; ++i)
        {
            EXPECT_EQ(seen[byImportance[static_cast<std::size_t>(i)]], i >= first && i < end) << i;
        }
    };
    expectShown(0);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("6553 texels"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find(std::to_string(count - end) + " of 900"), std::string::npos) << said[0];
    const ProjectiveMappings::Capacity full = _mappings->capacity();
    EXPECT_EQ(full.texels, 6553);
    EXPECT_LE(full.texelsUsed, full.texels);
    EXPECT_GT(end, 200);
    EXPECT_LT(end, count - 100);
    // A quarter of them go; others come.
    const int gone = end / 4;
    const int former = end;
    for (int i = 0; i < gone; ++i)
        _mappings->removeMapping(all[byImportance[static_cast<std::size_t>(i)]]);
    expectShown(gone);
    EXPECT_TRUE(said.empty());
    EXPECT_GT(end, former + gone / 2);
    // Those without importance give way to one that has it.
    all[byImportance.back()]->setImportance(1.0);
    std::vector<bool> seen = shown(count, columns, said);
    EXPECT_TRUE(seen[byImportance.back()]);
    EXPECT_TRUE(said.empty());
    all[byImportance.back()]->setImportance(0.0);
    // Room for all.
    _mappings->setMaxDataSize(16.0);
    expectShown(gone);
    EXPECT_TRUE(said.empty());
    EXPECT_EQ(end, count);
    // A new shortage is said anew.
    _mappings->setMaxDataSize(0.1);
    expectShown(gone);
    EXPECT_EQ(said.size(), 1u);
    EXPECT_LT(end, count);
}

TEST_F(MappingCounts, OfEquallyImportantOnesTheSmallOnesGo)
{
    constexpr int count = 900;
    constexpr int columns = 30;
    _mappings->setMaxDataSize(0.1);
    const auto all = addGrid(count, columns);
    for (std::size_t i = 0; i < count; ++i)
        all[i]->setRectangle(all[i]->getCenter(), (i % 3 ? 0.3 : 0.45) * CELL, 0.4 * CELL);
    lookDown({-0.5 * CELL, -0.5 * CELL}, CELL / 5.0);
    std::vector<std::string> said;
    const std::vector<bool> seen = shown(count, columns, said);
    EXPECT_EQ(said.size(), 1u);
    int small = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
        EXPECT_TRUE(i % 3 != 0 || seen[i]) << i;
        small += i % 3 && seen[i] ? 1 : 0;
    }
    EXPECT_LT(small, 500);
}
