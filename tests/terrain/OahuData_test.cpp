// The data of the island of Oahu: one grid, no holes, and what everybody can look up in an atlas.
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace
{

const std::filesystem::path folder = std::filesystem::path(GEOFX_SOURCE_DIR) / "data" / "oahu";
constexpr int columns = 3240;
constexpr int rows = 2700;
constexpr double west = -158.4;
constexpr double north = 21.85;
constexpr double cell = 1.0 / 3600.0;

struct Class
{
    int value;
    std::string name;
    std::array<int, 3> color;
};

std::vector<std::string> split(const std::string& line)
{
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');)
        fields.push_back(field);
    return fields;
}

std::map<std::string, Class> readClasses()
{
    std::map<std::string, Class> classes;
    std::ifstream file(folder / "landcover.csv");
    std::string line;
    EXPECT_TRUE(std::getline(file, line));
    EXPECT_EQ(line, "value,class,name,red,green,blue");
    while (std::getline(file, line))
    {
        const std::vector<std::string> fields = split(line);
        if (fields.size() != 6)
        {
            ADD_FAILURE() << "a line of landcover.csv has not six fields: " << line;
            continue;
        }
        const Class c{std::stoi(fields[0]),
                      fields[2],
                      {std::stoi(fields[3]), std::stoi(fields[4]), std::stoi(fields[5])}};
        EXPECT_TRUE(classes.emplace(fields[1], c).second) << fields[1] << " stands in landcover.csv twice";
    }
    return classes;
}

/// Both rasters and the table, read once for all tests.
class OahuData : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        GDALAllRegister();
        elevation.reset(open("elevation.tif"));
        landcover.reset(open("landcover.tif"));
        if (!elevation || !landcover) return;
        heights.resize(size_t(columns) * rows);
        values.resize(size_t(columns) * rows);
        complete = read(*elevation, GDT_Float32, heights.data()) && read(*landcover, GDT_Byte, values.data());
        classes = readClasses();
    }

    static void TearDownTestSuite()
    {
        elevation.reset();
        landcover.reset();
        heights = {};
        values = {};
    }

    void SetUp() override { ASSERT_TRUE(complete) << "the rasters in " << folder << " cannot be read"; }

    static int column(double lon) { return int(std::floor((lon - west) / cell)); }
    static int row(double lat) { return int(std::floor((north - lat) / cell)); }
    static size_t index(double lon, double lat) { return size_t(row(lat)) * columns + size_t(column(lon)); }
    static float height(double lon, double lat) { return heights[index(lon, lat)]; }
    static int valueOf(const std::string& name) { return classes.count(name) ? classes.at(name).value : -1; }

    static std::string classAt(double lon, double lat)
    {
        for (const auto& [name, c] : classes)
            if (c.value == values[index(lon, lat)]) return name;
        return "none";
    }

    /// The share of a class in a box around a place.
    static double share(const std::string& name, double lon, double lat, int reach)
    {
        int found = 0;
        for (int y = row(lat) - reach; y <= row(lat) + reach; ++y)
            for (int x = column(lon) - reach; x <= column(lon) + reach; ++x)
                found += values[size_t(y) * columns + size_t(x)] == valueOf(name);
        return double(found) / ((2 * reach + 1) * (2 * reach + 1));
    }

    static std::unique_ptr<GDALDataset> elevation, landcover;
    static std::vector<float> heights;
    static std::vector<unsigned char> values;
    static std::map<std::string, Class> classes;

private:
    static GDALDataset* open(const char* name)
    {
        return GDALDataset::FromHandle(GDALOpen((folder / name).c_str(), GA_ReadOnly));
    }

    static bool read(GDALDataset& raster, GDALDataType type, void* cells)
    {
        return raster.GetRasterXSize() == columns && raster.GetRasterYSize() == rows &&
               raster.GetRasterCount() == 1 &&
               raster.GetRasterBand(1)->RasterIO(GF_Read, 0, 0, columns, rows, cells, columns, rows, type, 0,
                                                 0) == CE_None;
    }

    static bool complete;
};

std::unique_ptr<GDALDataset> OahuData::elevation, OahuData::landcover;
std::vector<float> OahuData::heights;
std::vector<unsigned char> OahuData::values;
std::map<std::string, Class> OahuData::classes;
bool OahuData::complete = false;

TEST_F(OahuData, LiesOnOneGridOfArcSeconds)
{
    for (GDALDataset* raster : {elevation.get(), landcover.get()})
    {
        ASSERT_NE(raster->GetSpatialRef(), nullptr);
        EXPECT_STREQ(raster->GetSpatialRef()->GetAuthorityCode(nullptr), "4326");
        std::array<double, 6> transform{};
        ASSERT_EQ(raster->GetGeoTransform(transform.data()), CE_None);
        const std::array<double, 6> expected{west, cell, 0, north, 0, -cell};
        for (size_t i = 0; i < 6; ++i)
            EXPECT_NEAR(transform[i], expected[i], 1e-12) << "coefficient " << i;
    }
    EXPECT_EQ(elevation->GetRasterBand(1)->GetRasterDataType(), GDT_Float32);
    EXPECT_EQ(landcover->GetRasterBand(1)->GetRasterDataType(), GDT_Byte);
}

TEST_F(OahuData, DeclaresNodataAndHasNone)
{
    int declared = 0;
    EXPECT_EQ(elevation->GetRasterBand(1)->GetNoDataValue(&declared), -32768.0);
    EXPECT_TRUE(declared);
    EXPECT_EQ(landcover->GetRasterBand(1)->GetNoDataValue(&declared), 0.0);
    EXPECT_TRUE(declared);
    EXPECT_TRUE(
        std::all_of(heights.begin(), heights.end(), [](float h) { return h >= 0.0f && h < 1300.0f; }));
    EXPECT_EQ(std::count(values.begin(), values.end(), 0), 0);
}

TEST_F(OahuData, IsSmallEnoughForARepository)
{
    EXPECT_LT(std::filesystem::file_size(folder / "elevation.tif") +
                  std::filesystem::file_size(folder / "landcover.tif"),
              4'000'000u);
}

TEST_F(OahuData, NamesEveryClassOnce)
{
    std::array<const Class*, 256> byValue{};
    for (const auto& [name, c] : classes)
    {
        EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos) << name;
        EXPECT_FALSE(c.name.empty()) << name;
        ASSERT_TRUE(c.value > 0 && c.value < 256) << name;
        EXPECT_EQ(byValue[size_t(c.value)], nullptr) << "two classes have the value " << c.value;
        byValue[size_t(c.value)] = &c;
        for (const int part : c.color)
            EXPECT_TRUE(part >= 0 && part <= 255) << name;
    }
    std::array<int, 256> count{};
    for (const unsigned char value : values)
        ++count[value];
    for (size_t value = 0; value < 256; ++value)
        EXPECT_EQ(count[value] > 0, byValue[value] != nullptr)
            << "value " << value << " is in landcover.tif or in landcover.csv, but not in both";
}

TEST_F(OahuData, CarriesTheColorsOfTheTable)
{
    const GDALColorTable* table = landcover->GetRasterBand(1)->GetColorTable();
    ASSERT_NE(table, nullptr);
    for (const auto& [name, c] : classes)
    {
        const GDALColorEntry* entry = table->GetColorEntry(c.value);
        ASSERT_NE(entry, nullptr) << name;
        EXPECT_EQ((std::array<int, 3>{entry->c1, entry->c2, entry->c3}), c.color) << name;
    }
}

TEST_F(OahuData, HasTheSeaAtZero)
{
    const int sea = valueOf("sea");
    size_t wrong = 0;
    for (size_t i = 0; i < values.size(); ++i)
        wrong += values[i] == sea && (heights[i] != 0.0f || std::signbit(heights[i]));
    EXPECT_EQ(wrong, 0u);
    for (const auto& [lon, lat] :
         {std::pair{-157.60, 21.15}, {-158.35, 21.80}, {-157.55, 21.80}, {-158.3, 21.3}})
        EXPECT_EQ(classAt(lon, lat), "sea") << lat << " N " << lon;
    EXPECT_EQ(classAt(-157.9741, 21.3657), "sea") << "Pearl Harbor";
}

TEST_F(OahuData, HasTheAreaOfTheIsland)
{
    const double a = 6378.137;
    const double e2 = 0.00669437999;
    double area = 0.0;
    for (int y = 0; y < rows; ++y)
    {
        const double lat = (north - (y + 0.5) * cell) * M_PI / 180.0;
        const double w2 = 1.0 - e2 * std::sin(lat) * std::sin(lat);
        const double size = a * a * (1.0 - e2) * std::cos(lat) / (w2 * w2) * std::pow(cell * M_PI / 180.0, 2);
        const auto begin = values.begin() + std::ptrdiff_t(y) * columns;
        area += size * double(columns - std::count(begin, begin + columns, valueOf("sea")));
    }
    EXPECT_NEAR(area, 1545.0, 0.03 * 1545.0);
}

TEST_F(OahuData, CulminatesOnKaala)
{
    const size_t top = size_t(std::max_element(heights.begin(), heights.end()) - heights.begin());
    EXPECT_NEAR(heights[top], 1227.0f, 10.0f);
    const size_t row = top / columns;
    const size_t column = top % columns;
    EXPECT_NEAR(north - (double(row) + 0.5) * cell, 21.507, 0.005);
    EXPECT_NEAR(west + (double(column) + 0.5) * cell, -158.143, 0.005);
}

TEST_F(OahuData, HasTheCraterOfDiamondHead)
{
    const float floor = height(-157.8055, 21.2625);
    EXPECT_NEAR(floor, 65.0f, 15.0f);
    float rim = 0.0f;
    for (double lat = 21.252; lat < 21.270; lat += cell)
        for (double lon = -157.818; lon < -157.796; lon += cell)
            rim = std::max(rim, height(lon, lat));
    EXPECT_GT(rim, floor + 100.0f);
    EXPECT_LT(rim, 240.0f);
}

TEST_F(OahuData, HasTheAirportOfHonolulu)
{
    // Runways 8L and, on the reef, 8R; their ends stand between 2 and 4 m above the sea.
    for (const auto& [lon, lat] : {std::pair{-157.9300, 21.3251}, {-157.9300, 21.3068}})
    {
        EXPECT_EQ(classAt(lon, lat), "runway") << lat << " N " << lon;
        EXPECT_NEAR(height(lon, lat), 4.0f, 3.0f) << lat << " N " << lon;
    }
    EXPECT_GT(share("runway", -157.93, 21.318, 60) + share("apron", -157.93, 21.318, 60) +
                  share("airfield_grass", -157.93, 21.318, 60),
              0.6);
}

TEST_F(OahuData, HasTheTown)
{
    const double built = share("urban", -157.8605, 21.3085, 20) + share("town", -157.8605, 21.3085, 20) +
                         share("road", -157.8605, 21.3085, 20);
    EXPECT_GT(built, 0.6) << "downtown Honolulu";
    EXPECT_GT(share("road", -157.8605, 21.3085, 20), 0.1) << "downtown Honolulu";
}

TEST_F(OahuData, HasLevelLakes)
{
    const double reach = 0.0105;
    float lowest = 1e6f;
    float highest = -1e6f;
    int found = 0;
    for (double lat = 21.4953 - reach; lat < 21.4953 + reach; lat += cell)
        for (double lon = -158.0405 - reach; lon < -158.0405 + reach; lon += cell)
            if (values[index(lon, lat)] == valueOf("lake"))
            {
                ++found;
                lowest = std::min(lowest, height(lon, lat));
                highest = std::max(highest, height(lon, lat));
            }
    EXPECT_GT(found, 500) << "Lake Wilson";
    EXPECT_EQ(lowest, highest) << "Lake Wilson";
    EXPECT_NEAR(lowest, 258.0f, 6.0f) << "Lake Wilson";
}

TEST_F(OahuData, HasNoSpikesAndNoTrenches)
{
    // Whatever stands out so far from all that is two cells away is a flaw. (Crags of the Koolau ridge, where
    // the slopes around them are missing in the source, stand out by 95 m.)
    size_t flaws = 0;
    for (int y = 2; y < rows - 2; ++y)
        for (int x = 2; x < columns - 2; ++x)
        {
            const float* h = &heights[size_t(y) * columns + size_t(x)];
            if (*h == 0.0f) continue;
            float low = 1e6f;
            float high = -1e6f;
            for (int i = -2; i <= 2; ++i)
                for (const float* other :
                     {h - 2 * columns + i, h + 2 * columns + i, h + i * columns - 2, h + i * columns + 2})
                {
                    low = std::min(low, *other);
                    high = std::max(high, *other);
                }
            flaws += *h > high + 100.0f || *h < low - 40.0f;
        }
    EXPECT_EQ(flaws, 0u);
    // The tunnels of H-3 lead through the ridge and not through a trench across it.
    for (double lon = -157.8445; lon < -157.8365; lon += cell)
        EXPECT_GT(height(lon, 21.4041), 480.0f) << lon;
}

TEST_F(OahuData, HasNoSeamsBetweenTiles)
{
    // The scenery's tiles meet at every eighth of a degree. The ground rises there no more than next to it.
    const auto rise = [](int line, bool meridian)
    {
        double sum = 0.0;
        for (int i = 0; i < (meridian ? rows : columns); ++i)
        {
            const size_t here =
                meridian ? size_t(i) * columns + size_t(line) : size_t(line) * columns + size_t(i);
            sum += std::abs(double(heights[here] - heights[meridian ? here - 1 : here - columns]));
        }
        return sum;
    };
    const auto expectNoSeam = [&](double degree, int line, bool meridian)
    {
        double beside = 0.0;
        for (const int offset : {-2, -1, 1, 2})
            beside += rise(line + offset, meridian) / 4.0;
        EXPECT_LT(rise(line, meridian), 1.1 * beside) << degree;
    };
    for (const double lon : {-158.25, -158.125, -158.0, -157.875, -157.75})
        expectNoSeam(lon, int(std::lround((lon - west) / cell)), true);
    for (const double lat : {21.375, 21.5, 21.625})
        expectNoSeam(lat, int(std::lround((north - lat) / cell)), false);
}

} // namespace
