// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/RasterMask.h>

#include <osgGeoFX/geodata/detail/VirtualNames.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Whether GDAL has a mask of the raster's own, not one of no-data values or alpha.
bool hasOwnMask(GDALRasterBand& band)
{
    const int flags = band.GetMaskFlags();
    return !(flags & (GMF_ALL_VALID | GMF_ALPHA)) && flags != GMF_NODATA;
}

bool hasNoData(GDALRasterBand& band)
{
    int has = FALSE;
    const GDALDataType type = band.GetRasterDataType();
    if (type == GDT_Int64)
        band.GetNoDataValueAsInt64(&has);
    else if (type == GDT_UInt64)
        band.GetNoDataValueAsUInt64(&has);
    else
    {
        const double value = band.GetNoDataValue(&has);
        return has && GDALNoDataMaskBand::IsNoDataInRange(value, type);
    }
    return has != FALSE;
}

/// Files that a virtual raster is looked up in.
constexpr std::size_t mostLooked = 16;

/// Some of the files that a virtual raster is made of, from all over it; those of other rasters are none.
std::vector<std::string> someSourcesOf(GDALDataset& dataset)
{
    const char* const* const xml = dataset.GetMetadata("xml:VRT");
    if (!xml || !*xml) return {};
    const std::string file = dataset.GetDescription();
    std::vector<std::string> names = VirtualNames::in(*xml, file);
    // A virtual raster's overviews are virtual rasters of it, and do not name it.
    if (names.empty() && !file.empty()) names.push_back(file);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    if (names.size() <= mostLooked) return names;
    std::vector<std::string> some;
    for (std::size_t i = 0; i < mostLooked; ++i)
        some.push_back(names[i * names.size() / mostLooked]);
    return some;
}

/// Whether JPEG has kept a raster, or a file of a virtual one. `looks`: how many files may still be opened.
bool isOfJpeg(GDALDataset& dataset, std::size_t& looks)
{
    const char* const compression = dataset.GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE");
    if (compression && std::string(compression).find("JPEG") != std::string::npos) return true;
    const std::vector<std::string> sources = someSourcesOf(dataset);
    return std::any_of(sources.begin(), sources.end(),
                       [&](const std::string& name)
                       {
                           if (looks == 0) return false;
                           --looks;
                           const DatasetPtr source(GDALDataset::Open(name.c_str(), GDAL_OF_RASTER));
                           return source && isOfJpeg(*source, looks);
                       });
}

bool isOfJpeg(GDALDataset& dataset)
{
    const GdalErrorScope quiet;
    std::size_t looks = 2 * mostLooked;
    return isOfJpeg(dataset, looks);
}

bool isOfJpeg(GDALRasterBand& band)
{
    return band.GetDataset() && isOfJpeg(*band.GetDataset());
}

/** Which pixels of a band with bytes have its no-data value, where JPEG has kept them. JPEG rounds the value that fills a hole: in
    overviews of its usual quality, 75, by up to 3, and by more only along the hole's border, where it mixes both sides. */
class RoughNoDataMask final : public GDALRasterBand
{
public:
    explicit RoughNoDataMask(GDALRasterBand& values) : _values(values), _noData(values.GetNoDataValue())
    {
        nRasterXSize = values.GetXSize();
        nRasterYSize = values.GetYSize();
        eDataType = GDT_Byte;
        values.GetBlockSize(&nBlockXSize, &nBlockYSize);
    }

protected:
    CPLErr IReadBlock(int column, int row, void* data) override
    {
        constexpr double rounding = 3.0;
        if (_values.ReadBlock(column, row, data) != CE_None) return CE_Failure;
        auto* const bytes = static_cast<unsigned char*>(data);
        std::transform(bytes, bytes + static_cast<std::ptrdiff_t>(nBlockXSize) * nBlockYSize, bytes,
                       [&](unsigned char value)
                       {
                           return std::abs(value - _noData) <= rounding ? static_cast<unsigned char>(0)
                                                                        : static_cast<unsigned char>(255);
                       });
        return CE_None;
    }

private:
    GDALRasterBand& _values;
    const double _noData;
};

/// `isRough`: whether the band keeps its values only roughly.
std::unique_ptr<GDALRasterBand> noDataMaskOf(GDALRasterBand& band, bool isRough)
{
    if (isRough && band.GetRasterDataType() == GDT_Byte) return std::make_unique<RoughNoDataMask>(band);
    return std::make_unique<GDALNoDataMaskBand>(&band);
}

/// What alpha has where all of a pixel is seen.
double opaque(GDALRasterBand& alpha)
{
    switch (alpha.GetRasterDataType())
    {
    case GDT_Byte:
        return 255.0;
    case GDT_UInt16:
        return 65535.0;
    default:
        return 1.0;
    }
}

bool readAlpha(GDALRasterBand& alpha, int left, int top, int columns, int rows,
               std::vector<unsigned char>& out)
{
    std::vector<double> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    if (alpha.RasterIO(GF_Read, left, top, columns, rows, values.data(), columns, rows, GDT_Float64, 0, 0,
                       nullptr) != CE_None)
        return false;
    const double most = opaque(alpha);
    out.resize(values.size());
    std::transform(
        values.begin(), values.end(), out.begin(),
        [&](double value)
        { return static_cast<unsigned char>(std::lround(255.0 * std::clamp(value / most, 0.0, 1.0))); });
    return true;
}

void multiply(unsigned char* mask, const std::vector<unsigned char>& other)
{
    for (std::size_t i = 0; i < other.size(); ++i)
        mask[i] = static_cast<unsigned char>((mask[i] * other[i] + 127) / 255);
}

class MaskedRaster;

/// Of a MaskedRaster.
class MaskedBand final : public GDALRasterBand
{
public:
    /// `values`: null for alpha.
    MaskedBand(MaskedRaster& raster, int number, GDALRasterBand* values, GDALDataType type,
               GDALRasterBand& blocks);

    GDALColorInterp GetColorInterpretation() override
    {
        return _values ? _values->GetColorInterpretation() : GCI_AlphaBand;
    }
    double GetNoDataValue(int* has) override;
    double GetScale(int* has) override
    {
        return _values ? _values->GetScale(has) : GDALRasterBand::GetScale(has);
    }
    double GetOffset(int* has) override
    {
        return _values ? _values->GetOffset(has) : GDALRasterBand::GetOffset(has);
    }
    const char* GetUnitType() override
    {
        return _values ? _values->GetUnitType() : GDALRasterBand::GetUnitType();
    }

protected:
    CPLErr IReadBlock(int column, int row, void* data) override;

private:
    GDALRasterBand* const _values;
};

class MaskedRaster final : public GDALDataset
{
public:
    MaskedRaster(GDALDataset& below, std::unique_ptr<RasterMask> raster, RasterMask::Form shape)
        : mask(std::move(raster)), form(shape), _below(below)
    {
        nRasterXSize = below.GetRasterXSize();
        nRasterYSize = below.GetRasterYSize();
        GDALRasterBand& first = *below.GetRasterBand(1);
        if (form == RasterMask::Form::NOT_A_NUMBER)
        {
            // A float holds these exactly.
            const GDALDataType type = first.GetRasterDataType();
            const bool isFloat =
                type == GDT_Byte || type == GDT_Int16 || type == GDT_UInt16 || type == GDT_Float32;
            SetBand(1, new MaskedBand(*this, 1, &first, isFloat ? GDT_Float32 : GDT_Float64, first));
            return;
        }
        const int count = below.GetRasterCount();
        if (below.GetRasterBand(count)->GetColorInterpretation() == GCI_AlphaBand)
            alphaBelow = below.GetRasterBand(count);
        const int colors = alphaBelow ? count - 1 : count;
        for (int i = 1; i <= colors; ++i)
        {
            GDALRasterBand* const values = below.GetRasterBand(i);
            SetBand(i, new MaskedBand(*this, i, values, values->GetRasterDataType(), first));
        }
        SetBand(colors + 1, new MaskedBand(*this, colors + 1, nullptr, GDT_Byte, first));
    }

    CPLErr GetGeoTransform(double* transform) override { return _below.GetGeoTransform(transform); }
    const OGRSpatialReference* GetSpatialRef() const override { return _below.GetSpatialRef(); }
    int GetGCPCount() override { return _below.GetGCPCount(); }
    const OGRSpatialReference* GetGCPSpatialRef() const override { return _below.GetGCPSpatialRef(); }
    const GDAL_GCP* GetGCPs() override { return _below.GetGCPs(); }
    // Rational polynomials and arrays of places are metadata.
    char** GetMetadata(const char* domain) override { return _below.GetMetadata(domain); }
    const char* GetMetadataItem(const char* name, const char* domain) override
    {
        return _below.GetMetadataItem(name, domain);
    }

    const std::unique_ptr<RasterMask> mask;
    const RasterMask::Form form;
    GDALRasterBand* alphaBelow = nullptr;

private:
    GDALDataset& _below;
};

MaskedBand::MaskedBand(MaskedRaster& raster, int number, GDALRasterBand* values, GDALDataType type,
                       GDALRasterBand& blocks)
    : _values(values)
{
    poDS = &raster;
    nBand = number;
    eDataType = type;
    nRasterXSize = raster.GetRasterXSize();
    nRasterYSize = raster.GetRasterYSize();
    blocks.GetBlockSize(&nBlockXSize, &nBlockYSize);
}

double MaskedBand::GetNoDataValue(int* has)
{
    const bool isNumber = static_cast<MaskedRaster&>(*poDS).form == RasterMask::Form::NOT_A_NUMBER;
    if (has) *has = isNumber;
    return isNumber ? std::numeric_limits<double>::quiet_NaN() : 0.0;
}

CPLErr MaskedBand::IReadBlock(int column, int row, void* data)
{
    auto& raster = static_cast<MaskedRaster&>(*poDS);
    const int left = column * nBlockXSize, top = row * nBlockYSize;
    const int columns = std::min(nBlockXSize, nRasterXSize - left);
    const int rows = std::min(nBlockYSize, nRasterYSize - top);
    const int bytes = GDALGetDataTypeSizeBytes(eDataType);
    if (_values && _values->RasterIO(GF_Read, left, top, columns, rows, data, columns, rows, eDataType, bytes,
                                     static_cast<GSpacing>(bytes) * nBlockXSize, nullptr) != CE_None)
        return CE_Failure;
    if (_values && raster.form == RasterMask::Form::ALPHA) return CE_None;
    std::vector<unsigned char> mask(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)), more;
    if (!raster.mask->read(left, top, columns, rows, mask.data())) return CE_Failure;
    if (raster.alphaBelow)
    {
        if (!readAlpha(*raster.alphaBelow, left, top, columns, rows, more)) return CE_Failure;
        multiply(mask.data(), more);
    }
    for (int y = 0; y < rows; ++y)
    {
        const unsigned char* const line = mask.data() + static_cast<std::ptrdiff_t>(y) * columns;
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y) * nBlockXSize;
        if (!_values)
            std::copy_n(line, columns, static_cast<unsigned char*>(data) + at);
        else if (eDataType == GDT_Float32)
            for (int x = 0; x < columns; ++x)
            {
                if (line[x] == 0) static_cast<float*>(data)[at + x] = std::numeric_limits<float>::quiet_NaN();
            }
        else
            for (int x = 0; x < columns; ++x)
                if (line[x] == 0)
                    static_cast<double*>(data)[at + x] = std::numeric_limits<double>::quiet_NaN();
    }
    return CE_None;
}

} // namespace

RasterMask::RasterMask(GDALDataset& dataset, const std::vector<int>& bands, UndeclaredVoids undeclared,
                       int overview)
    : _first(dataset.GetRasterBand(bands.front())), _undeclared(std::move(undeclared))
{
    const auto levelOf = [&](GDALRasterBand* band)
    {
        return overview < 0 ? band : band->GetOverview(overview);
    };
    GDALRasterBand& first = *_first;
    if (hasOwnMask(first))
        for (const int band : bands)
        {
            GDALRasterBand* const mask = dataset.GetRasterBand(band)->GetMaskBand();
            GDALRasterBand* const coarse = levelOf(mask);
            _masks.push_back(coarse ? coarse : levelOf(dataset.GetRasterBand(band))->GetMaskBand());
            if (first.GetMaskFlags() & GMF_PER_DATASET) break;
        }
    const bool isNoData = std::all_of(bands.begin(), bands.end(),
                                      [&](int band) { return hasNoData(*dataset.GetRasterBand(band)); });
    // Overviews of a file of JPEG are means of what it has, and may be of JPEG themselves.
    const bool isRough = isNoData && first.GetRasterDataType() == GDT_Byte &&
                         (isOfJpeg(dataset) || (overview >= 0 && isOfJpeg(*levelOf(&first))));
    for (std::size_t i = 0; i < bands.size() && isNoData; ++i)
        _noData.push_back(noDataMaskOf(*levelOf(dataset.GetRasterBand(bands[i])), isRough));
    for (int i = 1; i <= dataset.GetRasterCount(); ++i)
    {
        GDALRasterBand* const band = dataset.GetRasterBand(i);
        const bool isShown = std::find(bands.begin(), bands.end(), i) != bands.end();
        if (!isShown && band->GetColorInterpretation() == GCI_AlphaBand) _alpha = levelOf(band);
    }
}

bool RasterMask::readMost(const std::vector<GDALRasterBand*>& bands, int left, int top, int columns, int rows,
                          std::vector<unsigned char>& out) const
{
    out.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
    std::vector<unsigned char> each(out.size());
    for (GDALRasterBand* const band : bands)
    {
        if (band->RasterIO(GF_Read, left, top, columns, rows, each.data(), columns, rows, GDT_Byte, 0, 0,
                           nullptr) != CE_None)
            return false;
        std::transform(each.begin(), each.end(), out.begin(), out.begin(),
                       [](unsigned char a, unsigned char b) { return std::max(a, b); });
    }
    return true;
}

bool RasterMask::read(int left, int top, int columns, int rows, unsigned char* out)
{
    std::fill_n(out, static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                static_cast<unsigned char>(255));
    std::vector<unsigned char> part;
    if (!_masks.empty())
    {
        if (!readMost(_masks, left, top, columns, rows, part)) return false;
        multiply(out, part);
    }
    if (!_noData.empty())
    {
        std::vector<GDALRasterBand*> bands;
        for (const auto& band : _noData)
            bands.push_back(band.get());
        if (!readMost(bands, left, top, columns, rows, part)) return false;
        multiply(out, part);
    }
    if (_alpha)
    {
        if (!readAlpha(*_alpha, left, top, columns, rows, part)) return false;
        multiply(out, part);
    }
    if (!_undeclared.isEmpty())
    {
        std::vector<double> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
        if (_first->RasterIO(GF_Read, left, top, columns, rows, values.data(), columns, rows, GDT_Float64, 0,
                             0, nullptr) != CE_None)
            return false;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (_undeclared.has(values[i], left + static_cast<int>(i) % columns,
                                top + static_cast<int>(i) / columns))
                out[i] = 0;
    }
    return true;
}

void RasterMask::addTo(DatasetChain& chain, std::unique_ptr<RasterMask> mask, Form form)
{
    chain.add(DatasetPtr(new MaskedRaster(chain.top(), std::move(mask), form)));
}

bool RasterMask::isInOverview(GDALDataset& dataset, int overview)
{
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    if (!hasOwnMask(band)) return true;
    GDALRasterBand* const level = band.GetOverview(overview);
    if (!level) return false;
    // GDAL may say that an overview has a mask, and give one that is missing nowhere.
    const auto fits = [&](GDALRasterBand* mask)
    {
        return mask && !dynamic_cast<GDALAllValidMaskBand*>(mask) && mask->GetXSize() == level->GetXSize() &&
               mask->GetYSize() == level->GetYSize();
    };
    return fits(band.GetMaskBand()->GetOverview(overview)) ||
           (level->GetMaskFlags() == band.GetMaskFlags() && fits(level->GetMaskBand()));
}

} // namespace osgGeoFX
