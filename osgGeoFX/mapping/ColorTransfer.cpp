// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/ColorTransfer.h>

#include <osg/Math>

#include <cmath>

namespace osgGeoFX
{

namespace
{

using Matrix = ColorTransfer::Matrix;

/// `second` after `first`.
Matrix product(const Matrix& second, const Matrix& first)
{
    Matrix result;
    for (std::size_t row = 0; row < 3; ++row)
    {
        const osg::Vec4d& r = second[row];
        result[row] =
            first[0] * r.x() + first[1] * r.y() + first[2] * r.z() + osg::Vec4d(0.0, 0.0, 0.0, r.w());
    }
    return result;
}

/// The weights of Rec. 709, as in shaders/lib/mapping.glsl.
constexpr double luminance[3] = {0.2126, 0.7152, 0.0722};

Matrix scaled(double factor, double fixed)
{
    const double rest = fixed * (1.0 - factor);
    return {osg::Vec4d(factor, 0.0, 0.0, rest), osg::Vec4d(0.0, factor, 0.0, rest),
            osg::Vec4d(0.0, 0.0, factor, rest)};
}

Matrix saturated(double factor)
{
    Matrix result;
    for (std::size_t row = 0; row < 3; ++row)
    {
        for (std::size_t column = 0; column < 3; ++column)
        {
            const double own = row == column ? factor : 0.0;
            result[row][static_cast<int>(column)] = own + (1.0 - factor) * luminance[column];
        }
    }
    return result;
}

/// A turn about the axis of greys, sheared so that luminance stays (after the hueRotate of SVG 1.1's feColorMatrix).
Matrix hueTurned(double angle)
{
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    constexpr double r = luminance[0];
    constexpr double g = luminance[1];
    constexpr double b = luminance[2];
    return {osg::Vec4d(r + c * (1.0 - r) - s * r, g - c * g - s * g, b - c * b + s * (1.0 - b), 0.0),
            osg::Vec4d(r - c * r + s * 0.143, g + c * (1.0 - g) + s * 0.140, b - c * b - s * 0.283, 0.0),
            osg::Vec4d(r - c * r - s * (1.0 - r), g - c * g + s * g, b + c * (1.0 - b) + s * b, 0.0)};
}

/// In the order of Factor.
std::vector<Property::Choice> factors()
{
    return {{"zero", ""},
            {"one", ""},
            {"sourceColor", ""},
            {"oneMinusSourceColor", ""},
            {"destinationColor", ""},
            {"oneMinusDestinationColor", ""},
            {"sourceAlpha", ""},
            {"oneMinusSourceAlpha", ""},
            {"destinationAlpha", ""},
            {"oneMinusDestinationAlpha", ""},
            {"constantColor", ""},
            {"oneMinusConstantColor", ""},
            {"constantAlpha", ""},
            {"oneMinusConstantAlpha", ""},
            {"sourceAlphaSaturate", ""}};
}

} // namespace

ColorTransfer::ColorTransfer(const ColorTransfer& other, const osg::CopyOp& copy)
    : PropertyHolder(other, copy)
{
    for (const Property& property : ColorTransfer::properties())
        property.put(*this, property.get(other));
}

ColorTransfer::~ColorTransfer() = default;

const Properties& ColorTransfer::properties() const
{
    using Self = ColorTransfer;
    constexpr double most = 9e7;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            Property::choice("source", "where colors come from",
                             {{"layer", ""},
                              {"table", "the color table at the layer's value"},
                              {"scene", "what is drawn already"},
                              {"constant", "constantColor"}})
                .of<&Self::_source>(),
            Property::choice("alpha", "where alpha comes from",
                             {{"opaque", ""},
                              {"source", "the layer or the table"},
                              {"mask", "the mask from rampLow to rampHigh"},
                              {"ramp", "the layer's value from rampLow to rampHigh"}})
                .of<&Self::_alpha>(),
            Property::choice("sourceFactor", "OpenGL's blend factor of the mapping", factors())
                .of<&Self::_sourceFactor>(),
            Property::choice("destinationFactor", "OpenGL's blend factor of the scene", factors())
                .of<&Self::_destinationFactor>(),
            Property::choice("equation", "how both are combined",
                             {{"add", ""},
                              {"subtract", ""},
                              {"reverseSubtract", ""},
                              {"minimum", ""},
                              {"maximum", ""},
                              {"multiply", ""},
                              {"screen", ""},
                              {"overlay", ""},
                              {"discard", "takes the scene away"}})
                .of<&Self::_equation>(),
            Property::number("lowValue",
                             "the layer's value at the color table's beginning; less than highValue", -most,
                             most)
                .of<&Self::_lowValue>(),
            Property::number("highValue", "the layer's value at the color table's end; more than lowValue",
                             -most, most)
                .of<&Self::_highValue>(),
            Property::number("rampLow", "the value or grey where alpha is 0", -most, most)
                .of<&Self::_rampLow>(),
            Property::number("rampHigh", "the value or grey where alpha is 1", -most, most)
                .of<&Self::_rampHigh>(),
            Property::color("constantColor", "the constant color").of<&Self::_constantColor>(),
            Property::number("constantAlpha", "the alpha of the constant color", 0.0, 1.0)
                .of<&Self::_constantAlpha>(),
            Property::choice("pattern", "what alpha has in the picture's pixels; a mask takes its place",
                             {{"none", ""},
                              {"contours", "lines of equal height"},
                              {"graticule", "degrees on a globe, or the terrain's metres"},
                              {"hatching", "parallel lines"},
                              {"dots", "discs at the corners of squares"}})
                .of<&Self::_pattern>(),
            Property::number("patternInterval",
                             "from line to line: metres, or degrees of a graticule on a globe", 1e-4, 1e7)
                .of<&Self::_patternInterval>(),
            Property::number("patternWidth", "the width of lines, and of dots their diameter", 0.1, 100.0,
                             "px")
                .of<&Self::_patternWidth>(),
            Property::integer("patternIndex", "each so-manieth line is twice as wide; 0: none is", 0, 31)
                .of<&Self::_patternIndex>(),
            Property::angle("patternAngle", "the direction of hatching, clockwise from the frame's y axis",
                            -osg::PI, osg::PI)
                .of<&Self::_patternAngle>(),
            Property::number("brightness", "the factor of the brightness; 0 is black", 0.0, 4.0)
                .of<&Self::_brightness>(),
            Property::number("contrast", "the factor of the contrast about a middle grey", 0.0, 4.0)
                .of<&Self::_contrast>(),
            Property::number("saturation", "the factor of the saturation; 0 is grey", 0.0, 4.0)
                .of<&Self::_saturation>(),
            Property::angle("hue", "the turn of the hue", -osg::PI, osg::PI).of<&Self::_hue>(),
            Property::number("redFromRed", "how much red becomes red", -100.0, 100.0).of<&Self::_rr>(),
            Property::number("redFromGreen", "how much green becomes red", -100.0, 100.0).of<&Self::_rg>(),
            Property::number("redFromBlue", "how much blue becomes red", -100.0, 100.0).of<&Self::_rb>(),
            Property::number("redAdded", "what is added to red", -100.0, 100.0).of<&Self::_r1>(),
            Property::number("greenFromRed", "how much red becomes green", -100.0, 100.0).of<&Self::_gr>(),
            Property::number("greenFromGreen", "how much green becomes green", -100.0, 100.0)
                .of<&Self::_gg>(),
            Property::number("greenFromBlue", "how much blue becomes green", -100.0, 100.0).of<&Self::_gb>(),
            Property::number("greenAdded", "what is added to green", -100.0, 100.0).of<&Self::_g1>(),
            Property::number("blueFromRed", "how much red becomes blue", -100.0, 100.0).of<&Self::_br>(),
            Property::number("blueFromGreen", "how much green becomes blue", -100.0, 100.0).of<&Self::_bg>(),
            Property::number("blueFromBlue", "how much blue becomes blue", -100.0, 100.0).of<&Self::_bb>(),
            Property::number("blueAdded", "what is added to blue", -100.0, 100.0).of<&Self::_b1>(),
        });
    return all;
}

std::string ColorTransfer::inconsistency() const
{
    return _lowValue < _highValue ? "" : "lowValue must be less than highValue.";
}

bool ColorTransfer::setConstant(const osg::Vec4d& rgba)
{
    return assign(
        {{"constantColor", packedColor({rgba.r(), rgba.g(), rgba.b()})}, {"constantAlpha", rgba.a()}});
}

bool ColorTransfer::setColorMatrix(const Matrix& m)
{
    return assign({{"redFromRed", m[0].x()},
                   {"redFromGreen", m[0].y()},
                   {"redFromBlue", m[0].z()},
                   {"redAdded", m[0].w()},
                   {"greenFromRed", m[1].x()},
                   {"greenFromGreen", m[1].y()},
                   {"greenFromBlue", m[1].z()},
                   {"greenAdded", m[1].w()},
                   {"blueFromRed", m[2].x()},
                   {"blueFromGreen", m[2].y()},
                   {"blueFromBlue", m[2].z()},
                   {"blueAdded", m[2].w()}});
}

ColorTransfer::Matrix ColorTransfer::getColorMatrix() const
{
    return {osg::Vec4d(_rr, _rg, _rb, _r1), osg::Vec4d(_gr, _gg, _gb, _g1), osg::Vec4d(_br, _bg, _bb, _b1)};
}

ColorTransfer::Matrix ColorTransfer::effectiveMatrix() const
{
    Matrix result = getColorMatrix();
    if (_hue != 0.0) result = product(hueTurned(_hue), result);
    if (_saturation != 1.0) result = product(saturated(_saturation), result);
    if (_contrast != 1.0) result = product(scaled(_contrast, 0.5), result);
    if (_brightness != 1.0) result = product(scaled(_brightness, 0.0), result);
    return result;
}

} // namespace osgGeoFX
