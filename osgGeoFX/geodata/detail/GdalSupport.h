// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

struct DatasetCloser
{
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using DatasetPtr = std::unique_ptr<GDALDataset, DatasetCloser>;

/** A file and the virtual datasets on top of it, each of which reads from the one before it.

    The chain is their only owner, and closes the last one first, also where a constructor throws. GDAL 3.6 counts the references of
    virtual overviews to a mask wrongly: each takes one away that it has not added, so that the virtual dataset would delete the one below it.
    So the chain holds more references than GDAL can take away. Not thread-safe. */
class DatasetChain
{
public:
    DatasetChain() = default;
    ~DatasetChain() { clear(); }
    DatasetChain(DatasetChain&& other) noexcept : _datasets(std::move(other._datasets))
    {
        other._datasets.clear();
    }
    DatasetChain& operator=(DatasetChain&& other) noexcept
    {
        _datasets.swap(other._datasets);
        return *this;
    }
    DatasetChain(const DatasetChain&) = delete;
    DatasetChain& operator=(const DatasetChain&) = delete;

    /// Adds a dataset on top; null is left out. Returns whether there was one.
    bool add(DatasetPtr dataset);
    bool empty() const { return _datasets.empty(); }
    std::size_t size() const { return _datasets.size(); }
    /// The file. The chain must not be empty.
    GDALDataset& file() const { return *_datasets.front(); }
    /// The last one. The chain must not be empty.
    GDALDataset& top() const { return *_datasets.back(); }

private:
    void clear();

    std::vector<DatasetPtr> _datasets;
};

struct TransformationDestroyer
{
    void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
};
using TransformationPtr = std::unique_ptr<OGRCoordinateTransformation, TransformationDestroyer>;

/// Registers GDAL's drivers once for the process, and guards them where files by others are read. Thread-safe.
void initialiseGdal();

/** While it lives, keeps what GDAL reports on this thread from the terminal; `message()` is the first failure, or why
    a file by others is not read.
    GDAL's handlers are a stack for each thread, so these nest. */
class GdalErrorScope
{
public:
    GdalErrorScope();
    ~GdalErrorScope();
    GdalErrorScope(const GdalErrorScope&) = delete;
    GdalErrorScope& operator=(const GdalErrorScope&) = delete;

    bool failed() const { return !_message.empty(); }
    const std::string& message() const { return _message; }

private:
    static void CPL_STDCALL handle(CPLErr severity, CPLErrorNum number, const char* text);
    std::string _message;
};

/// Sets the size of GDAL's cache of blocks, bytes, while it lives. It is the process's.
class GdalCacheLimit
{
public:
    explicit GdalCacheLimit(GIntBig bytes) : _before(GDALGetCacheMax64()) { GDALSetCacheMax64(bytes); }
    ~GdalCacheLimit() { GDALSetCacheMax64(_before); }
    GdalCacheLimit(const GdalCacheLimit&) = delete;
    GdalCacheLimit& operator=(const GdalCacheLimit&) = delete;

    /// 64 MiB as long as one of these lives. Thread-safe.
    static std::shared_ptr<GdalCacheLimit> small();

private:
    GIntBig _before;
};

/// A CRS that takes longitude before latitude and easting before northing, whatever its authority says.
OGRSpatialReference gisOrder(OGRSpatialReference srs);

/// Transformation between two CRSs; throws BuildError, naming `file`, where PROJ has none.
TransformationPtr createTransformation(const OGRSpatialReference& from, const OGRSpatialReference& to,
                                       const std::string& file);

/// Why a raster's blocks cannot be read, as a part of a sentence; empty if they can. GDAL unpacks a block at once, also where a few of
/// its pixels are wanted.
std::string faultOfBlocks(GDALDataset& raster);

/// Why an archive (KMZ and other files of zip) is not unpacked, as a part of a sentence: what is in it is far larger than it. Empty if it
/// may be unpacked, and for other files. GDAL's drivers take many times the unpacked bytes, and unpack archives as soon as they open them.
std::string faultOfArchive(const std::string& file);

/** Opens vector data; throws BuildError where it is none.

    Places of CSV are in columns longitude and latitude, lon and lat, x and y, or WKT, in any case. Without a reference system (a .prj beside the
    file) they are degrees of WGS 84 if all may be; else whoever reads the layer refuses it. */
DatasetPtr openVectors(const std::string& file);

/// Hands out the layer of this name, or all layers if it is empty, without tables of attributes; throws BuildError where there is none of the
/// name, or where that is a table.
void forEachLayer(GDALDataset& dataset, const std::string& layer, const std::string& file,
                  const std::function<void(OGRLayer&)>& take);

/// Whether a feature is a picture on the ground of KML, which GDAL hands out as the area of its box.
bool isGroundOverlay(const OGRFeature& feature);

/// What forEachFeature() does with long lines.
enum class LongLines
{
    DIVIDED, ///< none is longer than about a kilometre, for what is straight in the file bends elsewhere
    KEPT     ///< for walls, which are short; an outline that is wrong may be endless
};

/// Hands out each feature with its geometry, curves as straight lines; with the way to the target's coordinates. Throws BuildError where
/// the layer has no CRS or cannot be read.
void forEachFeature(
    OGRLayer& layer, const OGRSpatialReference& target, const std::string& file,
    const std::function<void(const OGRFeature&, const OGRGeometry&, OGRCoordinateTransformation&)>& take,
    LongLines longLines = LongLines::DIVIDED);

} // namespace osgGeoFX
