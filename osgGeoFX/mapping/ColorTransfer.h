// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <osg/Vec4d>

#include <array>

namespace osgGeoFX
{

/** Turns a mapping's raster into colors and blends them with the scene's colors: CM = (f_BS, f_BD, f_CS, f_CD, M_C,
    f_α) of the paper's Section 3.3. The destination f_CD is the scene's color with all lower mappings on it.

    The source color comes from the layer, from the color table at the layer's value, from the scene itself, or it is
    a constant. The color matrix M_C then changes its rgb, and f_α gives its alpha. The blended rgb lies within 0…1,
    and the scene's alpha stays unchanged. The mapping's opacity, fades and soft edges mix the blended color with the
    scene's color, whatever the blend functions are. Where the layer has no data, the scene stays unchanged.

    Setters refuse values out of range: they return false, warn once and keep the former value.
    @ingroup mapping */
class OSGGEOFX_EXPORT ColorTransfer : public PropertyHolder
{
public:
    ColorTransfer() = default;
    ColorTransfer(const ColorTransfer& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, ColorTransfer);

    enum Source
    {
        LAYER,   ///< the layer's color; a layer of values gives a grey from lowValue to highValue
        TABLE,   ///< the color table's color at the layer's value, or at its grey from 0 to 1
        SCENE,   ///< the scene's own color, which the color matrix then changes
        CONSTANT ///< constant rgb; its alpha only serves blend functions, FROM_SOURCE is the layer's or 1
    };
    enum Alpha
    {
        OPAQUE,      ///< alpha is 1, so that only the mapping's opacity counts
        FROM_SOURCE, ///< the alpha of the layer or color table; 1 for SCENE and for values as greys
        FROM_MASK,   ///< the grey of the mask layer, between rampLow and rampHigh
        FROM_RAMP    ///< the layer's value or grey, between rampLow and rampHigh
    };
    /// The blend functions of OpenGL.
    enum Factor
    {
        ZERO,
        ONE,
        SOURCE_COLOR,
        ONE_MINUS_SOURCE_COLOR,
        DESTINATION_COLOR,
        ONE_MINUS_DESTINATION_COLOR,
        SOURCE_ALPHA,
        ONE_MINUS_SOURCE_ALPHA,
        DESTINATION_ALPHA,
        ONE_MINUS_DESTINATION_ALPHA,
        CONSTANT_COLOR,
        ONE_MINUS_CONSTANT_COLOR,
        CONSTANT_ALPHA,
        ONE_MINUS_CONSTANT_ALPHA,
        SOURCE_ALPHA_SATURATE
    };
    /// The first five are OpenGL's blend equations. MULTIPLY, SCREEN and OVERLAY use the source's alpha as their
    /// weight. DISCARD discards a fragment if the source's alpha, times the mapping's opacity and fades, is at least
    /// 0.5. Another geometry can then show in its place.
    enum Equation
    {
        ADD,
        SUBTRACT,
        REVERSE_SUBTRACT,
        MINIMUM,
        MAXIMUM,
        MULTIPLY,
        SCREEN,
        OVERLAY,
        DISCARD
    };

    /// A pattern that is computed for each pixel of the picture, sharp at any distance: the alpha is that of its lines or dots, and 0
    /// between them. It needs no layer; with CONSTANT as the source it has the constant's color.
    enum Pattern
    {
        NONE,
        CONTOURS, ///< lines of equal height above the frame's ellipsoid or plane, metres
        GRATICULE, ///< degrees of longitude and latitude on a globe; on a plane, metres of the terrain's coordinates
        HATCHING, ///< parallel lines, metres apart on the ground
        DOTS      ///< discs at the corners of squares, metres apart on the ground
    };

    /// The origin of the source color. Default: LAYER.
    bool setSource(Source source) { return assign("source", source); }
    Source getSource() const { return static_cast<Source>(_source); }
    /// The origin of the source's alpha. Default: FROM_SOURCE.
    bool setAlpha(Alpha alpha) { return assign("alpha", alpha); }
    Alpha getAlpha() const { return static_cast<Alpha>(_alpha); }
    /// Default: SOURCE_ALPHA and ONE_MINUS_SOURCE_ALPHA. Only ADD, SUBTRACT and REVERSE_SUBTRACT use the two
    /// functions.
    bool setBlendFunction(Factor source, Factor destination)
    {
        return assign({{"sourceFactor", source}, {"destinationFactor", destination}});
    }
    Factor getSourceFactor() const { return static_cast<Factor>(_sourceFactor); }
    Factor getDestinationFactor() const { return static_cast<Factor>(_destinationFactor); }
    /// The blend equation. Default: ADD.
    bool setEquation(Equation equation) { return assign("equation", equation); }
    Equation getEquation() const { return static_cast<Equation>(_equation); }

    /// The layer's values at the two ends of the color table, in the layer's unit, ±9e7. `low` must be less than
    /// `high`. Default: 0 and 1.
    bool setValueRange(double low, double high) { return assign({{"lowValue", low}, {"highValue", high}}); }
    double getLowValue() const { return _lowValue; }
    double getHighValue() const { return _highValue; }
    /// The values or greys at which alpha is 0 and 1, ±9e7. `high` may be less than `low`. Default: 0 and 1.
    bool setRamp(double low, double high) { return assign({{"rampLow", low}, {"rampHigh", high}}); }
    double getRampLow() const { return _rampLow; }
    double getRampHigh() const { return _rampHigh; }
    /// The constant color of the source and of the blend functions: red, green, blue and alpha, 0…1 each. The three
    /// are rounded to eight bits. Default: opaque white.
    bool setConstant(const osg::Vec4d& rgba);
    osg::Vec4d getConstant() const { return {unpackedColor(_constantColor), _constantAlpha}; }

    /// With FROM_MASK there is none. Level ground has no contours, but the noise of floating-point heights on a globe's
    /// sea may have some at 0: ProjectiveMapping::setHeights() leaves the sea out. Mappings with a pattern are never composed beforehand. Default: NONE.
    bool setPattern(Pattern pattern) { return assign("pattern", pattern); }
    Pattern getPattern() const { return static_cast<Pattern>(_pattern); }
    /// From line to line or from dot to dot: metres, or degrees of a graticule on a globe; 1e-4…1e7. Lines that are closer together in the
    /// picture than twice their width fade away. Default: 100.
    bool setPatternInterval(double interval) { return assign("patternInterval", interval); }
    double getPatternInterval() const { return _patternInterval; }
    /// Of lines, and of dots their diameter, pixels, 0.1…100. Default: 1.
    bool setPatternWidth(double pixels) { return assign("patternWidth", pixels); }
    double getPatternWidth() const { return _patternWidth; }
    /// Each so-manieth line is twice as wide, counted from the line at 0, 0…31; 0: none is. Dots have none. Default: 0.
    bool setPatternIndex(int count) { return assign("patternIndex", count); }
    int getPatternIndex() const { return _patternIndex; }
    /// The direction of hatching, radians clockwise from the frame's y axis, −π…π. Default: 0.
    bool setPatternAngle(double radians) { return assign("patternAngle", radians); }
    double getPatternAngle() const { return _patternAngle; }

    /// 0…4, where 0 is black. Default: 1.
    bool setBrightness(double factor) { return assign("brightness", factor); }
    double getBrightness() const { return _brightness; }
    /// 0…4, about a middle grey. Default: 1.
    bool setContrast(double factor) { return assign("contrast", factor); }
    double getContrast() const { return _contrast; }
    /// 0…4, where 0 is grey. Default: 1.
    bool setSaturation(double factor) { return assign("saturation", factor); }
    double getSaturation() const { return _saturation; }
    /// Rotation of the hue, radians, −π…π. Greys and luminance stay unchanged. Default: 0.
    bool setHue(double radians) { return assign("hue", radians); }
    double getHue() const { return _hue; }

    /// The rows give red, green and blue. Each row holds the factors of r, g and b and a constant that is added.
    using Matrix = std::array<osg::Vec4d, 3>;
    /// The program's own matrix. It acts before hue, saturation, contrast and brightness. Components −100…100.
    /// Default: identity.
    bool setColorMatrix(const Matrix& matrix);
    Matrix getColorMatrix() const;
    /// M_C: the product of the color matrix, hue, saturation, contrast and brightness.
    Matrix effectiveMatrix() const;

    const Properties& properties() const override;

protected:
    ~ColorTransfer() override;
    std::string inconsistency() const override;

private:
    int _source = LAYER;
    int _alpha = FROM_SOURCE;
    int _sourceFactor = SOURCE_ALPHA;
    int _destinationFactor = ONE_MINUS_SOURCE_ALPHA;
    int _equation = ADD;
    double _lowValue = 0.0;
    double _highValue = 1.0;
    double _rampLow = 0.0;
    double _rampHigh = 1.0;
    int _constantColor = 0xffffff;
    double _constantAlpha = 1.0;
    int _pattern = NONE;
    double _patternInterval = 100.0;
    double _patternWidth = 1.0;
    int _patternIndex = 0;
    double _patternAngle = 0.0;
    double _brightness = 1.0;
    double _contrast = 1.0;
    double _saturation = 1.0;
    double _hue = 0.0;
    double _rr = 1.0, _rg = 0.0, _rb = 0.0, _r1 = 0.0;
    double _gr = 0.0, _gg = 1.0, _gb = 0.0, _g1 = 0.0;
    double _br = 0.0, _bg = 0.0, _bb = 1.0, _b1 = 0.0;
};

} // namespace osgGeoFX
