// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/RasterSource.h>

#include <osgGeoFX/geodata/detail/LatticeTransformer.h>
#include <osgGeoFX/geodata/detail/Lengths.h>
#include <osgGeoFX/geodata/detail/RasterColors.h>
#include <osgGeoFX/geodata/detail/RasterFile.h>
#include <osgGeoFX/geodata/detail/RasterMask.h>
#include <osgGeoFX/geodata/detail/ReadingErrors.h>
#include <osgGeoFX/geodata/detail/Remarks.h>
#include <osgGeoFX/geodata/detail/TileAddress.h>
#include <osgGeoFX/geodata/detail/VirtualRaster.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/paging/ReadingFile.h>

#include <cpl_string.h>
#include <gdal_alg.h>
#include <gdal_utils.h>
#include <gdalwarper.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

namespace
{

// Largest error of interpolated transformations, in pixels. On a slope of 1:1 in a 30 m grid: 3 mm.
constexpr double TRANSFORM_TOLERANCE = 1e-4;
constexpr double WARP_MEMORY_BYTES =
    48.0 * 1024 * 1024; // a constant: chunks decide the last bits of a sample

/// The number of the last band if it is alpha, else 0.
int alphaOf(GDALDataset& dataset)
{
    const int last = dataset.GetRasterCount();
    return dataset.GetRasterBand(last)->GetColorInterpretation() == GCI_AlphaBand ? last : 0;
}

} // namespace

GridCrs GridCrs::geocentric()
{
    GridCrs crs;
    crs.srs.importFromEPSG(4326);
    crs.srs = gisOrder(crs.srs);
    return crs;
}

GridCrs GridCrs::projected(int epsg)
{
    initialiseGdal();
    GdalErrorScope errors;
    GridCrs crs;
    crs.geographic = false;
    const std::string name = "EPSG:" + std::to_string(epsg);
    if (crs.srs.importFromEPSG(epsg) != OGRERR_NONE)
        throw BuildError(name + " is not a CRS that PROJ knows; look up its number with projinfo.");
    if (!crs.srs.IsProjected())
        throw BuildError(
            name + " (" + crs.srs.GetName() +
            ") is not a projected CRS; name one, such as a UTM zone, or build with --geocentric.");
    crs.srs = gisOrder(crs.srs);
    crs.srs.StripVertical();
    crs.metresPerUnit = crs.srs.GetLinearUnits();
    return crs;
}

struct RasterSource::WarpRequest
{
    GDALDataType type = GDT_Float32;
    void* planes = nullptr;
    int bands = 1;
    GDALResampleAlg resampling = GRA_Bilinear;
    bool plainKernel = false; ///< never widen the kernel: the value at the point, not a mean around it
    bool alpha = false;
};

RasterSource::RasterSource(const std::string& file, RasterKind kind, const RasterBands& bands,
                           const UndeclaredVoids& undeclared)
    : _file(file), _bands(bands)
{
    initialiseGdal();
    _chain = RasterFile::open(file);
    const std::string fault = faultOfBlocks(_chain.top());
    if (!fault.empty()) fail(fault);
    openAs(kind, undeclared);
}

RasterSource::~RasterSource() = default;

void RasterSource::fail(const std::string& what) const
{
    throw BuildError(_file + ": " + what + ".");
}

void RasterSource::failToUse(const GdalErrorScope& errors) const
{
    fail("its bands cannot be used (" + errors.message() + "); convert it to GeoTIFF with gdal_translate");
}

void RasterSource::translate(const std::vector<std::string>& arguments)
{
    addVirtualRaster(_chain, arguments, _file);
}

void RasterSource::openAs(RasterKind kind, const UndeclaredVoids& undeclared)
{
    const GdalErrorScope quiet;
    const bool placed = _chain.top().GetGeoTransform(_geoTransform.data()) == CE_None;
    const bool hasPlaces = !placed && RasterFile::hasPlaces(_chain.top());
    if (!placed && !hasPlaces && _chain.top().GetGCPCount() == 0)
        fail("it has no georeference; give it one with gdal_translate -a_ullr WEST NORTH EAST SOUTH");
    OGRSpatialReference ofPlaces;
    if (hasPlaces) ofPlaces.SetFromUserInput(_chain.top().GetMetadataItem("SRS", "GEOLOCATION"));
    const OGRSpatialReference* srs = placed      ? _chain.top().GetSpatialRef()
                                     : hasPlaces ? &ofPlaces
                                                 : _chain.top().GetGCPSpatialRef();
    if (!srs || srs->IsEmpty() || srs->IsLocal())
        fail("it has no coordinate reference system; name it with gdal_translate -a_srs EPSG:N");
    _srs = gisOrder(*srs);

    GDALRasterBand* band = _chain.top().GetRasterBand(1);
    const GDALDataType type = band->GetRasterDataType();
    if (GDALDataTypeIsComplex(type))
        fail("its values are complex numbers; export a real band with gdal_translate -ot Float32");

    if (kind == RasterKind::Elevation && type == GDT_Byte && _chain.top().GetRasterCount() >= 3 &&
        band->GetColorInterpretation() == GCI_RedBand)
        fail("it is a picture in red, green and blue, not heights; give a raster of heights, or show the "
             "picture with --imagery");
    if (kind != RasterKind::Imagery)
    {
        const int bands = _chain.top().GetRasterCount() - (alphaOf(_chain.top()) > 0 ? 1 : 0);
        if (bands > 1)
            remarkOnce(_file + ": of its " + std::to_string(bands) +
                       " bands the first is taken; cut another one out with gdal_translate -b.");
        auto mask = std::make_unique<RasterMask>(_chain.top(), std::vector<int>{1}, undeclared);
        if (!mask->isEmpty() && !mask->isNoDataValue())
            RasterMask::addTo(_chain, std::move(mask),
                              kind == RasterKind::LandCover ? RasterMask::Form::ALPHA
                                                            : RasterMask::Form::NOT_A_NUMBER);
    }
    if (kind == RasterKind::Elevation)
    {
        if (band->GetScale() != 1.0 || band->GetOffset() != 0.0)
            translate({"-b", "1", "-ot", "Float32", "-unscale"});
        _metresPerHeight = Lengths::metresPerHeight(*band, _srs, _file);
        if (_metresPerHeight != 1.0)
            translate({"-b", "1", "-ot", "Float32", "-scale", "0", "1", "0",
                       CPLSPrintf("%.17g", _metresPerHeight)});
    }
    else if (kind == RasterKind::Imagery)
        RasterColors::add(_chain, _bands, _file);
    else if (kind == RasterKind::TreeCover)
    {
        if (band->GetColorTable())
            fail("its values are colors of a palette, not percent; give a raster of percent");
        if (band->GetScale() != 1.0 || band->GetOffset() != 0.0)
            translate({"-b", "1", "-ot", "Float32", "-unscale"});
    }
    else if (type != GDT_Byte)
        fail("land-cover classes must be one byte for each pixel (it has " +
             std::string(GDALGetDataTypeName(type)) + "); convert it with gdal_translate -ot Byte");
    if (!placed) warpByPlaces(kind);
    _srs.StripVertical();
}

void RasterSource::warpByPlaces(RasterKind kind)
{
    CPLStringList list;
    std::vector<const char*> arguments{"-of", "VRT", "-r",
                                       kind == RasterKind::LandCover ? "near" : "bilinear"};
    // What lies outside the turned raster is no ground.
    int hasNoData = FALSE;
    _chain.top().GetRasterBand(1)->GetNoDataValue(&hasNoData);
    if (alphaOf(_chain.top()) > 0)
        arguments.push_back("-dstalpha");
    else if (!hasNoData && kind != RasterKind::LandCover)
        arguments.insert(arguments.end(), {"-ot", "Float32", "-dstnodata", "-32768"});
    else if (!hasNoData)
        arguments.insert(arguments.end(), {"-dstnodata", "0"});
    for (const char* argument : arguments)
        list.AddString(argument);
    GdalErrorScope errors;
    GDALDatasetH source = GDALDataset::ToHandle(&_chain.top());
    GDALWarpAppOptions* options = GDALWarpAppOptionsNew(list.List(), nullptr);
    GDALDatasetH result = GDALWarp("", nullptr, 1, &source, options, nullptr);
    GDALWarpAppOptionsFree(options);
    if (!result)
        fail("its control points or places cannot be used (" + errors.message() +
             "); warp it with gdalwarp first");
    _chain.add(DatasetPtr(GDALDataset::FromHandle(result)));
    _chain.top().GetGeoTransform(_geoTransform.data());
}

void RasterSource::colorize(const std::array<std::array<unsigned char, 4>, 256>& colors)
{
    auto mask = std::make_unique<RasterMask>(_chain.top(), std::vector<int>{1});
    translate({"-b", "1", "-a_nodata", "none", "-mask", "none"});
    // GDAL looks a color table up by its index, and a <LUT> by searching.
    GDALColorTable table;
    for (int i = 0; i < 256; ++i)
    {
        const auto& color = colors[static_cast<std::size_t>(i)];
        const GDALColorEntry entry{color[0], color[1], color[2], color[3]};
        table.SetColorEntry(i, &entry);
    }
    const GdalErrorScope errors;
    _chain.top().GetRasterBand(1)->SetColorTable(&table);
    translate({"-expand", "rgba"});
    if (!mask->isEmpty()) RasterMask::addTo(_chain, std::move(mask), RasterMask::Form::ALPHA);
    _colorized = true;
}

void RasterSource::takePoles(const GridCrs& crs, Footprint& result) const
{
    auto& dataset = _chain.top();
    const TransformationPtr toSource = createTransformation(crs.srs, _srs, _file);
    std::array<double, 6> inverse{};
    if (!GDALInvGeoTransform(const_cast<double*>(_geoTransform.data()), inverse.data()))
        fail("its geotransform is singular; repair it with gdal_translate -a_ullr");
    for (const double pole : {-90.0, 90.0})
    {
        double x = result.west, y = pole, px = 0.0, py = 0.0;
        int success = 0;
        toSource->Transform(1, &x, &y, nullptr, &success);
        if (!success || !_srs.IsProjected()) continue;
        GDALApplyGeoTransform(inverse.data(), x, y, &px, &py);
        if (px >= 0.0 && px <= dataset.GetRasterXSize() && py >= 0.0 && py <= dataset.GetRasterYSize())
        {
            result.wholeCircle = true;
            (pole > 0.0 ? result.north : result.south) = pole;
        }
    }
    if (result.east - result.west + 1.5 * result.stepX >= 360.0) result.wholeCircle = true;
    if (result.wholeCircle) result.east = result.west + 360.0;
}

Footprint RasterSource::footprint(const GridCrs& crs) const
{
    auto& dataset = _chain.top();
    const int width = dataset.GetRasterXSize(), height = dataset.GetRasterYSize();
    const TransformationPtr toGrid = createTransformation(_srs, crs.srs, _file);

    // A mesh of pixel centers, its borders on the outermost pixels.
    constexpr int side = 33;
    const auto pixel = [](int index, int size)
    {
        return 0.5 + (size - 1) * (index / double(side - 1));
    };
    const auto toCrs = [&](double px, double py, double& x, double& y)
    {
        double gx = 0.0, gy = 0.0;
        GDALApplyGeoTransform(const_cast<double*>(_geoTransform.data()), px, py, &gx, &gy);
        x = gx;
        y = gy;
        int success = 0;
        toGrid->Transform(1, &x, &y, nullptr, &success);
        // PROJ turns longitudes into ±180°; a raster's own longitudes may run on, which is what is wanted.
        if (success && crs.geographic && _srs.IsGeographic()) x += 360.0 * std::round((gx - x) / 360.0);
        return success != 0 && std::isfinite(x) && std::isfinite(y);
    };
    const auto difference = [&](double a, double b)
    {
        const double d = a - b;
        return crs.geographic ? d - 360.0 * std::round(d / 360.0) : d;
    };

    Footprint result;
    result.west = result.south = result.stepX = result.stepY = std::numeric_limits<double>::max();
    result.east = result.north = std::numeric_limits<double>::lowest();
    bool any = false;
    double rowStart = 0.0;
    GdalErrorScope errors;
    for (int j = 0; j < side; ++j)
    {
        bool first = true;
        double previous = rowStart;
        for (int i = 0; i < side; ++i)
        {
            const double px = pixel(i, width), py = pixel(j, height);
            double x = 0.0, y = 0.0, x1 = 0.0, y1 = 0.0, x2 = 0.0, y2 = 0.0;
            if (!toCrs(px, py, x, y)) continue;
            if (any && crs.geographic && !_srs.IsGeographic()) x = previous + difference(x, previous);
            previous = x;
            if (first) rowStart = x;
            first = false;
            any = true;
            result.west = std::min(result.west, x);
            result.east = std::max(result.east, x);
            result.south = std::min(result.south, y);
            result.north = std::max(result.north, y);

            // The pixels that one unit of the grid's x or y crosses here, from the transformation's derivative.
            const double sx = px < width * 0.5 ? 0.5 : -0.5, sy = py < height * 0.5 ? 0.5 : -0.5;
            if (!toCrs(px + sx, py, x1, y1) || !toCrs(px, py + sy, x2, y2)) continue;
            const double a = difference(x1, x) / sx, b = difference(x2, x) / sy;
            const double c = (y1 - y) / sx, d = (y2 - y) / sy;
            const double area = std::abs(a * d - b * c);
            if (area > 0.0)
            {
                result.stepX = std::min(result.stepX, area / std::hypot(c, d));
                result.stepY = std::min(result.stepY, area / std::hypot(a, b));
            }
        }
    }
    if (!any || result.stepX == std::numeric_limits<double>::max())
        fail("no part of it can be brought into the CRS \"" + std::string(crs.srs.GetName()) +
             "\"; choose another CRS, or --geocentric");

    if (crs.geographic) takePoles(crs, result);
    return result;
}

void RasterSource::warp(const GridCrs& crs, const Lattice& lattice, const WarpRequest& request)
{
    GDALDataset& source = _chain.top();
    const ReadingFile reading(_file);
    const ReadingErrors errors;

    DatasetPtr target(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
        "", lattice.columns, lattice.rows, 0, request.type, nullptr));
    const std::size_t plane = static_cast<std::size_t>(lattice.columns) * lattice.rows *
                              static_cast<std::size_t>(GDALGetDataTypeSizeBytes(request.type));
    for (int band = 0; band < request.bands; ++band)
    {
        char pointer[64] = {};
        CPLPrintPointer(pointer, static_cast<char*>(request.planes) + plane * static_cast<std::size_t>(band),
                        sizeof(pointer) - 1);
        CPLStringList options;
        options.SetNameValue("DATAPOINTER", pointer);
        target->AddBand(request.type, options.List());
    }

    const TransformationPtr gridToSource = createTransformation(crs.srs, _srs, _file);
    LatticeTransformer transformer(lattice, crs.geographic, *gridToSource, _geoTransform,
                                   _srs.IsGeographic() != 0, source.GetRasterXSize(),
                                   source.GetRasterYSize());
    if (!transformer.invertible())
        fail("its geotransform is singular; repair it with gdal_translate -a_ullr");
    if (!crs.geographic || lattice.dx * lattice.columns < 180.0) transformer.approximate(TRANSFORM_TOLERANCE);

    const std::unique_ptr<GDALWarpOptions, void (*)(GDALWarpOptions*)> options(GDALCreateWarpOptions(),
                                                                               &GDALDestroyWarpOptions);
    options->hSrcDS = GDALDataset::ToHandle(&source);
    options->hDstDS = GDALDataset::ToHandle(target.get());
    options->eResampleAlg = request.resampling;
    options->eWorkingDataType = request.type;
    options->dfWarpMemoryLimit = WARP_MEMORY_BYTES;
    const int colors = request.alpha ? request.bands - 1 : request.bands;
    options->nBandCount = colors;
    options->panSrcBands = static_cast<int*>(CPLMalloc(sizeof(int) * static_cast<std::size_t>(colors)));
    options->panDstBands = static_cast<int*>(CPLMalloc(sizeof(int) * static_cast<std::size_t>(colors)));
    for (int band = 0; band < colors; ++band)
        options->panSrcBands[band] = options->panDstBands[band] = band + 1;
    options->nSrcAlphaBand = alphaOf(source);
    if (request.alpha)
        options->nDstAlphaBand = request.bands;
    else if (options->nSrcAlphaBand == 0)
    {
        int hasNoData = FALSE;
        const double noData = source.GetRasterBand(1)->GetNoDataValue(&hasNoData);
        if (hasNoData)
        {
            options->padfSrcNoDataReal = static_cast<double*>(CPLMalloc(sizeof(double)));
            options->padfSrcNoDataReal[0] = noData;
        }
    }
    char** warpOptions = nullptr;
    // Whole-window sampling, because an edge alone misses what a pole or a curved edge does inside.
    warpOptions = CSLSetNameValue(warpOptions, "SAMPLE_GRID", "YES");
    warpOptions = CSLSetNameValue(warpOptions, "SOURCE_EXTRA", "4");
    if (request.plainKernel)
    {
        warpOptions = CSLSetNameValue(warpOptions, "XSCALE", "1");
        warpOptions = CSLSetNameValue(warpOptions, "YSCALE", "1");
    }
    options->papszWarpOptions = warpOptions;
    options->pfnTransformer = &LatticeTransformer::transform;
    options->pTransformerArg = &transformer;

    GDALWarpOperation operation;
    if (operation.Initialize(options.get()) != CE_None ||
        operation.ChunkAndWarpImage(0, 0, lattice.columns, lattice.rows) != CE_None)
        fail("its pixels cannot be read" +
             causeAndRemedy(errors.message, "the file may be cut short: copy or export it again"));
}

void RasterSource::sampleHeights(const GridCrs& crs, const Lattice& lattice, float* out)
{
    WarpRequest request;
    request.planes = out;
    request.plainKernel = true;
    warp(crs, lattice, request);
}

void RasterSource::markCovered(const GridCrs& crs, const Lattice& lattice, unsigned char* covered)
{
    const GDALDataset& raster = _chain.top();
    const int width = const_cast<GDALDataset&>(raster).GetRasterXSize();
    const int height = const_cast<GDALDataset&>(raster).GetRasterYSize();
    const TransformationPtr gridToSource = createTransformation(crs.srs, _srs, _file);
    const GdalErrorScope errors;
    LatticeTransformer transformer(lattice, crs.geographic, *gridToSource, _geoTransform,
                                   _srs.IsGeographic() != 0, width, height);
    if (!transformer.invertible())
        fail("its geotransform is singular; repair it with gdal_translate -a_ullr");
    const auto columns = static_cast<std::size_t>(lattice.columns);
    std::vector<double> x, y, z;
    std::vector<int> success;
    std::vector<std::size_t> asked;
    for (int row = 0; row < lattice.rows; ++row)
    {
        unsigned char* line = covered + static_cast<std::size_t>(row) * columns;
        x.clear();
        asked.clear();
        for (std::size_t column = 0; column < columns; ++column)
            if (!line[column])
            {
                asked.push_back(column);
                x.push_back(static_cast<double>(column) + 0.5);
            }
        if (asked.empty()) continue;
        y.assign(x.size(), row + 0.5);
        z.assign(x.size(), 0.0);
        success.assign(x.size(), 0);
        LatticeTransformer::transform(&transformer, TRUE, static_cast<int>(x.size()), x.data(), y.data(),
                                      z.data(), success.data());
        for (std::size_t i = 0; i < asked.size(); ++i)
            if (success[i] && x[i] >= 0.0 && x[i] <= width && y[i] >= 0.0 && y[i] <= height)
                line[asked[i]] = 1;
    }
}

void RasterSource::sampleMeans(const GridCrs& crs, const Lattice& lattice, float* out)
{
    WarpRequest request;
    request.planes = out;
    warp(crs, lattice, request);
}

void RasterSource::sampleColors(const GridCrs& crs, const Lattice& lattice, unsigned char* planes)
{
    WarpRequest request;
    request.type = GDT_Byte;
    request.planes = planes;
    request.bands = 4;
    request.alpha = true;
    // Colors of classes meet in steps of whole pixels; a B-spline rounds them off, as a map's draughtsman would.
    if (_colorized) request.resampling = GRA_CubicSpline;
    warp(crs, lattice, request);
}

void RasterSource::sampleClasses(const GridCrs& crs, const Lattice& lattice, unsigned char* out)
{
    WarpRequest request;
    request.type = GDT_Byte;
    request.planes = out;
    request.resampling = GRA_NearestNeighbour;
    warp(crs, lattice, request);
}

} // namespace osgGeoFX
