// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/RasterColors.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/RasterMask.h>
#include <osgGeoFX/geodata/detail/ReadingErrors.h>
#include <osgGeoFX/geodata/detail/Remarks.h>
#include <osgGeoFX/geodata/detail/VirtualRaster.h>

#include <cpl_conv.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

using Range = std::pair<double, double>;
using Numbers = std::array<int, 3>; ///< of bands

std::vector<std::string> wordsOf(const std::string& text)
{
    std::vector<std::string> words(1);
    for (const char c : text)
    {
        if (std::isalnum(static_cast<unsigned char>(c)))
            words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        else if (!words.back().empty())
            words.emplace_back();
    }
    if (words.back().empty()) words.pop_back();
    return words;
}

/// How well a band's name fits a color: 2 if it is the color's name, 1 if it begins with it, else 0.
int fitOf(const std::string& name, std::size_t channel)
{
    // The second are Sentinel-2's.
    constexpr std::array<std::array<const char*, 2>, 3> names{
        {{"red", "b04"}, {"green", "b03"}, {"blue", "b02"}}};
    const std::vector<std::string> words = wordsOf(name);
    const bool begins = !words.empty() && std::any_of(names[channel].begin(), names[channel].end(),
                                                      [&](const char* each) { return words[0] == each; });
    if (!begins || (words.size() > 1 && words[1] == "edge")) return 0;
    return words.size() == 1 ? 2 : 1;
}

/// The bands that are declared to be red, green and blue, by color interpretation or by name; nothing where one is not.
std::optional<Numbers> declared(GDALDataset& raster)
{
    Numbers byColor{}, byName{};
    std::array<int, 3> best{};
    for (int number = raster.GetRasterCount(); number > 0; --number)
    {
        GDALRasterBand& band = *raster.GetRasterBand(number);
        for (std::size_t channel = 0; channel < 3; ++channel)
        {
            if (band.GetColorInterpretation() == GCI_RedBand + static_cast<int>(channel))
                byColor[channel] = number;
            const int fit = fitOf(band.GetDescription(), channel);
            if (fit < std::max(best[channel], 1)) continue;
            best[channel] = fit;
            byName[channel] = number;
        }
    }
    const auto isWhole = [](const Numbers& numbers)
    {
        return std::all_of(numbers.begin(), numbers.end(), [](int number) { return number > 0; });
    };
    if (isWhole(byColor)) return byColor;
    if (isWhole(byName)) return byName;
    return std::nullopt;
}

[[noreturn]] void fail(const std::string& file, const std::string& what)
{
    throw BuildError(file + ": " + what + ".");
}

Numbers numbersOf(GDALDataset& raster, const RasterBands& wanted, const std::string& file)
{
    Numbers numbers{};
    bool isOpen = false;
    for (std::size_t i = 0; i < 3; ++i)
    {
        numbers[i] = wanted.channels[i].band;
        isOpen = isOpen || numbers[i] == 0;
        if (numbers[i] > raster.GetRasterCount())
            fail(file, "it has " + std::to_string(raster.GetRasterCount()) + " bands, and no band " +
                           std::to_string(numbers[i]) + "; name one of these");
    }
    if (!isOpen) return numbers;
    std::vector<int> colors;
    for (int i = 1; i <= raster.GetRasterCount(); ++i)
        if (raster.GetRasterBand(i)->GetColorInterpretation() != GCI_AlphaBand) colors.push_back(i);
    if (colors.empty()) fail(file, "it has a band of alpha and none of colors; export it with its colors");
    Numbers found{colors[0], colors[0], colors[0]};
    const bool hasThree = colors.size() >= 3;
    if (const std::optional<Numbers> known = declared(raster))
        found = *known;
    else if (hasThree)
    {
        found = {colors[0], colors[1], colors[2]};
        if (colors.size() > 3)
            remarkOnce(file + ": none of its " + std::to_string(colors.size()) +
                       " bands is declared to be red, green or blue, so the first three are taken in this "
                       "order; declare them with gdal_edit.py -colorinterp_1 blue -colorinterp_2 green and "
                       "so on.");
    }
    for (std::size_t i = 0; i < 3; ++i)
        if (numbers[i] == 0) numbers[i] = found[i];
    return numbers;
}

/// The largest number that a band may have; nothing for floating-point numbers.
std::optional<double> mostOf(GDALRasterBand& band)
{
    const GDALDataType type = band.GetRasterDataType();
    if (!GDALDataTypeIsInteger(type)) return std::nullopt;
    int bits = GDALGetDataTypeSizeBits(type) - (GDALDataTypeIsSigned(type) ? 1 : 0);
    if (const char* const known = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE"))
        bits = std::clamp(std::atoi(known), 1, bits);
    return std::ldexp(1.0, bits) - 1.0;
}

/// The coarsest overview that has the samples' bands and their mask, and a side of at least 512 pixels; -1 for the raster itself.
int overviewFor(GDALDataset& raster)
{
    constexpr int leastSide = 512;
    GDALRasterBand& first = *raster.GetRasterBand(1);
    int best = -1, side = std::max(first.GetXSize(), first.GetYSize());
    for (int i = 0; i < first.GetOverviewCount(); ++i)
    {
        GDALRasterBand* const level = first.GetOverview(i);
        if (!level || !RasterMask::isInOverview(raster, i)) continue;
        const int own = std::max(level->GetXSize(), level->GetYSize());
        if (own < leastSide || own >= side) continue;
        const bool isAll = [&]
        {
            for (int band = 1; band <= raster.GetRasterCount(); ++band)
            {
                GDALRasterBand* const each = raster.GetRasterBand(band)->GetOverview(i);
                if (!each || each->GetXSize() != level->GetXSize() || each->GetYSize() != level->GetYSize())
                    return false;
            }
            return true;
        }();
        if (!isAll) continue;
        best = i;
        side = own;
    }
    return best;
}

/// Numbers of the bands from windows all over the raster, without those of missing pixels. Pixels that are 0 in all bands are left out, too:
/// many satellite pictures are so where they have nothing, and do not declare it.
std::vector<double> samplesOf(GDALDataset& raster, const std::vector<int>& numbers, const std::string& file)
{
    constexpr int parts = 8, mostPixels = 64; // windows along a side, and along theirs
    const int overview = overviewFor(raster);
    RasterMask mask(raster, numbers, {}, overview);
    std::vector<GDALRasterBand*> bands;
    for (const int number : numbers)
    {
        GDALRasterBand* const band = raster.GetRasterBand(number);
        bands.push_back(overview < 0 ? band : band->GetOverview(overview));
    }
    const auto windowOf = [&](int index, int size)
    {
        const int from = static_cast<int>(static_cast<long long>(size) * index / parts);
        const int to = static_cast<int>(static_cast<long long>(size) * (index + 1) / parts);
        const int count = std::min(mostPixels, to - from);
        return std::make_pair(from + (to - from - count) / 2, count);
    };
    std::vector<double> samples, values;
    std::vector<unsigned char> isThere;
    const GdalErrorScope errors;
    for (int i = 0; i < parts * parts; ++i)
    {
        const auto [left, columns] = windowOf(i % parts, bands[0]->GetXSize());
        const auto [top, rows] = windowOf(i / parts, bands[0]->GetYSize());
        const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
        if (count == 0) continue;
        isThere.resize(count);
        values.resize(count * bands.size());
        bool isRead = mask.read(left, top, columns, rows, isThere.data());
        for (std::size_t band = 0; band < bands.size(); ++band)
            isRead = isRead &&
                     bands[band]->RasterIO(GF_Read, left, top, columns, rows, values.data() + band * count,
                                           columns, rows, GDT_Float64, 0, 0, nullptr) == CE_None;
        if (!isRead)
            fail(file,
                 "its pixels cannot be read" +
                     causeAndRemedy(errors.message(), "the file may be cut short: copy or export it again"));
        for (std::size_t pixel = 0; pixel < count; ++pixel)
        {
            bool isZero = true;
            for (std::size_t band = 0; band < bands.size(); ++band)
                isZero = isZero && values[band * count + pixel] == 0.0;
            for (std::size_t band = 0; band < bands.size() && isThere[pixel] > 0 && !isZero; ++band)
                if (std::isfinite(values[band * count + pixel]))
                    samples.push_back(values[band * count + pixel]);
        }
    }
    return samples;
}

/// What of the bands' numbers is black, and what is white.
Range rangeOf(GDALDataset& raster, const std::vector<int>& numbers, const std::string& file)
{
    GDALRasterBand& band = *raster.GetRasterBand(numbers[0]);
    const std::optional<double> most = mostOf(band);
    // PNG's numbers of 16 bits have their whole range.
    const bool isPng = raster.GetDriver() && EQUAL(raster.GetDriver()->GetDescription(), "PNG");
    if (band.GetRasterDataType() == GDT_Byte || isPng) return {0.0, *most};
    std::vector<double> samples = samplesOf(raster, numbers, file);
    if (samples.empty()) return {0.0, most.value_or(1.0)};
    const auto atShare = [&](double share)
    {
        const auto place = samples.begin() + std::lround(share * static_cast<double>(samples.size() - 1));
        std::nth_element(samples.begin(), place, samples.end());
        return *place;
    };
    double black = atShare(0.02), white = atShare(0.98);
    if (most && white >= *most / 2.0) return {0.0, *most};
    remarkOnce(file +
               CPLSPrintf(": its numbers from %g to %g (2 to 98 %% of them) are shown from black to white. "
                          "Set others with --stretch LOW,HIGH, or make bytes with gdal_translate -ot Byte "
                          "-scale LOW HIGH.",
                          black, white));
    // All are the same: a middle grey.
    if (!(white > black))
    {
        black -= 1.0;
        white += 1.0;
    }
    return {black, white};
}

/// What has one band, or one with alpha, and is no picture by its type.
void checkType(GDALRasterBand& band, const std::string& file)
{
    const GDALDataType type = band.GetRasterDataType();
    if (GDALDataTypeIsComplex(type))
        fail(file, "its values are complex numbers; export a real band with gdal_translate -ot Float32");
    if (type != GDT_Byte && type != GDT_UInt16)
        fail(file,
             "its pixels are not colors (" + std::string(GDALGetDataTypeName(type)) +
                 "); make bytes of them with gdal_translate -ot Byte -scale, or color them with gdaldem "
                 "color-relief");
}

} // namespace

bool RasterColors::areIn(GDALDataset& raster)
{
    GDALRasterBand& first = *raster.GetRasterBand(1);
    if (first.GetColorTable()) return true;
    const GDALDataType type = first.GetRasterDataType();
    return raster.GetRasterCount() >= 3 && (type == GDT_Byte || type == GDT_UInt16 || declared(raster));
}

void RasterColors::add(DatasetChain& chain, RasterBands& bands, const std::string& file)
{
    const GdalErrorScope errors;
    const auto failToUse = [&]
    {
        fail(file, "its bands cannot be used (" + errors.message() +
                       "); convert it to GeoTIFF with gdal_translate");
    };
    GDALDataset& raster = chain.top();
    const auto isOpen = [](const RasterBands::Channel& channel)
    {
        return channel.band == 0;
    };
    const bool palette = raster.GetRasterBand(1)->GetColorTable() != nullptr &&
                         std::all_of(bands.channels.begin(), bands.channels.end(), isOpen);
    Numbers numbers{1, 1, 1};
    if (!palette) numbers = numbersOf(raster, bands, file);
    std::vector<int> different(numbers.begin(), numbers.end());
    std::sort(different.begin(), different.end());
    different.erase(std::unique(different.begin(), different.end()), different.end());
    const bool hasOpenRange = std::any_of(bands.channels.begin(), bands.channels.end(),
                                          [](const auto& channel) { return !channel.range; });
    auto mask = std::make_unique<RasterMask>(raster, different);
    const bool isMasked = !mask->isEmpty();
    std::vector<std::string> arguments{"-a_nodata", "none", "-mask", "none"};
    if (palette)
        arguments.insert(arguments.end(), {"-expand", "rgba"});
    else
    {
        if (different.size() == 1 && hasOpenRange) checkType(*raster.GetRasterBand(numbers[0]), file);
        std::optional<Range> found;
        for (std::size_t i = 0; i < 3; ++i)
        {
            RasterBands::Channel& channel = bands.channels[i];
            channel.band = numbers[i];
            arguments.insert(arguments.end(), {"-b", std::to_string(numbers[i])});
            if (!channel.range)
            {
                if (!found) found = rangeOf(raster, different, file);
                channel.range = found;
            }
            const bool isPlain = raster.GetRasterBand(numbers[i])->GetRasterDataType() == GDT_Byte &&
                                 *channel.range == Range(0.0, 255.0);
            if (isPlain) continue;
            arguments.push_back("-scale_" + std::to_string(i + 1));
            for (const double number : {channel.range->first, channel.range->second, 0.0, 255.0})
                arguments.emplace_back(CPLSPrintf("%.17g", number));
        }
        arguments.insert(arguments.end(), {"-ot", "Byte", "-colorinterp", "red,green,blue"});
    }
    if (!addVirtualRaster(chain, arguments)) failToUse();
    if (isMasked)
        RasterMask::addTo(chain, std::move(mask), RasterMask::Form::ALPHA);
    else if (!palette)
    {
        // A mask that is missing nowhere becomes the alpha, so that overviews stay.
        if (!addVirtualRaster(chain, {"-b", "1", "-b", "2", "-b", "3", "-b", "mask,1"})) failToUse();
        chain.top().GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
    }
}

} // namespace osgGeoFX
