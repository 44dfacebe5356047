// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <osgGeoFX/geodata/detail/GdalSupport.h>
#include <osgGeoFX/geodata/detail/UndeclaredVoids.h>

#include <memory>
#include <vector>

namespace osgGeoFX
{

/** Which pixels of a raster are missing, in one place for all that read rasters.

    A pixel is missing where the raster's mask is 0 (in the file or in a file beside it), where its alpha band is 0, where all of
    the bands that are shown have their no-data value, or where the first of these has an undeclared one, if such are given. One band
    alone may have its no-data value by chance: a color with no red is no hole. JPEG rounds no-data values of bytes, so there, and in
    virtual rasters of such files, a value within 3 of them counts. GDAL's own masks show one of these, and its virtual datasets show
    the mask of a band but not that of a color. Not thread-safe. */
class RasterMask
{
public:
    /// Of the bands that are shown, by their numbers, which must be some. `undeclared`: of an elevation; only without an overview. `overview`: the
    /// index of the overview whose pixels count, which must have the mask (isInOverview()); -1 for the dataset itself. The dataset must outlive the
    /// mask.
    RasterMask(GDALDataset& dataset, const std::vector<int>& bands, UndeclaredVoids undeclared = {},
               int overview = -1);

    /// Whether no pixel can be missing.
    bool isEmpty() const { return _masks.empty() && _noData.empty() && !_alpha && _undeclared.isEmpty(); }
    /// Whether it is the no-data value of a single band and nothing else. GDAL's readers go by that themselves.
    bool isNoDataValue() const
    {
        return _masks.empty() && _noData.size() == 1 && !_alpha && _undeclared.isEmpty();
    }

    /// From 0 (missing) to 255 for the pixels of a window, in close rows. False where they cannot be read; GDAL has said why then.
    bool read(int left, int top, int columns, int rows, unsigned char* out);

    /// How a dataset that addTo() makes shows what is missing.
    enum class Form
    {
        ALPHA, ///< a band of alpha, bytes, behind the bands; it replaces one that was there, which counts as well
        NOT_A_NUMBER ///< one band of floating-point numbers, NaN where they are missing
    };
    /// Puts a dataset on top of the chain that has the bands, the place and the metadata of the one below, and the mask in this form. It has no
    /// overviews: those of a mask need not be there. The mask's dataset must be in the chain.
    static void addTo(DatasetChain& chain, std::unique_ptr<RasterMask> mask, Form form);

    /// Whether an overview of a dataset has the mask that the dataset has.
    static bool isInOverview(GDALDataset& dataset, int overview);

private:
    bool readMost(const std::vector<GDALRasterBand*>& bands, int left, int top, int columns, int rows,
                  std::vector<unsigned char>& out) const;

    std::vector<GDALRasterBand*> _masks; ///< one for all bands, or one for each
    std::vector<std::unique_ptr<GDALRasterBand>> _noData;
    GDALRasterBand* _alpha = nullptr;
    GDALRasterBand* const _first;
    const UndeclaredVoids _undeclared;
};

} // namespace osgGeoFX
