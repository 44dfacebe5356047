// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/ColorDifference.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

using glm::dvec3;
using glsl::Rgb;

/// The part of linear red, green and blue in what a dichromat sees of each.
constexpr double protanopia[3][3] = {
    {0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}};
constexpr double deuteranopia[3][3] = {
    {0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}};
/// X, Y and Z of linear red, green and blue in sRGB, relative to the white of D65.
constexpr double xyzOfRgb[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
constexpr double white[3] = {0.95047, 1.0, 1.08883};

dvec3 times(const double (&matrix)[3][3], const dvec3& vector)
{
    dvec3 result(0.0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            result[row] += matrix[row][column] * vector[column];
    return result;
}

dvec3 linear(const Rgb& coded)
{
    dvec3 result;
    for (int i = 0; i < 3; ++i)
        result[i] = coded[i] <= 0.04045 ? coded[i] / 12.92 : std::pow((coded[i] + 0.055) / 1.055, 2.4);
    return result;
}

Rgb coded(const dvec3& linear)
{
    Rgb result;
    for (int i = 0; i < 3; ++i)
    {
        const double value = std::clamp(linear[i], 0.0, 1.0);
        result[i] = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
    }
    return result;
}

/// The hue of a* and b*, degrees, 0…360.
double hueOf(double a, double b)
{
    if (a == 0.0 && b == 0.0) return 0.0;
    const double degrees = osg::RadiansToDegrees(std::atan2(b, a));
    return degrees < 0.0 ? degrees + 360.0 : degrees;
}

double cosine(double degrees)
{
    return std::cos(osg::DegreesToRadians(degrees));
}

double seventh(double chroma)
{
    const double power = std::pow(chroma, 7.0);
    return std::sqrt(power / (power + std::pow(25.0, 7.0)));
}

} // namespace

Rgb seenWith(ColorVision vision, const Rgb& color)
{
    switch (vision)
    {
    case ColorVision::PROTANOPIA:
        return coded(times(protanopia, linear(color)));
    case ColorVision::DEUTERANOPIA:
        return coded(times(deuteranopia, linear(color)));
    case ColorVision::USUAL:
        break;
    }
    return color;
}

dvec3 labOf(const Rgb& color)
{
    dvec3 xyz = times(xyzOfRgb, linear(color));
    for (int i = 0; i < 3; ++i)
    {
        const double share = xyz[i] / white[i];
        xyz[i] = share > 216.0 / 24389.0 ? std::cbrt(share) : (24389.0 / 27.0 * share + 16.0) / 116.0;
    }
    return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

double colorDifference(const dvec3& first, const dvec3& second)
{
    // The names are those of the standard, ISO/CIE 11664-6.
    const double meanC = (std::hypot(first.y, first.z) + std::hypot(second.y, second.z)) / 2.0;
    const double g = 0.5 * (1.0 - seventh(meanC));
    const double a1 = (1.0 + g) * first.y;
    const double a2 = (1.0 + g) * second.y;
    const double c1 = std::hypot(a1, first.z);
    const double c2 = std::hypot(a2, second.z);
    const double h1 = hueOf(a1, first.z);
    const double h2 = hueOf(a2, second.z);
    double turn = c1 * c2 == 0.0 ? 0.0 : h2 - h1;
    if (turn > 180.0) turn -= 360.0;
    if (turn < -180.0) turn += 360.0;
    double meanH = h1 + h2;
    if (c1 * c2 != 0.0)
    {
        if (std::abs(h1 - h2) > 180.0) meanH += meanH < 360.0 ? 360.0 : -360.0;
        meanH /= 2.0;
    }
    const double dL = second.x - first.x;
    const double dC = c2 - c1;
    const double dH = 2.0 * std::sqrt(c1 * c2) * std::sin(osg::DegreesToRadians(turn / 2.0));
    const double meanL = (first.x + second.x) / 2.0;
    const double meanC2 = (c1 + c2) / 2.0;
    const double t = 1.0 - 0.17 * cosine(meanH - 30.0) + 0.24 * cosine(2.0 * meanH) +
                     0.32 * cosine(3.0 * meanH + 6.0) - 0.20 * cosine(4.0 * meanH - 63.0);
    const double fromMiddle = (meanL - 50.0) * (meanL - 50.0);
    const double sL = 1.0 + 0.015 * fromMiddle / std::sqrt(20.0 + fromMiddle);
    const double sC = 1.0 + 0.045 * meanC2;
    const double sH = 1.0 + 0.015 * meanC2 * t;
    const double blue = (meanH - 275.0) / 25.0;
    const double theta = 30.0 * std::exp(-blue * blue);
    const double rT = -2.0 * seventh(meanC2) * std::sin(osg::DegreesToRadians(2.0 * theta));
    const double l = dL / sL, c = dC / sC, h = dH / sH;
    return std::sqrt(std::max(l * l + c * c + h * h + rT * c * h, 0.0));
}

} // namespace osgGeoFX
