// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Rasters that fail at one call or at one read, whichever it is: each reader ends in a sentence or in the right picture, and closes
// all that it has opened.
#include <geodata/RasterReaders.h>
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gdal_priv.h>

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

using namespace geofx::test;
using namespace geofx::test::readers;

namespace
{

/// Counts what may fail, and says when it does.
struct Failure
{
    static inline int calls = 0;
    static inline int first = 0; ///< the call that fails, from 1 on; 0: none
    static inline bool forever = false;

    static void plan(int call, bool all)
    {
        calls = 0;
        first = call;
        forever = all;
    }
    static bool isNow()
    {
        ++calls;
        return first > 0 && (forever ? calls >= first : calls == first);
    }
    static CPLErr failed()
    {
        CPLError(CE_Failure, CPLE_FileIO, "The disk has failed at call %d", calls);
        return CE_Failure;
    }
};

/// A band of a raster that fails.
class FailingBand final : public GDALRasterBand
{
public:
    FailingBand(GDALDataset* dataset, int number, GDALRasterBand& real) : _real(real)
    {
        poDS = dataset;
        nBand = number;
        nRasterXSize = real.GetXSize();
        nRasterYSize = real.GetYSize();
        eDataType = real.GetRasterDataType();
        real.GetBlockSize(&nBlockXSize, &nBlockYSize);
    }

    GDALColorInterp GetColorInterpretation() override { return _real.GetColorInterpretation(); }
    double GetNoDataValue(int* has) override { return _real.GetNoDataValue(has); }
    int GetMaskFlags() override { return _real.GetMaskFlags(); }
    GDALRasterBand* GetMaskBand() override
    {
        if (!_mask) _mask = std::make_unique<FailingBand>(nullptr, 0, *_real.GetMaskBand());
        return _mask.get();
    }
    int GetOverviewCount() override { return _real.GetOverviewCount(); }
    // GDAL itself takes for granted that there is one.
    GDALRasterBand* GetOverview(int index) override
    {
        std::unique_ptr<FailingBand>& result = _overviews[index];
        if (!result && _real.GetOverview(index))
            result = std::make_unique<FailingBand>(nullptr, 0, *_real.GetOverview(index));
        return result.get();
    }

protected:
    CPLErr IReadBlock(int column, int row, void* data) override
    {
        return Failure::isNow() ? Failure::failed() : _real.ReadBlock(column, row, data);
    }

private:
    GDALRasterBand& _real;
    std::unique_ptr<FailingBand> _mask;
    std::map<int, std::unique_ptr<FailingBand>> _overviews;
};

class FailingDataset final : public GDALDataset
{
public:
    explicit FailingDataset(geofx::test::DatasetPtr real) : _real(std::move(real))
    {
        nRasterXSize = _real->GetRasterXSize();
        nRasterYSize = _real->GetRasterYSize();
        for (int i = 1; i <= _real->GetRasterCount(); ++i)
            SetBand(i, new FailingBand(this, i, *_real->GetRasterBand(i)));
    }
    ~FailingDataset() override
    {
        // Before the raster that they read.
        for (int i = 0; i < nBands; ++i)
            delete papoBands[i];
        nBands = 0;
    }

    CPLErr GetGeoTransform(double* transform) override
    {
        return Failure::isNow() ? Failure::failed() : _real->GetGeoTransform(transform);
    }
    const OGRSpatialReference* GetSpatialRef() const override
    {
        return Failure::isNow() ? nullptr : _real->GetSpatialRef();
    }
    char** GetMetadata(const char* domain) override
    {
        return Failure::isNow() ? nullptr : _real->GetMetadata(domain);
    }

    /// A text file that names the raster.
    static int identify(GDALOpenInfo* info)
    {
        return info->nHeaderBytes > 8 && std::memcmp(info->pabyHeader, "FAILING ", 8) == 0;
    }
    static GDALDataset* open(GDALOpenInfo* info)
    {
        if (!identify(info)) return nullptr;
        if (Failure::isNow())
        {
            Failure::failed();
            return nullptr;
        }
        const std::string real(reinterpret_cast<const char*>(info->pabyHeader) + 8);
        geofx::test::DatasetPtr dataset(GDALDataset::Open(real.c_str(), GDAL_OF_RASTER));
        return dataset ? new FailingDataset(std::move(dataset)) : nullptr;
    }

private:
    const geofx::test::DatasetPtr _real;
};

/// While it lives, GDAL reads files that name rasters, which fail.
class FailingDriver
{
public:
    FailingDriver() : _driver(new GDALDriver)
    {
        _driver->SetDescription("Failing");
        _driver->SetMetadataItem(GDAL_DCAP_RASTER, "YES");
        _driver->pfnIdentify = FailingDataset::identify;
        _driver->pfnOpen = FailingDataset::open;
        GetGDALDriverManager()->RegisterDriver(_driver);
    }
    ~FailingDriver()
    {
        Failure::plan(0, false);
        GetGDALDriverManager()->DeregisterDriver(_driver);
        GDALDestroyDriver(_driver);
    }
    FailingDriver(const FailingDriver&) = delete;
    FailingDriver& operator=(const FailingDriver&) = delete;

private:
    GDALDriver* const _driver;
};

/// While it lives, "/vsifailing/PATH" is PATH on a disk that fails.
class FailingDisk
{
public:
    FailingDisk()
    {
        VSIFilesystemPluginCallbacksStruct* const calls = VSIAllocFilesystemPluginCallbacksStruct();
        calls->stat = [](void*, const char* name, VSIStatBufL* status, int flags)
        {
            return VSIStatExL(real(name).c_str(), status, flags);
        };
        calls->open = [](void*, const char* name, const char* access) -> void*
        {
            return Failure::isNow() ? nullptr : VSIFOpenL(real(name).c_str(), access);
        };
        calls->tell = [](void* file)
        {
            return VSIFTellL(static_cast<VSILFILE*>(file));
        };
        calls->seek = [](void* file, vsi_l_offset offset, int whence)
        {
            return VSIFSeekL(static_cast<VSILFILE*>(file), offset, whence);
        };
        calls->read = [](void* file, void* buffer, size_t size, size_t count) -> size_t
        {
            return Failure::isNow() ? 0 : VSIFReadL(buffer, size, count, static_cast<VSILFILE*>(file));
        };
        calls->eof = [](void* file)
        {
            return VSIFEofL(static_cast<VSILFILE*>(file));
        };
        calls->close = [](void* file)
        {
            return VSIFCloseL(static_cast<VSILFILE*>(file));
        };
        static bool once = VSIInstallPluginHandler("/vsifailing/", calls) == 0;
        EXPECT_TRUE(once);
        VSIFreeFilesystemPluginCallbacksStruct(calls);
    }
    ~FailingDisk() { Failure::plan(0, false); }
    FailingDisk(const FailingDisk&) = delete;
    FailingDisk& operator=(const FailingDisk&) = delete;

private:
    static std::string real(const char* name)
    {
        const std::string text = name;
        return text.compare(0, 12, "/vsifailing/") == 0 ? text.substr(12) : "/" + text;
    }
};

/// With a mask and overviews in it, in tiles; of two bands or three.
std::string writeRaster(const fs::path& file, DataLayer::Kind kind)
{
    const int bands = kind == DataLayer::COLOR ? 3 : kind == DataLayer::VALUE ? 2 : 1;
    CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
    TestRaster(columns, rows, bands, kind == DataLayer::VALUE ? GDT_UInt16 : GDT_Byte)
        .placed(west, north, pixel, pixel)
        .crs("EPSG:32604")
        .fill([](int column, int row, int band) { return (column / 16 + row / 16 + band) % 8; })
        .write(file, {"TILED=YES", "BLOCKXSIZE=128", "BLOCKYSIZE=128", "COMPRESS=DEFLATE"});
    const geofx::test::DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    EXPECT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
    std::vector<unsigned char> mask;
    for (int i = 0; i < columns * rows; ++i)
        mask.push_back(i % columns < 64 ? 0 : 255);
    EXPECT_EQ(dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, columns, rows, mask.data(),
                                                                 columns, rows, GDT_Byte, 0, 0, nullptr),
              CE_None);
    int factors[] = {2, 4};
    EXPECT_EQ(dataset->BuildOverviews("NEAREST", 2, factors, 0, nullptr, nullptr, nullptr), CE_None);
    CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
    return file.string();
}

/// While it lives, what GDAL reports by itself fails the test: a person gets the reader's sentence alone.
class QuietGdal
{
public:
    QuietGdal() : _before(CPLSetErrorHandler(&report)) {}
    ~QuietGdal() { CPLSetErrorHandler(_before); }
    QuietGdal(const QuietGdal&) = delete;
    QuietGdal& operator=(const QuietGdal&) = delete;

private:
    static void CPL_STDCALL report(CPLErr, CPLErrorNum, const char* text) { ADD_FAILURE() << text; }

    const CPLErrorHandler _before;
};

int openDatasets()
{
    int count = 0;
    GDALDataset::GetOpenDatasets(&count);
    return count;
}

bool isSame(const Picture& a, const Picture& b)
{
    if (a.width != b.width || a.height != b.height) return false;
    for (int row = 0; row < a.height; ++row)
        for (int column = 0; column < a.width; ++column)
        {
            const Picture::Texel left = a.at(column, row), right = b.at(column, row);
            if (left[3] != right[3]) return false;
            for (std::size_t i = 0; left[3] > 0.0 && i < 3; ++i)
                if (left[i] != right[i]) return false;
        }
    return true;
}

struct Case
{
    const char* name;
    DataLayer::Kind kind;
    Reader reader;
};

std::vector<Case> cases()
{
    return {{"mapping", DataLayer::COLOR, mapping},     {"tiled", DataLayer::COLOR, tiled},
            {"sequence", DataLayer::VALUE, sequence},   {"picture", DataLayer::COLOR, picture},
            {"overlay", DataLayer::COLOR, overlay},     {"surface", DataLayer::COLOR, surface},
            {"builder", DataLayer::COLOR, builder},     {"mapping", DataLayer::VALUE, mapping},
            {"picture", DataLayer::VALUE, picture},     {"builder", DataLayer::VALUE, builder},
            {"thinned", DataLayer::VALUE, thinned},     {"builder", DataLayer::CLASS, builder},
            {"colorized", DataLayer::CLASS, colorized}, {"mapping", DataLayer::CLASS, mapping}};
}

/// Lets each call fail in turn, once and from then on. `isStrict`: without a sentence, the picture is the right one.
void failAtEach(const Case& each, const std::string& file, bool isStrict)
{
    for (const int side : {columns, columns / 4})
    {
        std::string error;
        Failure::plan(0, false);
        const Picture right = each.reader(file, each.kind, side, error);
        ASSERT_EQ(error, "");
        ASSERT_GT(right.width, 0);
        const int calls = Failure::calls;
        ASSERT_GT(calls, 3);
        const int open = openDatasets();
        int sentences = 0;
        const int step = fullTest() ? 1 : std::max(1, calls / 8);
        for (const bool forever : {false, true})
            for (int call = 1; call <= calls; call += step)
            {
                SCOPED_TRACE(testing::Message() << each.name << ", " << side << " texels, call " << call
                                                << " of " << calls << (forever ? " and all after it" : ""));
                Failure::plan(call, forever);
                error.clear();
                const QuietGdal quiet;
                const Picture read = each.reader(file, each.kind, side, error);
                if (error.empty())
                {
                    EXPECT_EQ(read.width, right.width);
                    EXPECT_TRUE(!isStrict || isSame(read, right));
                }
                else
                {
                    ++sentences;
                    const std::string name = fs::path(file).filename().string();
                    // A panorama's copy is as good as what GDAL has said of the raster.
                    EXPECT_TRUE(error.find(name) != std::string::npos ||
                                error.find("thinned.tif") != std::string::npos)
                        << error;
                }
                EXPECT_EQ(openDatasets(), open);
            }
        EXPECT_GT(sentences, 0);
    }
}

} // namespace

TEST(FailingRasters, EachCallOfADatasetMayFail)
{
    const FailingDriver driver;
    for (const Case& each : cases())
    {
        const TempDir folder;
        const std::string real = writeRaster(folder / "real.tif", each.kind);
        fs::create_directory(folder / "steps");
        const std::string file = (folder / "steps" / "raster.failing").string();
        std::ofstream(file) << "FAILING " << real;
        failAtEach(each, file, true);
    }
}

TEST(FailingRasters, EachReadOfAFileMayFail)
{
    const FailingDisk disk;
    for (const Case& each : cases())
    {
        const TempDir folder;
        fs::create_directory(folder / "steps");
        const std::string real = writeRaster(folder / "steps" / "raster.tif", each.kind);
        failAtEach(each, "/vsifailing/" + real, false);
    }
}
