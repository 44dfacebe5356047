// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>
#include <osg/Object>
#include <osg/Vec4>
#include <osg/Vec4ub>
#include <osg/Vec4us>

#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** Colours for numbers: heights, noise levels, classes.

    The table is a list of stops in order of their values. Two stops with one value are a jump: what is below takes the
    first one's colour, the value itself and what is above the last one's. Below the first stop and above the last, the
    colour stays, except in EXACT. Colours are sRGB-coded, 0…1, with straight alpha, and are mixed as they are coded.

    Setters refuse what makes no sense: they return false, warn once and leave the last good state. Changed by the
    thread of the frame loop between frames; reading is thread-safe. */
class OSGGEOFX_EXPORT ColorTable : public osg::Object
{
public:
    ColorTable() = default;
    ColorTable(const ColorTable& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, ColorTable);

    struct Stop
    {
        double value = 0.0;
        osg::Vec4 color;
    };
    using Stops = std::vector<Stop>;

    /// Stops in any order; of equal values the order counts. Values must be finite, colours within 0…1.
    bool setStops(Stops stops);
    const Stops& getStops() const { return _stops; }
    /// One more; after those with the same value.
    bool addStop(double value, const osg::Vec4& color);

    enum Mode
    {
        LINEAR,  ///< mixed between the stops
        NEAREST, ///< the nearest stop's; half-way the upper one's
        EXACT,   ///< only where the value is a stop's, as 32-bit floats; all else is transparent. For classes
        STEPS    ///< of the last stop that is not above the value
    };
    /// LINEAR by default.
    void setMode(Mode mode);
    Mode getMode() const { return _mode; }

    /// Where the raster has no value (NaN); transparent by default.
    bool setNoDataColor(const osg::Vec4& color);
    const osg::Vec4& getNoDataColor() const { return _noDataColor; }

    /// The colour of a value; transparent where the table has no stops.
    osg::Vec4 at(double value) const;

    /// Values of the first and the last stop; 0 and 1 of a table without.
    std::pair<double, double> range() const;

    /** The table from `low` to `high` as texels for the GPU, RGBA. A shader finds a value's colour at

            s = clamp((value − low) / (high − low), 0, 1) · (width − 1)

        in LINEAR by mixing texels floor(s) and floor(s) + 1 with fract(s) (a linear filter at (s + ½) / width), else
        in texel floor(s + ½) (the nearest one there). In EXACT a value outside low…high is transparent, and one less
        than half a texel beside a stop counts as equal.

        The texels hold the colours at their own values; then the stops are snapped, so that their own values find
        their own colours: in EXACT, NEAREST and STEPS a stop has the texel that its value finds, and in LINEAR what
        is above a jump begins in the texel below it (the jump blurs over the two texels below its value).
        Away from jumps, LINEAR is off by ½/255 for the bytes and at most b / (4 · (width − 1)) at a stop where the
        slope, in full intensity per low…high, changes by b: by 1/255 with 1024 texels and a b of 8. The borders of
        STEPS and NEAREST are off by a texel at most.

        Where high is not above low, all texels have the colour at low. False where two stops with different values
        between low and high lie less than a texel apart, so that colours are lost. */
    bool row(double low, double high, osg::Vec4ub* texels, int width) const;
    /// The same, finer: 65535 is full intensity, and the ½/255 become ½/65535.
    bool row(double low, double high, osg::Vec4us* texels, int width) const;

    /// Grows with each change.
    unsigned int revision() const { return _revision; }

    /** Ready ones, spread evenly over low…high: "viridis", "magma", "cividis" (equal steps for the eye; cividis also
        where red and green look alike), "terrain" (sea, lowland, mountains, snow), "greys" (black to white),
        "traffic" (green, yellow, red). Null for any other name, and where a limit is not finite. */
    static osg::ref_ptr<ColorTable> named(const std::string& name, double low = 0.0, double high = 1.0);
    /// The names that named() knows.
    static std::vector<std::string> names();

    /** A plain bar for a legend, RGBA: from `low` on the left to `high` on the right, or from below to above where the
        bar is higher than wide. In EXACT the stops from low to high have fields of equal size. Null where the size is
        not 1…16384. */
    osg::ref_ptr<osg::Image> legend(double low, double high, int width, int height) const;

protected:
    ~ColorTable() override;

private:
    template<typename Texel>
    bool fillRow(double low, double high, Texel* texels, int width) const;
    template<typename Texel>
    void snapJumps(double low, double high, Texel* texels, int width) const;
    template<typename Texel>
    void snapStops(double low, double high, Texel* texels, int width) const;

    Stops _stops;
    Mode _mode = LINEAR;
    osg::Vec4 _noDataColor;
    unsigned int _revision = 0;
};

} // namespace osgGeoFX
