// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/detail/RasterSource.h>

#include <gdal_alg.h>

#include <array>
#include <memory>

namespace osgGeoFX
{

/** From the pixels of a lattice to the pixels of a raster and back, as GDAL's warper asks for it.

    It turns longitudes by full circles where that is what separates the two, and brings points that rounding has put
    a hair outside the raster back onto its edge. Not thread-safe. */
class LatticeTransformer
{
public:
    /// `gridToSource` must live as long.
    LatticeTransformer(const Lattice& lattice, bool gridGeographic, OGRCoordinateTransformation& gridToSource,
                       const std::array<double, 6>& geoTransform, bool sourceGeographic, int width,
                       int height);

    /// Whether the raster's geotransform is not singular.
    bool invertible() const { return _invertible; }

    /// Takes points that are transformed nearly: interpolated with an error of up to `pixels`. Not for lattices that
    /// go half around the globe: GDAL looks at the ends and the middle of a line, and misses a jump in between.
    void approximate(double pixels);

    /// A GDALTransformerFunc; `self` is the LatticeTransformer, the lattice is the destination.
    static int CPL_STDCALL transform(void* self, int latticeToSource, int count, double* x, double* y,
                                     double* z, int* success);

private:
    static int CPL_STDCALL exactly(void* self, int latticeToSource, int count, double* x, double* y,
                                   double* z, int* success);
    int toSource(int count, double* x, double* y, double* z, int* success);
    int toLattice(int count, double* x, double* y, double* z, int* success);

    Lattice _lattice;
    bool _gridGeographic;
    OGRCoordinateTransformation& _gridToSource;
    TransformationPtr _sourceToGrid;
    std::array<double, 6> _forward{}, _inverse{};
    bool _sourceGeographic;
    bool _invertible = false;
    int _width, _height;
    double _middleX = 0.0;
    std::unique_ptr<void, void (*)(void*)> _approximation{nullptr, &GDALDestroyApproxTransformer};
};

} // namespace osgGeoFX
