// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Functions that stay exact where the textbook formula becomes 0/0. C++ has 12 terms, for double precision. GLSL has
// 5 (GEOFX_SERIES_TERMS), for floats, which is what a vertex can afford. OpenGL promises nothing about the precision
// of sin, atan and asinh (Mesa's atan is off by 2e-5 near zero). So these are series. Arguments that are not near
// zero are brought near zero first.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

// sin(x)/x for |x| <= pi/2.
GEOFX_INLINE Number geofx_sinc(Angle x)
{
    Number y = x * x;
    Number sum = Number(1);
    for (int n = GEOFX_SERIES_TERMS; n >= 1; --n)
    {
        sum = 1 - sum * y / Number(2 * n * (2 * n + 1));
    }
    return sum;
}

// atanh(x)/x for y = x*x, or atan(x)/x for y = -x*x; |y| <= 0.05.
GEOFX_INLINE Number geofx_atanhSeries(Number y)
{
    Number sum = Number(0);
    for (int n = GEOFX_SERIES_TERMS - 1; n >= 0; --n)
    {
        sum = sum * y + 1 / Number(2 * n + 1);
    }
    return sum;
}

// asinh(x)/x for |x| <= 1. It halves the argument's area twice: tanh(a/2) = sinh a / (1 + cosh a) and tanh(a/2) =
// tanh a / (1 + sqrt(1 - tanh^2 a)).
GEOFX_INLINE Number geofx_asinhc(Number x)
{
    Number first = 1 + sqrt(1 + x * x);
    Number z = x / first;
    Number second = 1 + sqrt(1 - z * z);
    z /= second;
    return 4 * geofx_atanhSeries(z * z) / (first * second);
}

// atan(x)/x for |x| <= 1. It halves the angle twice: tan(a/2) = tan a / (1 + sqrt(1 + tan^2 a)).
GEOFX_INLINE Number geofx_atanc(Number x)
{
    Number first = 1 + sqrt(1 + x * x);
    Number z = x / first;
    Number second = 1 + sqrt(1 + z * z);
    z /= second;
    return 4 * geofx_atanhSeries(-z * z) / (first * second);
}
