// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <osg/Vec4d>

#include <array>

namespace osgGeoFX
{

/** How a mapping's raster becomes colour, and how the colour meets the scene's: CM = (f_BS, f_BD, f_CS, f_CD, M_C, f_α)
    of the paper's Section 3.3. The destination f_CD is the scene's colour with the mappings below.

    The source's colour comes from the layer, from the color table at the layer's value, from the scene itself, or is
    constant. The color matrix then changes its rgb, and f_α says its alpha. Blending gives rgb from 0 to 1; the scene's
    alpha stays. Opacity, fades and soft edges of the mapping mix the result with the scene's colour, whatever the
    blend functions are. Where the layer has no data, the scene stays as it is. */
class OSGGEOFX_EXPORT ColorTransfer : public PropertyHolder
{
public:
    ColorTransfer() = default;
    ColorTransfer(const ColorTransfer& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, ColorTransfer);

    enum Source
    {
        LAYER,   ///< the layer's colour; of values a grey from lowValue to highValue
        TABLE,   ///< the color table at the layer's value, or at its grey from 0 to 1
        SCENE,   ///< the scene's own colour, for the color matrix to change
        CONSTANT ///< its alpha is for blend functions; FROM_SOURCE it is the layer's, or 1
    };
    enum Alpha
    {
        OPAQUE,      ///< 1: the mapping's opacity alone
        FROM_SOURCE, ///< of the layer or of the color table; 1 for SCENE and for values
        FROM_MASK,   ///< the grey of the mask layer, between rampLow and rampHigh
        FROM_RAMP    ///< the layer's value or grey, between rampLow and rampHigh
    };
    /// OpenGL's blend functions.
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
    /// OpenGL's blend equations, and three more, whose share is the source's alpha. DISCARD takes away what is covered by
    /// an alpha of at least a half, fragment and all, so that another geometry can stand in its place.
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

    bool setSource(Source source) { return assign("source", source); }
    Source getSource() const { return static_cast<Source>(_source); }
    /// FROM_SOURCE by default.
    bool setAlpha(Alpha alpha) { return assign("alpha", alpha); }
    Alpha getAlpha() const { return static_cast<Alpha>(_alpha); }
    /// SOURCE_ALPHA and ONE_MINUS_SOURCE_ALPHA by default. MINIMUM, MAXIMUM and those behind do not use them.
    bool setBlendFunction(Factor source, Factor destination)
    {
        return assign({{"sourceFactor", source}, {"destinationFactor", destination}});
    }
    Factor getSourceFactor() const { return static_cast<Factor>(_sourceFactor); }
    Factor getDestinationFactor() const { return static_cast<Factor>(_destinationFactor); }
    bool setEquation(Equation equation) { return assign("equation", equation); }
    Equation getEquation() const { return static_cast<Equation>(_equation); }

    /// The values of the layer at the color table's ends, in the layer's unit; the first is the lower one. 0 and 1 by
    /// default.
    bool setValueRange(double low, double high) { return assign({{"lowValue", low}, {"highValue", high}}); }
    double getLowValue() const { return _lowValue; }
    double getHighValue() const { return _highValue; }
    /// The values or greys that alpha is 0 and 1 at; the second may be the lower one. 0 and 1 by default.
    bool setRamp(double low, double high) { return assign({{"rampLow", low}, {"rampHigh", high}}); }
    double getRampLow() const { return _rampLow; }
    double getRampHigh() const { return _rampHigh; }
    /// The constant colour, of the source and of the blend functions, 0…1 each.
    bool setConstant(const osg::Vec4d& rgba);
    osg::Vec4d getConstant() const { return {_red, _green, _blue, _constantAlpha}; }

    /// 0…4, 1 by default; 0 is black.
    bool setBrightness(double factor) { return assign("brightness", factor); }
    double getBrightness() const { return _brightness; }
    /// 0…4 about a middle grey; 1 by default.
    bool setContrast(double factor) { return assign("contrast", factor); }
    double getContrast() const { return _contrast; }
    /// 0, which is grey, …4; 1 by default.
    bool setSaturation(double factor) { return assign("saturation", factor); }
    double getSaturation() const { return _saturation; }
    /// Turn of the hue, radians, −π…π; 0 by default. Greys and their brightness stay.
    bool setHue(double radians) { return assign("hue", radians); }
    double getHue() const { return _hue; }

    /// Rows of red, green and blue: factors of r, g and b, and what is added.
    using Matrix = std::array<osg::Vec4d, 3>;
    /// A matrix of one's own; it acts first, before hue, saturation, contrast and brightness. Components −100…100.
    bool setColorMatrix(const Matrix& matrix);
    Matrix getColorMatrix() const;
    /// All of these in one: M_C.
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
    double _red = 1.0, _green = 1.0, _blue = 1.0, _constantAlpha = 1.0;
    double _brightness = 1.0;
    double _contrast = 1.0;
    double _saturation = 1.0;
    double _hue = 0.0;
    double _rr = 1.0, _rg = 0.0, _rb = 0.0, _r1 = 0.0;
    double _gr = 0.0, _gg = 1.0, _gb = 0.0, _g1 = 0.0;
    double _br = 0.0, _bg = 0.0, _bb = 1.0, _b1 = 0.0;
};

} // namespace osgGeoFX
