// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/FrameRaster.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/CoordinateText.h>
#include <osgGeoFX/geodata/detail/RasterColors.h>
#include <osgGeoFX/geodata/detail/RasterFile.h>
#include <osgGeoFX/geodata/detail/RasterMask.h>
#include <osgGeoFX/geodata/detail/ReadingErrors.h>
#include <osgGeoFX/geodata/detail/Remarks.h>
#include <osgGeoFX/geodata/detail/VirtualRaster.h>
#include <osgGeoFX/mapping/LayerWords.h>
#include <osgGeoFX/paging/ReadingFile.h>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_alg.h>
#include <gdal_utils.h>
#include <osg/Math>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <thread>
#include <utility>

namespace osgGeoFX
{

namespace
{

using Transform = std::array<double, 6>;

/// That are read for one picture; some minutes.
constexpr double mostRead = 1e10;

CPLStringList listOf(const std::vector<std::string>& arguments)
{
    CPLStringList list;
    for (const std::string& argument : arguments)
        list.AddString(argument.c_str());
    return list;
}

std::string exact(double value)
{
    return CPLSPrintf("%.17g", value);
}

std::string wktOf(const OGRSpatialReference& srs)
{
    char* text = nullptr;
    srs.exportToWkt(&text);
    std::string wkt = text ? text : "";
    CPLFree(text);
    return wkt;
}

/// No number anywhere; GDAL leaves alone what has no place in the source.
DatasetPtr emptyNumbers(const FrameCrs& crs, const osg::Vec2d& low, const osg::Vec2d& high, int width,
                        int height)
{
    GDALDriver* const memory = GetGDALDriverManager()->GetDriverByName("MEM");
    DatasetPtr empty(memory ? memory->Create("", width, height, 1, GDT_Float64, nullptr) : nullptr);
    OGRSpatialReference srs;
    if (!empty || srs.SetFromUserInput(crs.definition.c_str()) != OGRERR_NONE) return nullptr;
    Transform transform = {low.x(), (high.x() - low.x()) / width, 0.0, high.y(),
                           0.0,     (low.y() - high.y()) / height};
    empty->SetProjection(wktOf(srs).c_str());
    empty->SetGeoTransform(transform.data());
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    empty->GetRasterBand(1)->SetNoDataValue(none);
    empty->GetRasterBand(1)->Fill(none);
    return empty;
}

/// While it lives, GDAL looks on this thread for no file beside the one that it opens.
class WithoutSidecars
{
public:
    explicit WithoutSidecars(const std::string& file)
    {
        const char* const before = CPLGetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr);
        if (before) _before = before;
        CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", "NO");
        // An empty list would mean that GDAL looks itself.
        _siblings.AddString(CPLGetFilename(file.c_str()));
    }
    ~WithoutSidecars()
    {
        CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", _before ? _before->c_str() : nullptr);
    }
    WithoutSidecars(const WithoutSidecars&) = delete;
    WithoutSidecars& operator=(const WithoutSidecars&) = delete;

    const char* const* siblings() const { return _siblings.List(); }

private:
    std::optional<std::string> _before;
    CPLStringList _siblings;
};

} // namespace

LayerSource sourceOf(const std::string& file, const MappingFrame& frame)
{
    LayerSource source;
    source.file = file;
    source.globe = frame.globe;
    source.wkt = frame.wkt;
    source.origin = frame.origin;
    return source;
}

FrameCrs crsOf(const MappingFrame& frame, const std::string& file)
{
    FrameCrs crs;
    if (frame.globe)
    {
        crs.definition = CPLSPrintf("+proj=ortho +lat_0=%.17g +lon_0=%.17g +datum=WGS84 +units=m +no_defs",
                                    osg::RadiansToDegrees(frame.origin.latitude),
                                    osg::RadiansToDegrees(frame.origin.longitude));
        return crs;
    }
    OGRSpatialReference srs;
    GdalErrorScope errors;
    if (!setCoordinateSystem(srs, frame.wkt) || !srs.IsProjected())
        throw BuildError(file +
                         ": the terrain has no coordinate system into which it could be brought; build "
                         "the terrain with osggeofx_build.");
    srs.StripVertical();
    crs.definition = wktOf(srs);
    crs.origin = frame.origin.place();
    crs.metresPerUnit = srs.GetLinearUnits();
    return crs;
}

VectorTarget vectorTargetOf(const MappingFrame& frame, const std::string& file)
{
    VectorTarget target;
    if (frame.globe)
    {
        target.crs.importFromEPSG(4326);
        return target;
    }
    const FrameCrs crs = crsOf(frame, file);
    target.crs.SetFromUserInput(crs.definition.c_str());
    target.metresPerUnit = crs.metresPerUnit;
    return target;
}

FrameRaster::FrameRaster(std::string file, std::optional<DataLayer::Kind> wanted, bool placed,
                         Formats formats, int overview, const RasterBands& show)
    : bands(show), _file(std::move(file))
{
    static const char* const plainPictures[] = {"PNG", "JPEG", "GIF",         "GTiff",
                                                "BMP", "WEBP", "JP2OpenJPEG", nullptr};
    const ReadingFile reading(_file);
    GdalErrorScope errors;
    if (formats == PLAIN_PICTURES)
    {
        // Files beside a picture may be of any format, and so name any file and address: .aux.xml, .ovr and .msk.
        const WithoutSidecars without(_file);
        _chain.add(DatasetPtr(GDALDataset::Open(_file.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR,
                                                plainPictures, nullptr, without.siblings())));
    }
    else
    {
        CPLStringList options;
        if (overview >= 0) options.SetNameValue("OVERVIEW_LEVEL", std::to_string(overview).c_str());
        _chain = RasterFile::open(_file, options.List());
    }
    if (_chain.empty() && formats == PLAIN_PICTURES)
        fail("it is not there, or no PNG, JPEG, GIF, TIFF, BMP, WebP or JPEG 2000 (" + errors.message() +
             "); correct its name, or convert it to PNG");
    // A TIFF has metadata in itself.
    if (formats == PLAIN_PICTURES && top().GetMetadataItem("OVERVIEW_FILE", "OVERVIEWS"))
        fail("it names another file as its overviews; convert it to PNG");
    prepare(wanted, placed);
}

FrameRaster::FrameRaster(std::string file, DatasetChain chain, std::optional<DataLayer::Kind> wanted)
    : _file(std::move(file)), _chain(std::move(chain))
{
    prepare(wanted, true);
}

void FrameRaster::prepare(std::optional<DataLayer::Kind> wanted, bool placed)
{
    const GdalErrorScope errors;
    if (top().GetRasterCount() == 0) fail("it holds no raster band; check it with gdalinfo");
    checkSize();
    if (placed) checkPlace();
    if (placed) closeCircle();
    if (GDALDataTypeIsComplex(band().GetRasterDataType()))
        fail("its values are complex numbers; export a real band with gdal_translate -ot Float32");
    kind = wanted.value_or(RasterColors::areIn(top()) ? DataLayer::COLOR : DataLayer::VALUE);
    if (!wanted && kind == DataLayer::VALUE && top().GetRasterCount() >= 3)
        remarkOnce(_file + ": the first of its " + std::to_string(top().GetRasterCount()) +
                   " bands is shown, as values. --sequence shows them one after the other; of a picture, "
                   "gdal_edit.py -colorinterp_1 red -colorinterp_2 green and so on declare the colors.");
    if (kind == DataLayer::COLOR)
        makeColors();
    else
        makeValues();
}

void FrameRaster::checkPlace() const
{
    Transform transform{};
    const bool placed = top().GetGeoTransform(transform.data()) == CE_None;
    if (!placed && RasterFile::hasPlaces(top())) return;
    if (!placed && top().GetGCPCount() == 0)
        fail("it has no georeference; give it one with gdal_translate -a_ullr WEST NORTH EAST SOUTH");
    const OGRSpatialReference* srs = placed ? top().GetSpatialRef() : top().GetGCPSpatialRef();
    if (!srs || srs->IsEmpty() || srs->IsLocal())
        fail("it has no coordinate reference system; name it with gdal_translate -a_srs EPSG:N");
}

/// GDAL goes around the globe in rasters of up to 360 degrees alone; rounded ones, and those that repeat a column, have a little more.
void FrameRaster::closeCircle()
{
    Transform place{};
    const OGRSpatialReference* const srs = top().GetSpatialRef();
    if (!srs || !srs->IsGeographic() || top().GetGeoTransform(place.data()) != CE_None || place[1] <= 0.0 ||
        place[2] != 0.0 || place[4] != 0.0)
        return;
    const double circle = osg::PI * 2.0 / srs->GetAngularUnits();
    const double width = place[1] * top().GetRasterXSize();
    // Maps that show their borders twice have many columns more.
    if (width <= circle || width > circle + 2.5 * place[1]) return;
    const int columns = static_cast<int>(std::lround(circle / place[1]));
    const double east = place[0] + std::min(columns * place[1], circle);
    translate({"-srcwin", "0", "0", std::to_string(columns), std::to_string(top().GetRasterYSize()),
               "-a_ullr", exact(place[0]), exact(place[3]), exact(east),
               exact(place[3] + place[5] * top().GetRasterYSize())});
}

/// Formats without tiles are read from the first pixel on, whatever is wanted of them.
void FrameRaster::checkSize() const
{
    constexpr double mostPixels = 32768.0 * 32768.0;
    const std::string format = top().GetDriver() ? top().GetDriver()->GetDescription() : "";
    const bool hasTiles = format != "PNG" && format != "GIF" && format != "BIGGIF" && format != "BMP" &&
                          format != "WEBP" && format != "JPEG";
    const double columns = top().GetRasterXSize();
    const double rows = top().GetRasterYSize();
    const std::string fault = faultOfBlocks(top());
    if (!fault.empty()) fail(fault);
    if (hasTiles || columns * rows <= mostPixels || band().GetOverviewCount() > 0) return;
    fail("it says that it has " + std::to_string(top().GetRasterXSize()) + " × " +
         std::to_string(top().GetRasterYSize()) + " pixels, which a " + format +
         " cannot be read in parts of; convert it to a tiled GeoTIFF, or give it overviews with gdaladdo");
}

void FrameRaster::giveWords(DataLayer& layer) const
{
    if (kind == DataLayer::COLOR) return;
    GDALRasterBand& file = *_chain.file().GetRasterBand(std::max(bands.channels[0].band, 1));
    if (kind == DataLayer::VALUE && file.GetUnitType()) LayerWords::setUnit(layer, file.GetUnitType());
    if (kind != DataLayer::CLASS) return;
    std::map<double, std::string> names;
    const CPLStringList all(CSLDuplicate(file.GetCategoryNames()));
    for (int i = 0; i < all.size(); ++i)
        if (*all[i]) names[i] = all[i];
    LayerWords::setNames(layer, names);
}

std::vector<double> FrameRaster::overviews() const
{
    // A virtual raster opens its sources to tell of their overviews.
    const GdalErrorScope quiet;
    std::vector<double> factors;
    GDALRasterBand* const band = _chain.file().GetRasterBand(1);
    for (int i = 0; i < band->GetOverviewCount(); ++i)
    {
        GDALRasterBand* const overview = band->GetOverview(i);
        const bool isWhole = overview && RasterMask::isInOverview(_chain.file(), i);
        factors.push_back(isWhole ? static_cast<double>(band->GetXSize()) / std::max(1, overview->GetXSize())
                                  : 1.0);
    }
    return factors;
}

int FrameRaster::overviewFor(double pixels) const
{
    const std::vector<double> factors = overviews();
    int best = -1;
    double coarsest = 1.0;
    for (std::size_t i = 0; i < factors.size(); ++i)
    {
        constexpr double slack = 1.05; // sides are rounded to whole pixels
        if (factors[i] <= coarsest || factors[i] > slack * pixels) continue;
        coarsest = factors[i];
        best = static_cast<int>(i);
    }
    return best;
}

void FrameRaster::checkOverviews() const
{
    constexpr double mostPixels = 8192.0 * 8192.0;
    double coarsest = 1.0;
    for (const double factor : overviews())
        coarsest = std::max(coarsest, factor);
    if (size().x() * size().y() > mostPixels * coarsest * coarsest) failForOverviews();
}

void FrameRaster::failForOverviews() const
{
    fail("it has no overviews that are small enough, so that a picture of all of it would take all of "
         "its pixels; make them with gdaladdo -r average \"" +
         _file + "\" 4 16 64 256");
}

void FrameRaster::checkPixels(double pixels) const
{
    if (pixels > mostRead) failForOverviews();
}

void FrameRaster::fail(const std::string& what) const
{
    throw BuildError(_file + ": " + what + ".");
}

FrameRaster::Extent FrameRaster::extent(const FrameCrs& crs) const
{
    GdalErrorScope errors;
    const Transformer transformer = transformerTo(crs, errors);
    Transform transform{};
    std::array<double, 4> suggested{};
    int width = 0;
    int height = 0;
    if (GDALSuggestedWarpOutput2(GDALDataset::ToHandle(&top()), GDALGenImgProjTransform, transformer.get(),
                                 transform.data(), &width, &height, suggested.data(), 0) != CE_None)
        failToPlace(errors);
    // GDAL rounds to whole texels, which may cut off half of one; so its rectangle is for rasters only that are
    // in part beyond what can be told, such as the other side of the globe.
    Extent result{{suggested[0], suggested[1]}, {suggested[2], suggested[3]}, std::abs(transform[1])};
    constexpr int side = 65;
    osg::Vec2d low(std::numeric_limits<double>::max(), std::numeric_limits<double>::max());
    osg::Vec2d high = -low;
    for (int i = 0; i < side * side; ++i)
    {
        const int row = i / side;
        double x = top().GetRasterXSize() * (i % side) / (side - 1.0);
        double y = top().GetRasterYSize() * row / (side - 1.0);
        double z = 0.0;
        int success = FALSE;
        GDALGenImgProjTransform(transformer.get(), FALSE, 1, &x, &y, &z, &success);
        if (!success || !std::isfinite(x) || !std::isfinite(y)) return result;
        low.set(std::min(low.x(), x), std::min(low.y(), y));
        high.set(std::max(high.x(), x), std::max(high.y(), y));
    }
    result.low = low;
    result.high = high;
    return result;
}

osg::Vec2d FrameRaster::middle(const FrameCrs& crs) const
{
    GdalErrorScope errors;
    const Transformer transformer = transformerTo(crs, errors);
    double x = top().GetRasterXSize() / 2.0;
    double y = top().GetRasterYSize() / 2.0;
    double z = 0.0;
    int success = FALSE;
    GDALGenImgProjTransform(transformer.get(), FALSE, 1, &x, &y, &z, &success);
    if (!success || !std::isfinite(x) || !std::isfinite(y)) failToPlace(errors);
    return {x, y};
}

std::function<std::optional<osg::Vec2d>(const osg::Vec2d&)> FrameRaster::placer(const FrameCrs& crs) const
{
    GdalErrorScope errors;
    const std::shared_ptr<void> transformer = transformerTo(crs, errors);
    return [this, transformer](const osg::Vec2d& uv) -> std::optional<osg::Vec2d>
    {
        double x = top().GetRasterXSize() * uv.x();
        double y = top().GetRasterYSize() * (1.0 - uv.y());
        double z = 0.0;
        int success = FALSE;
        const GdalErrorScope scope;
        GDALGenImgProjTransform(transformer.get(), FALSE, 1, &x, &y, &z, &success);
        if (!success || !std::isfinite(x) || !std::isfinite(y)) return std::nullopt;
        return osg::Vec2d(x, y);
    };
}

DatasetPtr FrameRaster::warped(const FrameCrs& crs, const osg::Vec2d& low, const osg::Vec2d& high, int width,
                               int height) const
{
    // Neighbours of a palette's and of classes' numbers have nothing to do with each other.
    const std::string resampling = kind == DataLayer::CLASS || _palette ? "near" : "bilinear";
    // An error far below half a texel, of interpolated transformations.
    Arguments arguments{"-et", "0.01", "-r", resampling};
    if (kind == DataLayer::COLOR)
        arguments.insert(arguments.end(), {"-of", "MEM", "-t_srs", crs.definition, "-te", exact(low.x()),
                                           exact(low.y()), exact(high.x()), exact(high.y()), "-ts",
                                           std::to_string(width), std::to_string(height), "-dstalpha"});
    else
        arguments.insert(arguments.end(), {"-dstnodata", "nan", "-wo", "INIT_DEST=NO_DATA"});
    if (size().x() * size().y() > mostRead)
    {
        const Below pixels = below(crs, low, high, width, height);
        checkPixels(pixels.pixels * pixels.share * width * height);
    }
    const ReadingFile reading(_file);
    constexpr int tries = 3;
    for (int i = 1;; ++i)
    {
        const ReadingErrors errors;
        GDALWarpAppOptions* options = GDALWarpAppOptionsNew(listOf(arguments).List(), nullptr);
        GDALDatasetH source = GDALDataset::ToHandle(&top());
        DatasetPtr result = kind == DataLayer::COLOR ? nullptr : emptyNumbers(crs, low, high, width, height);
        GDALDatasetH done = GDALWarp("", GDALDataset::ToHandle(result.get()), 1, &source, options, nullptr);
        GDALWarpAppOptionsFree(options);
        if (!result) result.reset(GDALDataset::FromHandle(done));
        if (done && errors.message.empty()) return result;
        if (i == tries || !mayPass(errors.message)) failToRead(errors.message);
        std::this_thread::sleep_for(i * std::chrono::milliseconds(500));
    }
}

FrameRaster::Below FrameRaster::below(const FrameCrs& crs, const osg::Vec2d& low, const osg::Vec2d& high,
                                      int width, int height) const
{
    GdalErrorScope errors;
    const Transformer transformer = transformerTo(crs, errors);
    const osg::Vec2d texel((high.x() - low.x()) / width, (high.y() - low.y()) / height);
    const auto pixelAt = [&](osg::Vec2d place) -> std::optional<osg::Vec2d>
    {
        double z = 0.0;
        int success = FALSE;
        GDALGenImgProjTransform(transformer.get(), TRUE, 1, &place.x(), &place.y(), &z, &success);
        if (!success || !std::isfinite(place.x()) || !std::isfinite(place.y())) return std::nullopt;
        return place;
    };
    constexpr int side = 8;
    std::vector<double> densities; // of pixels below a texel
    for (int i = 0; i < side * side; ++i)
    {
        const osg::Vec2d place(low.x() + (i % side + 0.5) / side * (high.x() - low.x()),
                               low.y() + (i / side + 0.5) / side * (high.y() - low.y()));
        const auto at = pixelAt(place), right = pixelAt(place + osg::Vec2d(texel.x(), 0.0)),
                   above = pixelAt(place + osg::Vec2d(0.0, texel.y()));
        if (!at || !right || !above) continue;
        if (at->x() < 0.0 || at->y() < 0.0 || at->x() > size().x() || at->y() > size().y()) continue;
        const osg::Vec2d u = *right - *at, v = *above - *at;
        densities.push_back(std::abs(u.x() * v.y() - u.y() * v.x()));
    }
    if (densities.empty()) return {};
    // At the antimeridian, two neighbors may be the raster's two ends.
    const auto middle = densities.begin() + static_cast<std::ptrdiff_t>(densities.size() / 2);
    std::nth_element(densities.begin(), middle, densities.end());
    return {*middle, static_cast<double>(densities.size()) / (side * side)};
}

void FrameRaster::readValues(GDALDataset& warped, int row, std::vector<double>& values) const
{
    const int width = warped.GetRasterXSize();
    values.resize(static_cast<std::size_t>(width));
    if (warped.GetRasterBand(1)->RasterIO(GF_Read, 0, row, width, 1, values.data(), width, 1, GDT_Float64, 0,
                                          0, nullptr) != CE_None)
        fail("its pixels cannot be read; copy or export it again");
    constexpr double most = static_cast<double>(std::numeric_limits<float>::max());
    for (double& value : values)
    {
        value = value * scale + offset;
        if (!(std::abs(value) <= most)) value = std::numeric_limits<double>::quiet_NaN();
    }
}

void FrameRaster::readColors(GDALDataset& warped, unsigned char* colors) const
{
    const int width = warped.GetRasterXSize();
    const int height = warped.GetRasterYSize();
    // From below, as OSG has its rows.
    const GSpacing row = 4 * static_cast<GSpacing>(width);
    if (warped.RasterIO(GF_Read, 0, 0, width, height, colors + row * (height - 1), width, height, GDT_Byte, 4,
                        nullptr, 4, -row, 1, nullptr) != CE_None)
        fail("its pixels cannot be read; copy or export it again");
}

osg::ref_ptr<osg::Image> FrameRaster::image(const FrameCrs& crs, const osg::Vec2d& from, const osg::Vec2d& to,
                                            int width, int height, double* low, double* high) const
{
    const DatasetPtr pixels = warped(crs, from, to, width, height);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setFileName(_file);
    if (kind == DataLayer::COLOR)
    {
        image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        readColors(*pixels, image->data());
        return image;
    }
    image->allocateImage(width, height, 1, GL_RED, GL_FLOAT);
    image->setInternalTextureFormat(GL_R32F);
    std::vector<double> line;
    for (int row = 0; row < height; ++row)
    {
        readValues(*pixels, row, line);
        auto* out = reinterpret_cast<float*>(image->data(0, static_cast<unsigned int>(height - 1 - row)));
        for (const double value : line)
        {
            *out++ = static_cast<float>(value);
            if (!low || std::isnan(value)) continue;
            const bool first = *low > *high;
            *low = first ? value : std::min(*low, value);
            *high = first ? value : std::max(*high, value);
        }
    }
    return image;
}

void FrameRaster::moveToMiddle(MappingFrame& frame) const
{
    FrameCrs crs;
    if (frame.globe)
        crs.definition = "EPSG:4326";
    else
        crs = crsOf(frame, _file);
    const osg::Vec2d place = middle(crs);
    frame.origin =
        frame.globe ? LocalOrigin::onGlobe(osg::DegreesToRadians(place.x()), osg::DegreesToRadians(place.y()))
                    : LocalOrigin::onPlane(place * crs.metresPerUnit);
}

osg::ref_ptr<osg::Image> FrameRaster::picture(int maxSide) const
{
    const osg::Vec2d all = size();
    const double share = std::min(1.0, maxSide / std::max(all.x(), all.y()));
    const int width = std::max(1, static_cast<int>(std::lround(all.x() * share)));
    const int height = std::max(1, static_cast<int>(std::lround(all.y() * share)));
    const int overview = overviewFor(1.0 / share);
    const double factor = overview < 0 ? 1.0 : overviews()[static_cast<std::size_t>(overview)];
    checkPixels(all.x() * all.y() / (factor * factor));
    const ReadingFile reading(_file);
    GDALRasterIOExtraArg how;
    INIT_RASTERIO_EXTRA_ARG(how);
    if (kind != DataLayer::CLASS && !_palette) how.eResampleAlg = GRIORA_Average;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    if (kind == DataLayer::COLOR)
    {
        image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        const GSpacing row = 4 * static_cast<GSpacing>(width);
        GdalErrorScope errors;
        if (top().RasterIO(GF_Read, 0, 0, static_cast<int>(all.x()), static_cast<int>(all.y()),
                           image->data() + row * (height - 1), width, height, GDT_Byte, 4, nullptr, 4, -row,
                           1, &how) != CE_None)
            failToRead(errors);
    }
    else
    {
        image->allocateImage(width, height, 1, GL_RED, GL_FLOAT);
        image->setInternalTextureFormat(GL_R32F);
        readNumbers(*image, how);
    }
    image->setFileName(_file);
    return image;
}

void FrameRaster::readNumbers(osg::Image& image, GDALRasterIOExtraArg& how) const
{
    const int columns = top().GetRasterXSize();
    const int rows = top().GetRasterYSize();
    const int width = image.s();
    const int height = image.t();
    const std::size_t last = static_cast<std::size_t>(width) * static_cast<std::size_t>(height - 1);
    auto* numbers = reinterpret_cast<float*>(image.data());
    const GSpacing row = static_cast<GSpacing>(sizeof(float)) * width;
    GdalErrorScope errors;
    if (band().RasterIO(GF_Read, 0, 0, columns, rows, numbers + last, width, height, GDT_Float32,
                        sizeof(float), -row, &how) != CE_None)
        failToRead(errors);
    int hasNoData = FALSE;
    const auto noData = static_cast<float>(band().GetNoDataValue(&hasNoData));
    for (std::size_t i = 0; i < last + static_cast<std::size_t>(width); ++i)
    {
        const bool isNone = hasNoData && numbers[i] == noData;
        const double number =
            isNone ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(numbers[i]);
        numbers[i] = static_cast<float>(number * scale + offset);
        if (!std::isfinite(numbers[i])) numbers[i] = std::numeric_limits<float>::quiet_NaN();
    }
}

void FrameRaster::failToRead(const GdalErrorScope& errors) const
{
    failToRead(errors.message());
}

void FrameRaster::failToRead(const std::string& message) const
{
    fail("its pixels cannot be read" +
         causeAndRemedy(message, "the file may be cut short: copy or export it again"));
}

void FrameRaster::TransformerDestroyer::operator()(void* transformer) const
{
    GDALDestroyGenImgProjTransformer(transformer);
}

FrameRaster::Transformer FrameRaster::transformerTo(const FrameCrs& crs, const GdalErrorScope& errors) const
{
    CPLStringList options;
    options.SetNameValue("DST_SRS", crs.definition.c_str());
    Transformer result(
        GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&top()), nullptr, options.List()));
    if (!result) failToPlace(errors);
    return result;
}

void FrameRaster::failToPlace(const GdalErrorScope& errors) const
{
    fail("it cannot be brought to the place of the effect (" + errors.message() +
         "); give the effect an origin near it, or warp it with gdalwarp first");
}

void FrameRaster::failToUse(const GdalErrorScope& errors) const
{
    fail("its bands cannot be used (" + errors.message() + "); convert it to GeoTIFF with gdal_translate");
}

void FrameRaster::translate(const Arguments& arguments)
{
    addVirtualRaster(_chain, arguments, _file);
}

/// Red, green, blue and alpha, bytes.
void FrameRaster::makeColors()
{
    _palette = band().GetColorTable() != nullptr && bands.channels[0].band == 0;
    RasterColors::add(_chain, bands, _file);
}

void FrameRaster::makeValues()
{
    const int number = std::max(bands.channels[0].band, 1);
    if (number > top().GetRasterCount())
        fail("it has " + std::to_string(top().GetRasterCount()) + " bands, and no band " +
             std::to_string(number) + "; name one of these");
    auto mask = std::make_unique<RasterMask>(top(), std::vector<int>{number});
    const bool isMasked = !mask->isEmpty() && !mask->isNoDataValue();
    if (number > 1 || (!isMasked && top().GetRasterCount() > 1)) translate({"-b", std::to_string(number)});
    scale = band().GetScale();
    offset = band().GetOffset();
    if (isMasked) RasterMask::addTo(_chain, std::move(mask), RasterMask::Form::NOT_A_NUMBER);
}

} // namespace osgGeoFX
