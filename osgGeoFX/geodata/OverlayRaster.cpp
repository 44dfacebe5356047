// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/OverlayRaster.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/FrameRaster.h>
#include <osgGeoFX/geodata/detail/KmlFolder.h>
#include <osgGeoFX/geodata/detail/QuadMap.h>
#include <osgGeoFX/geodata/detail/RasterReach.h>

#include <cpl_string.h>
#include <gdal_alg.h>
#include <gdalwarper.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

using Corners = std::array<osg::Vec2d, 4>;

constexpr double earthRadius = 6371e3; // metres
/// Of the lattices that stand for a raster, points a side.
constexpr int lattice = 33;

/// The place of a lattice's point in the picture, 0…1.
osg::Vec2d pictureAt(int point)
{
    const int column = point % lattice, row = point / lattice;
    return {column / (lattice - 1.0), row / (lattice - 1.0)};
}

osg::Vec3d directionOf(const osg::Vec2d& degrees)
{
    const double x = osg::DegreesToRadians(degrees.x()), y = osg::DegreesToRadians(degrees.y());
    return {std::cos(y) * std::cos(x), std::cos(y) * std::sin(x), std::sin(y)};
}

double angleBetween(const osg::Vec3d& a, const osg::Vec3d& b)
{
    return 2.0 * std::asin(std::min(1.0, (a - b).length() / 2.0));
}

/// `place` gives degrees for 0…1 of the picture's sides, which have so many pixels, or nothing beside the Earth. Empty if no part of the picture is
/// on the Earth.
template<typename Function>
std::optional<GroundReach> reachOver(const Function& place, double columns, double rows)
{
    std::vector<osg::Vec3d> directions;
    osg::Vec3d sum;
    for (int i = 0; i < lattice * lattice; ++i)
    {
        const std::optional<osg::Vec2d> degrees = place(pictureAt(i));
        if (!degrees) continue;
        directions.push_back(directionOf(*degrees));
        sum += directions.back();
    }
    // Pictures of all of the Earth's disk have their middle on it; others may have the Earth in a corner.
    osg::Vec2d center(0.5, 0.5);
    std::optional<osg::Vec2d> middle = place(center);
    for (int i = 0; i < lattice * lattice && !middle && !directions.empty(); ++i)
    {
        center = pictureAt(i);
        const std::optional<osg::Vec2d> degrees = place(center);
        if (degrees && angleBetween(directionOf(*degrees), sum / sum.length()) < 0.5) middle = degrees;
    }
    if (!middle) return std::nullopt;
    GroundReach reach;
    reach.middle = *middle;
    const osg::Vec3d inward = directionOf(reach.middle);
    for (const osg::Vec3d& direction : directions)
        reach.radius = std::max(reach.radius, angleBetween(direction, inward));
    const double step = 1e-3;
    const auto length = [&](const osg::Vec2d& along)
    {
        const std::optional<osg::Vec2d> there = place(center + along * step);
        return there ? angleBetween(directionOf(*there), inward) / step * earthRadius : 2.0 * earthRadius;
    };
    reach.texel = std::min(length({1.0, 0.0}) / columns, length({0.0, 1.0}) / rows);
    reach.middle.x() = std::remainder(reach.middle.x(), 360.0);
    return reach;
}

/// The frame's coordinate system from degrees and back.
class FrameTransformation
{
public:
    FrameTransformation(const FrameCrs& crs, const std::string& file) : _crs(crs), _file(file)
    {
        _degrees.importFromEPSG(4326);
        _frame.SetFromUserInput(crs.definition.c_str());
        _toFrame = createTransformation(gisOrder(_degrees), gisOrder(_frame), file);
    }

    /// Degrees become places of the frame, metres. False if one of them has none.
    bool toFrame(std::vector<osg::Vec2d>& places) const
    {
        std::vector<double> x, y;
        for (const osg::Vec2d& place : places)
        {
            x.push_back(place.x());
            y.push_back(place.y());
        }
        std::vector<int> success(places.size());
        const GdalErrorScope errors;
        _toFrame->Transform(places.size(), x.data(), y.data(), nullptr, success.data());
        for (std::size_t i = 0; i < places.size(); ++i)
        {
            if (!success[i] || !std::isfinite(x[i]) || !std::isfinite(y[i])) return false;
            places[i] = osg::Vec2d(x[i], y[i]) * _crs.metresPerUnit - _crs.origin;
        }
        return true;
    }

    /// Places of the frame, metres, become degrees, in place.
    void toDegrees(int count, double* x, double* y, int* success)
    {
        if (!_toDegrees) _toDegrees = createTransformation(gisOrder(_frame), gisOrder(_degrees), _file);
        for (int i = 0; i < count; ++i)
        {
            const osg::Vec2d place = _crs.fromFrame({x[i], y[i]});
            x[i] = place.x();
            y[i] = place.y();
        }
        const GdalErrorScope errors;
        _toDegrees->Transform(static_cast<std::size_t>(count), x, y, nullptr, success);
    }

private:
    FrameCrs _crs;
    std::string _file;
    OGRSpatialReference _degrees, _frame;
    TransformationPtr _toFrame, _toDegrees;
};

/// What the warper asks: from pixels of the result to pixels of the picture.
struct Warp
{
    FrameTransformation& frame;
    const QuadMap& quad;
    osg::Vec2d low;   ///< of the result, metres
    osg::Vec2d texel; ///< the same
    int height;       ///< of the result, pixels
    double sourceWidth, sourceHeight;
    double middle; ///< degrees of longitude

    static int transform(void* argument, int toSource, int count, double* x, double* y, double* z,
                         int* success)
    {
        const auto& self = *static_cast<const Warp*>(argument);
        if (!toSource)
        {
            std::fill(success, success + count, FALSE);
            return FALSE;
        }
        for (int i = 0; i < count; ++i)
        {
            x[i] = self.low.x() + x[i] * self.texel.x();
            y[i] = self.low.y() + (self.height - y[i]) * self.texel.y();
            z[i] = 0.0;
        }
        self.frame.toDegrees(count, x, y, success);
        for (int i = 0; i < count; ++i)
        {
            if (!success[i] || !std::isfinite(x[i]) || !std::isfinite(y[i]))
            {
                success[i] = FALSE;
                continue;
            }
            const double longitude = self.middle + std::remainder(x[i] - self.middle, 360.0);
            const osg::Vec2d uv = self.quad.picture({longitude, y[i]});
            x[i] = uv.x() * self.sourceWidth;
            y[i] = (1.0 - uv.y()) * self.sourceHeight;
            // What is far beside the picture would make the warper read all of it.
            success[i] = std::abs(uv.x() - 0.5) < 2.0 && std::abs(uv.y() - 0.5) < 2.0 ? TRUE : FALSE;
        }
        return TRUE;
    }
};

/// Bytes of four bands as a data set, in rows from the north as the warper has them.
DatasetPtr datasetOf(int width, int height)
{
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("MEM");
    DatasetPtr result(driver->Create("", width, height, 4, GDT_Byte, nullptr));
    if (result) result->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
    return result;
}

void copy(GDALDataset& dataset, osg::Image& image, GDALRWFlag direction)
{
    const GSpacing row = 4 * static_cast<GSpacing>(image.s());
    if (dataset.RasterIO(direction, 0, 0, image.s(), image.t(), image.data() + row * (image.t() - 1),
                         image.s(), image.t(), GDT_Byte, 4, nullptr, 4, -row, 1, nullptr) != CE_None)
        throw BuildError("The picture cannot be copied; free some memory.");
}

/// Gives the texels around the picture, which are transparent, its colors: a filter mixes them with those of its edge.
void spread(osg::Image& image)
{
    const int width = image.s();
    const int height = image.t();
    for (int pass = 0; pass < 2; ++pass)
    {
        const std::vector<unsigned char> before(image.data(), image.data() + image.getTotalSizeInBytes());
        const auto at = [&](int x, int y)
        {
            return before.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                        static_cast<std::size_t>(x));
        };
        const auto isEmpty = [](const unsigned char* texel)
        {
            return texel[0] == 0 && texel[1] == 0 && texel[2] == 0 && texel[3] == 0;
        };
        for (int y = 0; y < height; ++y)
        {
            for (int x = 0; x < width; ++x)
            {
                if (!isEmpty(at(x, y))) continue;
                for (int i = 0; i < 9; ++i)
                {
                    const int column = std::clamp(x + i % 3 - 1, 0, width - 1);
                    const int row = std::clamp(y + i / 3 - 1, 0, height - 1);
                    const unsigned char* const neighbor = at(column, row);
                    if (isEmpty(neighbor)) continue;
                    std::copy(neighbor, neighbor + 3,
                              image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)));
                    break;
                }
            }
        }
    }
}

class Reader
{
public:
    Reader(const KmlOverlay& overlay, const OverlayRaster::Options& options)
        : _overlay(overlay), _options(options), _quad(overlay.corners), _name(nameOf(overlay))
    {
        if (!overlay.image.empty())
            _raster = std::make_unique<FrameRaster>(
                overlay.image, DataLayer::COLOR, false,
                options.anyFormat ? FrameRaster::ANY_FORMAT : FrameRaster::PLAIN_PICTURES, -1, options.bands);
    }

    GroundReach reach() const
    {
        const osg::Vec2d size = _raster ? _raster->size() : osg::Vec2d(plain, plain);
        return *reachOver([&](const osg::Vec2d& uv) { return std::optional(_quad.place(uv)); }, size.x(),
                          size.y());
    }

    OverlayRaster read(const MappingFrame& frame)
    {
        FrameTransformation transformation(crsOf(frame, _name), _name);
        OverlayRaster result;
        result.layer = colored(picture());
        osg::ref_ptr<osg::Image> image = result.layer->getImage();
        if (_options.window)
            image = warped(transformation, *_options.window, *image, result.corners);
        else
        {
            const std::vector<osg::Vec2d> places = placesIn(transformation);
            result.corners = {places[0], places[lattice - 1], places[lattice * lattice - 1],
                              places[lattice * (lattice - 1)]};
            if (!isStraight(places, result.corners, *image))
                image = warped(transformation, windowOf(places, *image), *image, result.corners);
        }
        if (image != result.layer->getImage()) result.layer = layerOf(image);
        return result;
    }

private:
    /// Texels a side of an overlay without a picture.
    static constexpr int plain = 512;

    static std::string nameOf(const KmlOverlay& overlay)
    {
        if (!overlay.image.empty()) return KmlFolder::plain(overlay.image);
        return "The ground overlay \"" + overlay.name + "\"";
    }

    osg::ref_ptr<DataLayer> layerOf(const osg::ref_ptr<osg::Image>& image) const
    {
        image->setFileName(KmlFolder::plain(_overlay.image));
        return new DataLayer(image);
    }

    /// As it is in the file.
    osg::ref_ptr<DataLayer> picture() const
    {
        if (!_raster)
        {
            const osg::ref_ptr<osg::Image> image = new osg::Image;
            image->allocateImage(plain, plain, 1, GL_RGBA, GL_UNSIGNED_BYTE);
            std::fill_n(image->data(), image->getTotalSizeInBytes(), static_cast<unsigned char>(255));
            return layerOf(image);
        }
        if (!_options.pictures) return layerOf(_raster->picture(_options.maxSide));
        osg::ref_ptr<DataLayer>& known = (*_options.pictures)[{_overlay.image, _options.maxSide}];
        if (!known) known = layerOf(_raster->picture(_options.maxSide));
        return known;
    }

    /// With the overlay's color; its alpha is left to the mapping.
    osg::ref_ptr<DataLayer> colored(const osg::ref_ptr<DataLayer>& picture) const
    {
        const osg::Vec4& color = _overlay.color;
        if (color.r() == 1.0f && color.g() == 1.0f && color.b() == 1.0f) return picture;
        const osg::ref_ptr<osg::Image> image = osg::clone(picture->getImage(), osg::CopyOp::DEEP_COPY_ALL);
        unsigned char* texel = image->data();
        for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
        {
            const unsigned int channel = i % 4;
            if (channel < 3)
                texel[i] = static_cast<unsigned char>(
                    std::lround(static_cast<float>(texel[i]) * std::clamp(color[channel], 0.0f, 1.0f)));
        }
        return layerOf(image);
    }

    /// Whether the corners alone place all texels to a quarter of one. Those of a picture with few texels count as smaller, for its
    /// edges are seen.
    static bool isStraight(const std::vector<osg::Vec2d>& places, const Corners& corners,
                           const osg::Image& image)
    {
        const QuadMap straight(corners);
        const int columns = std::max(image.s(), plain), rows = std::max(image.t(), plain);
        for (int i = 0; i < lattice * lattice; ++i)
        {
            const osg::Vec2d there = straight.picture(places[static_cast<std::size_t>(i)]) - pictureAt(i);
            if (!(std::abs(there.x()) * columns < 0.25 && std::abs(there.y()) * rows < 0.25)) return false;
        }
        return true;
    }

    std::vector<osg::Vec2d> placesIn(const FrameTransformation& transformation) const
    {
        std::vector<osg::Vec2d> places;
        for (int i = 0; i < lattice * lattice; ++i)
            places.push_back(_quad.place(pictureAt(i)));
        if (!transformation.toFrame(places))
            throw BuildError(
                _name + ": its place lies outside of the terrain's projection, or on the other side of the "
                        "globe; correct the corners, or give the effect an origin near them.");
        return places;
    }

    /// The rectangle around the picture, and its texels.
    static MappingRaster::Window windowOf(const std::vector<osg::Vec2d>& places, const osg::Image& image)
    {
        MappingRaster::Window window{places[0], places[0], 1e30};
        osg::Vec2d& low = window.low;
        osg::Vec2d& high = window.high;
        osg::Vec2d before;
        for (int i = 0; i < lattice * lattice; ++i)
        {
            const osg::Vec2d& place = places[static_cast<std::size_t>(i)];
            low.set(std::min(low.x(), place.x()), std::min(low.y(), place.y()));
            high.set(std::max(high.x(), place.x()), std::max(high.y(), place.y()));
            if (i % lattice > 0 && i / lattice == lattice / 2)
                window.texel =
                    std::min(window.texel, (place - before).length() * (lattice - 1.0) / image.s());
            before = place;
        }
        return window;
    }

    osg::ref_ptr<osg::Image> warped(FrameTransformation& transformation, const MappingRaster::Window& window,
                                    osg::Image& image, Corners& corners) const
    {
        const osg::Vec2d& low = window.low;
        const osg::Vec2d& high = window.high;
        const osg::Vec2d size = high - low;
        const double longer = std::max(size.x(), size.y());
        // Its edges are as sharp as its texels.
        const double texel =
            std::clamp(window.texel, longer / _options.maxSide, longer / std::min(plain, _options.maxSide));
        const auto texels = [&](double length)
        {
            return std::clamp(static_cast<int>(std::ceil(length / texel)), 1, _options.maxSide);
        };
        const int width = texels(size.x());
        const int height = texels(size.y());
        Warp warp{transformation,
                  _quad,
                  low,
                  osg::Vec2d(size.x() / width, size.y() / height),
                  height,
                  static_cast<double>(image.s()),
                  static_cast<double>(image.t()),
                  _quad.place({0.5, 0.5}).x()};
        const DatasetPtr source = datasetOf(image.s(), image.t());
        const DatasetPtr target = datasetOf(width, height);
        osg::ref_ptr<osg::Image> result = new osg::Image;
        result->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        copy(*source, image, GF_Write);
        run(*source, *target, warp);
        copy(*target, *result, GF_Read);
        spread(*result);
        corners = {low, osg::Vec2d(high.x(), low.y()), high, osg::Vec2d(low.x(), high.y())};
        return result;
    }

    void run(GDALDataset& source, GDALDataset& target, Warp& warp) const
    {
        struct OptionsDestroyer
        {
            void operator()(GDALWarpOptions* options) const { GDALDestroyWarpOptions(options); }
        };
        const std::unique_ptr<GDALWarpOptions, OptionsDestroyer> options(GDALCreateWarpOptions());
        options->hSrcDS = GDALDataset::ToHandle(&source);
        options->hDstDS = GDALDataset::ToHandle(&target);
        GDALWarpInitDefaultBandMapping(options.get(), 3);
        options->nSrcAlphaBand = 4;
        options->nDstAlphaBand = 4;
        options->eResampleAlg = GRA_Bilinear;
        // Exact at some places of each row, and straight between them to a fiftieth of a pixel.
        struct ApproximationDestroyer
        {
            void operator()(void* transformer) const { GDALDestroyApproxTransformer(transformer); }
        };
        const std::unique_ptr<void, ApproximationDestroyer> approximation(
            GDALCreateApproxTransformer(&Warp::transform, &warp, 0.02));
        options->pfnTransformer = &GDALApproxTransform;
        options->pTransformerArg = approximation.get();
        options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "INIT_DEST", "0");
        options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "SAMPLE_GRID", "YES");
        const GdalErrorScope errors;
        GDALWarpOperation operation;
        if (operation.Initialize(options.get()) != CE_None ||
            operation.ChunkAndWarpImage(0, 0, target.GetRasterXSize(), target.GetRasterYSize()) != CE_None)
            throw BuildError(_name + ": it cannot be brought to its place (" + errors.message() +
                             "); correct its corners.");
    }

    const KmlOverlay& _overlay;
    const OverlayRaster::Options& _options;
    const QuadMap _quad;
    const std::string _name;
    std::unique_ptr<FrameRaster> _raster;
};

} // namespace

namespace
{

/// With the picture's path as a person knows it.
std::string sentenceOf(const BuildError& failure, const KmlOverlay& overlay)
{
    std::string text = failure.what();
    const std::size_t at = overlay.image.empty() ? std::string::npos : text.find(overlay.image);
    if (at != std::string::npos) text.replace(at, overlay.image.size(), KmlFolder::plain(overlay.image));
    return text;
}

} // namespace

GroundReach reachOf(const FrameRaster& raster)
{
    FrameCrs degrees;
    degrees.definition = "EPSG:4326";
    const osg::Vec2d size = raster.size();
    const std::optional<GroundReach> reach = reachOver(raster.placer(degrees), size.x(), size.y());
    if (!reach)
        raster.fail("no part of it lies on the Earth; correct its georeference with gdal_translate -a_ullr");
    return *reach;
}

std::optional<OverlayRaster> OverlayRaster::read(const KmlOverlay& overlay, const MappingFrame& frame,
                                                 const Options& options, std::string& error)
{
    initialiseGdal();
    try
    {
        return Reader(overlay, options).read(frame);
    }
    catch (const BuildError& failure)
    {
        error = sentenceOf(failure, overlay);
        return std::nullopt;
    }
}

std::optional<GroundReach> OverlayRaster::reachOf(const KmlOverlay& overlay, const Options& options,
                                                  std::string& error)
{
    initialiseGdal();
    try
    {
        return Reader(overlay, options).reach();
    }
    catch (const BuildError& failure)
    {
        error = sentenceOf(failure, overlay);
        return std::nullopt;
    }
}

std::optional<GroundReach> OverlayRaster::reachOf(const std::string& file, std::string& error)
{
    initialiseGdal();
    try
    {
        return osgGeoFX::reachOf(FrameRaster(file, DataLayer::VALUE));
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return std::nullopt;
    }
}

std::function<std::optional<osg::Vec2d>(const osg::Vec2d&)> OverlayRaster::placer(const MappingFrame& frame,
                                                                                  const std::string& file)
{
    const auto transformation = std::make_shared<FrameTransformation>(crsOf(frame, file), file);
    return [transformation](const osg::Vec2d& degrees) -> std::optional<osg::Vec2d>
    {
        std::vector<osg::Vec2d> places = {degrees};
        if (!transformation->toFrame(places)) return std::nullopt;
        return places[0];
    };
}

bool OverlayRaster::moveToMiddle(const GroundReach& reach, const std::string& file, MappingFrame& frame,
                                 std::string& error)
{
    initialiseGdal();
    if (frame.globe)
    {
        frame.origin = LocalOrigin::onGlobe(osg::DegreesToRadians(reach.middle.x()),
                                            osg::DegreesToRadians(reach.middle.y()));
        return true;
    }
    try
    {
        MappingFrame plain = frame;
        plain.origin = LocalOrigin();
        std::vector<osg::Vec2d> place = {reach.middle};
        if (!FrameTransformation(crsOf(plain, file), file).toFrame(place))
            throw BuildError(file +
                             ": its place lies outside of the terrain's projection; correct its corners.");
        frame.origin = LocalOrigin::onPlane(place[0]);
        return true;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return false;
    }
}

} // namespace osgGeoFX
