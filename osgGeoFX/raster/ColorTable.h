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

/** Colors for numbers: heights, noise levels, classes.

    The table is a list of stops in order of their values. Two stops with the same value are a jump: below the value,
    the color of the first stop applies; at the value and above, the color of the second. Below the first stop and
    above the last one the color stays, except in EXACT. Colors are sRGB-coded, 0…1, with straight alpha. They are
    mixed as they are coded.

    A setter refuses an invalid value: it returns false, prints one warning and keeps the last valid state. The
    thread of the frame loop changes a table between frames. Reading is thread-safe.

    @ingroup raster */
class OSGGEOFX_EXPORT ColorTable : public osg::Object
{
public:
    ColorTable() = default;
    ColorTable(const ColorTable& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, ColorTable);

    /// A value and its color.
    struct Stop
    {
        double value = 0.0;
        osg::Vec4 color;
    };
    using Stops = std::vector<Stop>;

    /// Replaces all stops. They may be in any order; equal values keep theirs. Values must be finite, colors 0…1.
    bool setStops(Stops stops);
    const Stops& getStops() const { return _stops; }
    /// Adds a stop, after those with the same value.
    bool addStop(double value, const osg::Vec4& color);

    /// How the color of a value follows from the stops.
    enum Mode
    {
        LINEAR,  ///< mixed between the two neighbouring stops
        NEAREST, ///< that of the nearest stop; half-way, that of the upper one
        EXACT,   ///< that of a stop with this value as 32-bit float, else transparent; for classes
        STEPS    ///< that of the last stop that is not above the value
    };
    /// LINEAR by default.
    void setMode(Mode mode);
    Mode getMode() const { return _mode; }

    /// The color where the raster has no value (NaN); transparent by default.
    bool setNoDataColor(const osg::Vec4& color);
    const osg::Vec4& getNoDataColor() const { return _noDataColor; }

    /// The color of a value. NaN gives the no-data color. Transparent if the table has no stops.
    osg::Vec4 at(double value) const;

    /// The values of the first and the last stop; 0 and 1 if the table has no stops.
    std::pair<double, double> range() const;

    /** The table from `low` to `high` as texels for the GPU, RGBA. A shader finds the color of a value at

            s = clamp((value − low) / (high − low), 0, 1) · (width − 1)

        In LINEAR it mixes the texels floor(s) and floor(s) + 1 with fract(s), as a linear filter does at (s + ½) /
        width. In the other modes it takes the texel floor(s + ½), as a nearest filter does there. In EXACT, a value
        outside low…high is transparent, and a value less than half a texel beside a stop counts as equal.

        The texels first get the colors at their own values. Then stops are snapped, so that a shader finds the
        color of a stop at its value. In EXACT, NEAREST and STEPS, a stop gets the texel that its value finds. In
        LINEAR, the colors above a jump begin in the texel below it, so the jump blurs over the two texels below its
        value.

        The error in LINEAR away from jumps is ½/255, due to the bytes. At a stop where the slope changes by b, it is
        also at most b / (4 · (width − 1)), where b is in full intensity per low…high: 1/255 with 1024 texels and a b
        of 8. The borders of STEPS and NEAREST are off by at most one texel.

        If high is not above low, or if width is below 2, all texels have the color at low. False if two stops with
        different values between low and high lie less than a texel apart, so that colors are lost. */
    bool row(double low, double high, osg::Vec4ub* texels, int width) const;
    /// The same with 16 bits: 65535 is full intensity, and the error of ½/255 becomes ½/65535.
    bool row(double low, double high, osg::Vec4us* texels, int width) const;

    /// Grows with each change.
    unsigned int revision() const { return _revision; }

    /** Makes a ready table from `low` to `high`. Null for any other name, and if a limit is not finite.
        - "viridis", "magma" and "cividis" have equal steps for the eye. "cividis" also suits people who cannot tell
          red from green.
        - "terrain": sea, lowland, mountains, snow.
        - "greys": black to white.
        - "traffic": green, yellow, red. */
    static osg::ref_ptr<ColorTable> named(const std::string& name, double low = 0.0, double high = 1.0);
    /// The names that named() knows.
    static std::vector<std::string> names();

    /** A plain bar for a legend, RGBA. It runs from `low` on the left to `high` on the right, or from the bottom to
        the top if it is higher than wide. In EXACT, the stops from low to high have fields of equal size. Null if
        `width` or `height`, pixels, is not 1…16384. */
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
