// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/mapping/LayerSource.h>
#include <osgGeoFX/raster/RasterBands.h>

#include <osg/Vec2d>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// The frame as a coordinate system, and its unit.
struct FrameCrs
{
    std::string definition;
    osg::Vec2d origin; ///< metres
    double metresPerUnit = 1.0;

    /// From metres in the frame.
    osg::Vec2d fromFrame(const osg::Vec2d& place) const { return (place + origin) / metresPerUnit; }
};

/// Where tiles of a file in this frame come from.
LayerSource sourceOf(const std::string& file, const MappingFrame& frame);

/// Throws BuildError, naming `file`, where a projected terrain's coordinate system is none.
FrameCrs crsOf(const MappingFrame& frame, const std::string& file);

/// What vector data are brought to for a frame: degrees on a globe, else the frame's coordinate system.
struct VectorTarget
{
    OGRSpatialReference crs;
    double metresPerUnit = 1.0;
};

/// Where tiles of a file in this frame come from.
LayerSource sourceOf(const std::string& file, const MappingFrame& frame);

/// Throws BuildError, naming `file`, where a projected terrain's coordinate system is none.
VectorTarget vectorTargetOf(const MappingFrame& frame, const std::string& file);

/** A raster file to be warped into a frame, with the virtual datasets on top of it that make colors or values of its
    bands. All of it throws BuildError, naming file and remedy. */
class FrameRaster
{
public:
    /// Which files are opened.
    enum Formats
    {
        ANY_FORMAT,
        PLAIN_PICTURES ///< formats that hold all of a picture themselves: PNG, JPEG, GIF, TIFF, BMP, WebP, JPEG 2000
    };
    /// `placed`: whether it needs a georeference, which all but picture() go by. `overview`: the index of the overview that is
    /// taken for the raster; -1 for the raster itself. `show`: of an overview, with all that was decided for the raster.
    FrameRaster(std::string file, std::optional<DataLayer::Kind> wanted, bool placed = true,
                Formats formats = ANY_FORMAT, int overview = -1, const RasterBands& show = {});
    /// The same of datasets that are open, each above the one before it; `file` is for messages.
    FrameRaster(std::string file, DatasetChain chain, std::optional<DataLayer::Kind> wanted);
    FrameRaster(const FrameRaster&) = delete;
    FrameRaster& operator=(const FrameRaster&) = delete;

    DataLayer::Kind kind = DataLayer::COLOR;
    RasterBands bands;  ///< what is shown; of colors, with all that the file and its numbers have decided
    double scale = 1.0; ///< of values
    double offset = 0.0;

    [[noreturn]] void fail(const std::string& what) const;
    /// Gives a layer of the raster's values their unit, and one of its classes their names (LayerWords).
    void giveWords(DataLayer& layer) const;
    /// How many pixels of the file along a side are one of each of its overviews, in the file's order; 1 for an overview that lacks the
    /// file's mask. (Datasets on top of a file hide them where it has a mask.)
    std::vector<double> overviews() const;
    /// The coarsest overview that is fine enough where so many of the raster's pixels along a side are a texel; -1 for the raster itself.
    int overviewFor(double pixels) const;
    /// Fails where a coarse picture of all of it takes more pixels than can be read at once.
    void checkOverviews() const;

    /// What the raster covers, from edge to edge of its outermost pixels, and the size of a texel that keeps its
    /// resolution; in the CRS's unit.
    struct Extent
    {
        osg::Vec2d low, high;
        double texel = 0.0;
    };
    Extent extent(const FrameCrs& crs) const;
    osg::Vec2d middle(const FrameCrs& crs) const;
    /// Moves a frame's origin to the raster's middle.
    void moveToMiddle(MappingFrame& frame) const;
    /// From 0…1 of the raster's sides, from its lower left corner, to the CRS's unit; nothing where the raster shows none of the Earth, as the corners of
    /// a satellite's picture. Not beyond the raster's own life.
    std::function<std::optional<osg::Vec2d>(const osg::Vec2d&)> placer(const FrameCrs& crs) const;

    /// A rectangle in the CRS's unit, in so many texels: red, green, blue and alpha in bytes, or values in doubles with NaN
    /// where there is none, not yet scaled.
    DatasetPtr warped(const FrameCrs& crs, const osg::Vec2d& low, const osg::Vec2d& high, int width,
                      int height) const;
    /// A row of values that were warped, from the north, scaled; NaN where there is none that a float can hold.
    void readValues(GDALDataset& warped, int row, std::vector<double>& values) const;
    /// Colors that were warped, four bytes each, in rows from the south.
    void readColors(GDALDataset& warped, unsigned char* colors) const;

    /// The same as an image, in rows from the south: RGBA bytes, or floats. With `low` and `high` the range of values that are there
    /// grows, or begins if *low > *high.
    osg::ref_ptr<osg::Image> image(const FrameCrs& crs, const osg::Vec2d& from, const osg::Vec2d& to,
                                   int width, int height, double* low = nullptr,
                                   double* high = nullptr) const;

    /// The raster's own pixels, in rows from the south: colors as RGBA bytes, else floats with NaN where there is none. One
    /// with more than `maxSide` pixels on a side is reduced to it, by area, or of classes and palettes by the nearest pixel.
    osg::ref_ptr<osg::Image> picture(int maxSide) const;
    osg::Vec2d size() const { return osg::Vec2d(top().GetRasterXSize(), top().GetRasterYSize()); }

    /// What a rectangle in the CRS's unit, of so many texels, has below.
    struct Below
    {
        double pixels = 0.0; ///< of the raster below a texel: the median of those that have any
        double share = 0.0;  ///< of the texels that have any, 0…1
    };
    Below below(const FrameCrs& crs, const osg::Vec2d& low, const osg::Vec2d& high, int width,
                int height) const;

private:
    using Arguments = std::vector<std::string>;
    struct TransformerDestroyer
    {
        void operator()(void* transformer) const;
    };
    using Transformer = std::unique_ptr<void, TransformerDestroyer>;

    Transformer transformerTo(const FrameCrs& crs, const GdalErrorScope& errors) const;
    [[noreturn]] void failToPlace(const GdalErrorScope& errors) const;
    GDALDataset& top() const { return _chain.top(); }
    GDALRasterBand& band() const { return *top().GetRasterBand(1); }
    [[noreturn]] void failToUse(const GdalErrorScope& errors) const;
    [[noreturn]] void failToRead(const GdalErrorScope& errors) const;
    [[noreturn]] void failToRead(const std::string& message) const;
    void prepare(std::optional<DataLayer::Kind> wanted, bool placed);
    void checkPlace() const;
    void closeCircle();
    /// Fails where so many of the file's pixels, of the overview that is taken, would have to be read that it takes too long.
    void checkPixels(double pixels) const;
    [[noreturn]] void failForOverviews() const;
    void checkSize() const;
    void readNumbers(osg::Image& image, GDALRasterIOExtraArg& how) const;
    void translate(const Arguments& arguments);
    void makeColors();
    void makeValues();

    /// GDAL would keep a part of the machine's memory otherwise.
    const std::shared_ptr<GdalCacheLimit> _cache = GdalCacheLimit::small();
    std::string _file;
    DatasetChain _chain;
    bool _palette = false;
};

} // namespace osgGeoFX
