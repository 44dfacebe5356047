// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/LatticeTransformer.h>

#include <cmath>

namespace osgGeoFX
{

namespace
{

// Where a grid's point may lie outside a raster and still count as on its edge, in pixels: what the
// rounding of a footprint through PROJ can cost, no more.
constexpr double EDGE_TOLERANCE = 0.02;

double wrapLongitude(double longitude)
{
    if (longitude >= -180.0 && longitude <= 180.0) return longitude;
    const double turned = std::fmod(longitude + 180.0, 360.0);
    return turned < 0.0 ? turned + 180.0 : turned - 180.0;
}

double ontoEdge(double pixel, int size)
{
    constexpr double inside = 1e-7;
    if (pixel < inside && pixel > -EDGE_TOLERANCE) return inside;
    if (pixel > size - inside && pixel < size + EDGE_TOLERANCE) return size - inside;
    return pixel;
}

} // namespace

LatticeTransformer::LatticeTransformer(const Lattice& lattice, bool gridGeographic,
                                       OGRCoordinateTransformation& gridToSource,
                                       const std::array<double, 6>& geoTransform, bool sourceGeographic,
                                       int width, int height)
    : _lattice(lattice), _gridGeographic(gridGeographic), _gridToSource(gridToSource), _forward(geoTransform),
      _sourceGeographic(sourceGeographic), _width(width), _height(height)
{
    _invertible = GDALInvGeoTransform(_forward.data(), _inverse.data()) != 0;
    double middleY = 0.0;
    GDALApplyGeoTransform(_forward.data(), width * 0.5, height * 0.5, &_middleX, &middleY);
}

void LatticeTransformer::approximate(double pixels)
{
    _approximation.reset(GDALCreateApproxTransformer(&LatticeTransformer::exactly, this, pixels));
}

int CPL_STDCALL LatticeTransformer::transform(void* self, int latticeToSource, int count, double* x,
                                              double* y, double* z, int* success)
{
    auto* t = static_cast<LatticeTransformer*>(self);
    const int result = t->_approximation ? GDALApproxTransform(t->_approximation.get(), latticeToSource,
                                                               count, x, y, z, success)
                                         : exactly(self, latticeToSource, count, x, y, z, success);
    // After the interpolation, which a bend in the line would mislead.
    for (int i = 0; result && latticeToSource && i < count; ++i)
    {
        x[i] = ontoEdge(x[i], t->_width);
        y[i] = ontoEdge(y[i], t->_height);
    }
    return result;
}

int CPL_STDCALL LatticeTransformer::exactly(void* self, int latticeToSource, int count, double* x, double* y,
                                            double* z, int* success)
{
    auto* t = static_cast<LatticeTransformer*>(self);
    return latticeToSource ? t->toSource(count, x, y, z, success) : t->toLattice(count, x, y, z, success);
}

int LatticeTransformer::toSource(int count, double* x, double* y, double* z, int* success)
{
    for (int i = 0; i < count; ++i)
    {
        x[i] = _lattice.x0 + (x[i] - 0.5) * _lattice.dx;
        y[i] = _lattice.y0 + (y[i] - 0.5) * _lattice.dy;
        if (_gridGeographic) x[i] = wrapLongitude(x[i]);
    }
    _gridToSource.Transform(count, x, y, z, success);
    for (int i = 0; i < count; ++i)
    {
        if (!success[i]) continue;
        if (_sourceGeographic) x[i] += 360.0 * std::round((_middleX - x[i]) / 360.0);
        const double sx = x[i], sy = y[i];
        GDALApplyGeoTransform(_inverse.data(), sx, sy, &x[i], &y[i]);
    }
    return TRUE;
}

int LatticeTransformer::toLattice(int count, double* x, double* y, double* z, int* success)
{
    if (!_sourceToGrid) _sourceToGrid.reset(_gridToSource.GetInverse());
    if (!_sourceToGrid) return FALSE;
    for (int i = 0; i < count; ++i)
    {
        const double px = x[i], py = y[i];
        GDALApplyGeoTransform(_forward.data(), px, py, &x[i], &y[i]);
    }
    _sourceToGrid->Transform(count, x, y, z, success);
    const double middle = _lattice.x0 + 0.5 * _lattice.columns * _lattice.dx;
    for (int i = 0; i < count; ++i)
    {
        if (!success[i]) continue;
        if (_gridGeographic) x[i] += 360.0 * std::round((middle - x[i]) / 360.0);
        x[i] = (x[i] - _lattice.x0) / _lattice.dx + 0.5;
        y[i] = (y[i] - _lattice.y0) / _lattice.dy + 0.5;
    }
    return TRUE;
}

} // namespace osgGeoFX
