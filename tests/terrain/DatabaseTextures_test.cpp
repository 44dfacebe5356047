// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Databases with compressed textures beside those of the same sources without.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/panorama/detail/NormalSampler.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/BlockDecoder.h>
#include <tools/DatabaseReader.h>
#include <tools/FolderContents.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>
#include <osg/TexMat>
#include <osg/Texture2D>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

constexpr unsigned int colors = 0, classes = 1, normals = 2, cover = 7;

/// Flat enough for normals of two channels, but for a cliff in the south-west.
double height(int column, int row, int)
{
    return 0.1 * relief(column, row) + (column < 10 && row > 46 ? 900.0 : 0.0);
}

const unsigned char* at(const osg::Image& image, int column, int row)
{
    return image.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
}

/// Bytes of a texture on the GPU, worked out texel by texel.
double bytesOf(const osg::Image& image, double bytesPerTexel, int blockBytes, bool mipmaps)
{
    double bytes = 0.0;
    for (int size = image.s();; size /= 2)
    {
        const double blocks = std::ceil(size / 4.0);
        bytes += blockBytes > 0 ? blocks * blocks * blockBytes : size * size * bytesPerTexel;
        if (size == 1 || !mipmaps) return bytes;
    }
}

struct Error
{
    double squares = 0.0, texels = 0.0;
    int largest = 0;

    void add(int difference)
    {
        squares += difference * difference;
        ++texels;
        largest = std::max(largest, std::abs(difference));
    }
    double rootMeanSquare() const { return std::sqrt(squares / texels); }
};

class DatabaseTextures : public ::testing::Test
{
protected:
    BuildOptions options(const std::string& output, int textureSize = 0)
    {
        BuildOptions result;
        result.dems = {_dem};
        result.imagery = {_imagery};
        result.landCover = _landCover;
        result.landCoverTable = _table;
        result.epsg = 32604;
        result.tileSize = 32;
        result.textureSize = textureSize;
        result.output = (_folder / output).string();
        return result;
    }

    BuildOptions compressed(const std::string& output, int textureSize = 0)
    {
        BuildOptions result = options(output, textureSize);
        result.compressTextures = true;
        return result;
    }

    /// Tiles of both kinds, in pairs.
    void
    visitPairs(const std::function<void(const DatabaseTile& plain, const DatabaseTile& compressed)>& visit)
    {
        const auto plain = readTiles((_folder / "plain").string()),
                   small = readTiles((_folder / "small").string());
        ASSERT_EQ(plain.size(), small.size());
        for (std::size_t i = 0; i < plain.size(); ++i)
        {
            ASSERT_EQ(plain[i].transform->getName(), small[i].transform->getName());
            SCOPED_TRACE(plain[i].transform->getName());
            if (!plain[i].geometry) continue;
            visit(plain[i], small[i]);
            if (HasFatalFailure()) return;
        }
    }

    const TempDir _folder;
    const std::string _dem = TestRaster(62, 54)
                                 .placed(600000.0, 2400000.0, 30.0, 30.0)
                                 .crs("EPSG:32604")
                                 .fill(height)
                                 .write(_folder / "dem.tif");
    /// Soft, as the ground is, with a little of what is not.
    const std::string _imagery =
        TestRaster(140, 122, 3, GDT_Byte)
            .placed(600000.0, 2400000.0, 13.7, 13.6)
            .crs("EPSG:32604")
            .fill(
                [](int column, int row, int band)
                {
                    return 128 +
                           std::lround(60.0 * std::sin(0.03 * column + 0.3 * band) * std::cos(0.02 * row)) +
                           (column * 7919 + row * 104729 + column * row * (band + 1)) % 9;
                })
            .write(_folder / "image.tif");
    const std::string _landCover =
        TestRaster(76, 66, 1, GDT_Byte)
            .placed(600000.0, 2400000.0, 25.0, 25.0)
            .crs("EPSG:32604")
            .fill([](int column, int row, int) { return 1 + (column / 20 + row / 30) % 2; })
            .write(_folder / "landcover.tif");
    const std::string _table =
        _folder.write("table.csv", "value,class,name,red,green,blue\n1,a,A,40,90,20\n2,b,B,160,150,90\n")
            .string();
};

TEST_F(DatabaseTextures, ColorsAndNormalsAreCompressedWithAllMipmaps)
{
    for (const int size : {0, 17, 19})
    {
        SCOPED_TRACE(size);
        buildDatabase(options("plain", size));
        buildDatabase(compressed("small", size));
        int pairs = 0, three = 0;
        visitPairs(
            [&](const DatabaseTile& plain, const DatabaseTile& small)
            {
                for (const unsigned int unit : {colors, normals})
                {
                    const osg::Image &before = *plain.image(unit), &after = *small.image(unit);
                    // Blocks of 4 × 4, without which OSG makes an error of it; not one more than need be.
                    ASSERT_EQ(after.s() % 4, 0);
                    ASSERT_EQ(after.s(), after.t());
                    ASSERT_GE(after.s(), before.s());
                    ASSERT_LT(after.s(), before.s() + 4);
                    if (unit == normals && before.getPixelFormat() == GL_RGB)
                    {
                        ++three;
                        ASSERT_EQ(after.getPixelFormat(), static_cast<GLenum>(GL_RGB));
                        for (int row = 0; row < before.t(); ++row)
                            ASSERT_EQ(std::memcmp(at(before, 0, row), at(after, 0, row), 3u * before.s()), 0);
                        continue;
                    }
                    const GLenum format =
                        unit == colors ? GL_COMPRESSED_RGB_S3TC_DXT1_EXT : GL_COMPRESSED_RED_GREEN_RGTC2_EXT;
                    ASSERT_EQ(after.getPixelFormat(), format);
                    ASSERT_EQ(after.getInternalTextureFormat(), static_cast<GLint>(format));
                    // From the whole size down to a single texel.
                    ASSERT_EQ(after.getNumMipmapLevels(),
                              1 + static_cast<unsigned int>(std::floor(std::log2(after.s()))));
                    ASSERT_EQ(after.getTotalSizeInBytesIncludingMipmaps(),
                              bytesOf(after, 0.0, unit == colors ? 8 : 16, true));
                }
                // Data as it is; beyond its end, the end again.
                for (const unsigned int unit : {classes, cover})
                {
                    const osg::Image &before = *plain.image(unit), &after = *small.image(unit);
                    ASSERT_EQ(after.getPixelFormat(), before.getPixelFormat());
                    ASSERT_EQ(after.s(), small.image(colors)->s());
                    const auto bytes = before.getPixelSizeInBits() / 8;
                    for (int row = 0; row < after.t(); ++row)
                        for (int column = 0; column < after.s(); ++column)
                            ASSERT_EQ(std::memcmp(at(after, column, row),
                                                  at(before, std::min(column, before.s() - 1),
                                                     std::min(row, before.t() - 1)),
                                                  bytes),
                                      0)
                                << unit << ": " << column << " " << row;
                }
                ++pairs;
            });
        EXPECT_GE(pairs, 4);
        EXPECT_GE(three, 1) << "the cliff is missing";
        EXPECT_LT(three, pairs);
    }
}

TEST_F(DatabaseTextures, TexelsStayInTheirPlace)
{
    buildDatabase(options("plain", 41));
    buildDatabase(compressed("small", 41));
    visitPairs(
        [&](const DatabaseTile& plain, const DatabaseTile& small)
        {
            const auto texel = [](const DatabaseTile& tile, unsigned int unit, const osg::Vec2& place)
            {
                const auto* matrix = dynamic_cast<const osg::TexMat*>(
                    tile.geometry->getStateSet()->getTextureAttribute(unit, osg::StateAttribute::TEXMAT));
                osg::Vec3d result(place, 0.0);
                if (matrix) result = result * matrix->getMatrix();
                return result * tile.image(unit)->s();
            };
            ASSERT_EQ(plain.places.size(), small.places.size());
            for (std::size_t i = 0; i < plain.places.size(); ++i)
                for (const unsigned int unit : {colors, normals})
                    ASSERT_LT(
                        (texel(plain, unit, plain.places[i]) - texel(small, unit, small.places[i])).length(),
                        1e-3)
                        << unit;
        });
}

/// What the builder says of errors and sizes is what a reader finds.
TEST_F(DatabaseTextures, SizesAndErrorsAreThoseOfTheFiles)
{
    const TextureSummary plainSummary = buildDatabase(options("plain")).textures;
    const BuildSummary built = buildDatabase(compressed("small"));
    const TextureSummary& summary = built.textures;
    std::array<Error, 3> color;
    std::array<Error, 2> normal;
    double bytes = 0.0, before = 0.0;
    visitPairs(
        [&](const DatabaseTile& plain, const DatabaseTile& small)
        {
            const osg::Image& was = *plain.image(colors);
            const osg::ref_ptr<osg::Image> is = decoded(*small.image(colors));
            for (int row = 0; row < was.t(); ++row)
                for (int column = 0; column < was.s(); ++column)
                    for (std::size_t channel = 0; channel < 3; ++channel)
                        color[channel].add(at(*is, column, row)[channel] - at(was, column, row)[channel]);
            const bool two = plain.image(normals)->getPixelFormat() == GL_RG;
            if (two)
            {
                const osg::Image& slopes = *plain.image(normals);
                const osg::ref_ptr<osg::Image> read = decoded(*small.image(normals));
                for (int row = 0; row < slopes.t(); ++row)
                    for (int column = 0; column < slopes.s(); ++column)
                        for (std::size_t channel = 0; channel < 2; ++channel)
                            normal[channel].add(at(*read, column, row)[channel] -
                                                at(slopes, column, row)[channel]);
            }
            before += bytesOf(was, 3.0, 0, true) + bytesOf(*plain.image(normals), two ? 2.0 : 3.0, 0, true) +
                      bytesOf(*plain.image(cover), 4.0, 0, true) +
                      bytesOf(*plain.image(classes), 1.0, 0, false);
            bytes += bytesOf(*small.image(colors), 0.0, 8, true) +
                     bytesOf(*small.image(normals), 3.0, two ? 16 : 0, true) +
                     bytesOf(*small.image(cover), 4.0, 0, true) +
                     bytesOf(*small.image(classes), 1.0, 0, false);
        });
    EXPECT_EQ(static_cast<double>(summary.bytes), bytes);
    EXPECT_EQ(static_cast<double>(summary.uncompressedBytes), before);
    EXPECT_EQ(plainSummary.bytes, summary.uncompressedBytes);
    EXPECT_EQ(plainSummary.uncompressedBytes, summary.uncompressedBytes);
    EXPECT_EQ(plainSummary.colors[0].largest, 0);
    // Blocks at borders, and what stays as it is, weigh more in textures as small as these.
    EXPECT_LT(bytes, 0.8 * before);
    for (std::size_t i = 0; i < 3; ++i)
    {
        EXPECT_NEAR(summary.colors[i].rootMeanSquare, color[i].rootMeanSquare(), 1e-9);
        EXPECT_EQ(summary.colors[i].largest, color[i].largest);
        // Far from what could not be told from the original, near enough to be nothing else.
        EXPECT_LT(color[i].rootMeanSquare(), 4.0);
        EXPECT_GT(color[i].rootMeanSquare(), 0.3);
        EXPECT_LT(color[i].largest, 60);
    }
    for (std::size_t i = 0; i < 2; ++i)
    {
        EXPECT_NEAR(summary.normals[i].rootMeanSquare, normal[i].rootMeanSquare(), 1e-9);
        EXPECT_EQ(summary.normals[i].largest, normal[i].largest);
        EXPECT_LT(normal[i].rootMeanSquare(), 3.0);
        EXPECT_LT(normal[i].largest, 20);
        EXPECT_GT(normal[i].texels, 3000.0);
    }
    // A finished database says the same when it is taken over, and to whoever reads its root.
    BuildOptions again = compressed("small");
    again.resume = true;
    const TextureSummary resumed = buildDatabase(again).textures;
    EXPECT_EQ(resumed.text(), summary.text());
    EXPECT_EQ(resumed.bytes, summary.bytes);
    const DatabaseRoot root(again.output);
    EXPECT_EQ(root.value<double>("geofx.textureBytes"), bytes);
    EXPECT_EQ(root.value<osg::Vec3d>("geofx.colorErrorLargest"),
              osg::Vec3d(color[0].largest, color[1].largest, color[2].largest));
}

/// Each mipmap's texels are means of those that they stand for, at the original's colors: none are lost, and none grow darker.
TEST_F(DatabaseTextures, MipmapsAreMeans)
{
    buildDatabase(options("plain", 41));
    buildDatabase(compressed("small", 41));
    int levels = 0;
    visitPairs(
        [&](const DatabaseTile& plain, const DatabaseTile& small)
        {
            for (const unsigned int unit : {colors, normals})
            {
                const osg::Image &was = *plain.image(unit), &image = *small.image(unit);
                if (!image.isCompressed()) continue;
                const std::size_t channels = unit == colors ? 3 : 2;
                for (unsigned int level = 1; level < image.getNumMipmapLevels(); ++level)
                {
                    const osg::ref_ptr<osg::Image> mipmap = decoded(image, level);
                    const double width = static_cast<double>(image.s()) / mipmap->s();
                    Error error;
                    double sum = 0.0;
                    for (int row = 0; row < mipmap->t(); ++row)
                        for (int column = 0; column < mipmap->s(); ++column)
                            for (std::size_t channel = 0; channel < channels; ++channel)
                            {
                                // Four probes a texel and edge: near enough, and worked out differently.
                                double mean = 0.0;
                                const int probes = 4 * std::max(1, static_cast<int>(width));
                                for (int i = 0; i < probes * probes; ++i)
                                {
                                    const double x = (column + (i % probes + 0.5) / probes) * width;
                                    const int line = i / probes;
                                    const double y = (row + (line + 0.5) / probes) * width;
                                    mean += at(was, std::min(static_cast<int>(x), was.s() - 1),
                                               std::min(static_cast<int>(y), was.t() - 1))[channel];
                                }
                                mean /= probes * probes;
                                const double off = at(*mipmap, column, row)[channel] - mean;
                                error.add(static_cast<int>(std::lround(off)));
                                sum += off;
                            }
                    ++levels;
                    // A block of a small mipmap has the colors of a large part of the tile.
                    const bool large = mipmap->s() >= 16;
                    ASSERT_LT(error.rootMeanSquare(), large ? 4.0 : 12.0) << unit << ", level " << level;
                    ASSERT_NEAR(sum / error.texels, 0.0, large ? 0.3 : 5.0) << unit << ", level " << level;
                }
            }
        });
    EXPECT_GT(levels, 40);
}

/// Strokes are laid by normals that the CPU reads: what the blocks say, between four texels.
TEST_F(DatabaseTextures, TheProcessorReadsCompressedNormals)
{
    buildDatabase(compressed("small"));
    int compared = 0;
    for (const DatabaseTile& tile : readTiles((_folder / "small").string()))
    {
        const osg::Image* image = tile.image(normals);
        if (!image || !image->isCompressed()) continue;
        const osg::ref_ptr<osg::Image> texels = decoded(*image);
        const NormalSampler sampler(*tile.geometry);
        ASSERT_TRUE(sampler.valid());
        const auto* matrix = dynamic_cast<const osg::TexMat*>(
            tile.geometry->getStateSet()->getTextureAttribute(normals, osg::StateAttribute::TEXMAT));
        for (const osg::Vec2& place : tile.places)
        {
            const osg::Vec2d coordinates(place);
            osg::Vec3d within(coordinates.x(), coordinates.y(), 0.0);
            if (matrix) within = within * matrix->getMatrix();
            const double x = within.x() * image->s() - 0.5, y = within.y() * image->t() - 0.5;
            const int column = static_cast<int>(x + 1e-6), row = static_cast<int>(y + 1e-6);
            const auto normal = sampler.at(coordinates.x(), coordinates.y());
            ASSERT_TRUE(normal);
            for (unsigned int i = 0; i < 2; ++i)
            {
                const auto value = [&](int right, int up)
                {
                    return (at(*texels, std::min(column + right, image->s() - 1),
                               std::min(row + up, image->t() - 1))[i] -
                            128.0) /
                           127.0;
                };
                const double east = x - column, north = y - row;
                const double expected = (1.0 - north) * ((1.0 - east) * value(0, 0) + east * value(1, 0)) +
                                        north * ((1.0 - east) * value(0, 1) + east * value(1, 1));
                // The test cuts off what lies between two bytes.
                ASSERT_NEAR((*normal)[i], expected, 1.1 / 127.0) << column << " " << row;
            }
            ++compared;
        }
    }
    EXPECT_GT(compared, 1000);
}

TEST_F(DatabaseTextures, SameBytesAndFiguresForAnyThreadsAndInterruptions)
{
    // Tiles small enough for two tiers of units.
    const auto optionsOf = [&](const std::string& output, int threads)
    {
        BuildOptions result = compressed(output, 16);
        result.tileSize = 8;
        result.threads = threads;
        return result;
    };
    const BuildOptions one = optionsOf("one", 1), four = optionsOf("four", 4);
    std::uint64_t steps = 0;
    const auto countSteps = [&](std::uint64_t, std::uint64_t total, const std::string&)
    {
        steps = total;
        return true;
    };
    const TextureSummary expected = buildDatabase(one, countSteps).textures;
    ASSERT_GT(expected.colors[0].largest, 0);
    EXPECT_EQ(buildDatabase(four).textures.text(), expected.text());
    EXPECT_EQ(contents(one.output), contents(four.output));
    std::uint64_t reused = 0;
    // The last units are those of tiles.
    for (const std::uint64_t left : {0u, 2u})
    {
        SCOPED_TRACE(left);
        BuildOptions part = optionsOf("part" + std::to_string(left), 2);
        EXPECT_THROW(buildDatabase(part, [&](std::uint64_t done, std::uint64_t, const std::string&)
                                   { return done < steps - left; }),
                     BuildError);
        part.resume = true;
        const BuildSummary summary = buildDatabase(part);
        reused += summary.tilesReused;
        EXPECT_EQ(summary.textures.text(), expected.text());
        EXPECT_EQ(summary.textures.bytes, expected.bytes);
        EXPECT_EQ(contents(part.output), contents(one.output));
    }
    EXPECT_GT(reused, 60u) << "hardly anything was taken over";
}

TEST_F(DatabaseTextures, AnInterruptedBuildIsNotContinuedWithOtherTextures)
{
    buildDatabase(options("db"));
    BuildOptions other = compressed("db");
    other.resume = true;
    EXPECT_THROW(buildDatabase(other), BuildError);
    buildDatabase(compressed("db"));
    other.compressTextures = false;
    EXPECT_THROW(buildDatabase(other), BuildError);
}

TEST_F(DatabaseTextures, TheProgramSaysWhatItCosts)
{
    const auto run = [&](const std::string& output, const std::vector<std::string>& more)
    {
        std::vector<std::string> arguments{builtProgram("osggeofx_build"),
                                           "--dem",
                                           _dem,
                                           "--imagery",
                                           _imagery,
                                           "--srs",
                                           "EPSG:32604",
                                           "--tile-size",
                                           "32",
                                           "-o",
                                           _folder / output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        return result.standardOutput;
    };
    BuildOptions same = compressed("same");
    same.landCover.clear();
    same.landCoverTable.clear();
    const std::string expected = buildDatabase(same).textures.text();
    EXPECT_NE(expected.find("red"), std::string::npos);
    EXPECT_NE(run("a", {"--compress-textures"}).find(expected), std::string::npos);
    EXPECT_NE(run("a", {"--compress-textures", "--resume"}).find(expected), std::string::npos);
    EXPECT_EQ(run("b", {"--compress-textures", "--quiet"}), "");
    EXPECT_EQ(run("c", {}).find("Textures"), std::string::npos);
}

/// Both sides of a border have the same texels before they are compressed, and blocks of their own.
TEST_F(DatabaseTextures, SeamsAreNoLargerThanErrorsElsewhere)
{
    buildDatabase(compressed("small", 41));
    buildDatabase(options("plain", 41));
    std::map<std::array<int, 3>, std::array<int, 3>> shared;
    Error seams, errors;
    visitPairs(
        [&](const DatabaseTile& plain, const DatabaseTile& small)
        {
            const osg::ref_ptr<osg::Image> is = decoded(*small.image(colors));
            const osg::Image& was = *plain.image(colors);
            const int m = was.s() - 1;
            for (int k = 0; k <= m; ++k)
                for (const auto& [column, row] : {std::pair(k, 0), std::pair(k, m), std::pair(0, k),
                                                  std::pair(m, k), std::pair(k, m / 2)})
                {
                    const unsigned char* texel = at(*is, column, row);
                    for (std::size_t i = 0; i < 3; ++i)
                        errors.add(texel[i] - at(was, column, row)[i]);
                    if (row == m / 2 && column > 0 && column < m) continue;
                    const auto [place, fresh] =
                        shared.try_emplace({small.level, small.x * m + column, small.y * m + row},
                                           std::array<int, 3>{texel[0], texel[1], texel[2]});
                    for (std::size_t i = 0; !fresh && i < 3; ++i)
                        seams.add(place->second[i] - texel[i]);
                }
        });
    EXPECT_GT(seams.texels, 3000.0);
    EXPECT_LT(seams.rootMeanSquare(), 1.5 * errors.rootMeanSquare());
    RecordProperty("seams", std::to_string(seams.rootMeanSquare()));
}

} // namespace
