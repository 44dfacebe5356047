// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/LayerSequence.h>

#include <osg/Referenced>
#include <osg/Vec2d>
#include <osg/Vec4d>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** What a sequence has at one place, over all of its steps: for a plot, or a table.

    A thread of its own reads the steps in their order, beside the sequence, which goes on. So no frame waits; points() tells what is known
    so far. Another place, or none, stops what is under way after the step that is being read.

    @code
    osgGeoFX::LayerSeries series(*reading.sequence);  // a LayerReading
    series.setPlace(reading.raster);
    series.wait();
    std::cout << series.csv("rain", "mm");
    @endcode
    One thread at a time uses an object. The destructor waits for the step that is being read.
    @ingroup mapping */
class OSGGEOFX_EXPORT LayerSeries : public osg::Referenced
{
public:
    explicit LayerSeries(LayerSequence& sequence);

    LayerSequence& sequence() { return *_sequence; }
    const LayerSequence& sequence() const { return *_sequence; }

    /// Begins to read a place anew; raster coordinates, 0…1 from the lower left corner, as in LayerReading. Nothing: no place.
    void setPlace(const std::optional<osg::Vec2d>& raster);
    std::optional<osg::Vec2d> getPlace() const { return _place; }

    struct Point
    {
        double time = 0.0;  ///< of the step, as the clock has it
        bool known = false; ///< it has been read, or cannot be
        /// Of values and classes; nothing where there is no data, and where the step cannot be read.
        std::optional<double> value;
        std::optional<osg::Vec4d> color; ///< of colors, sRGB-coded, 0…1, straight alpha
    };
    /// As many as steps, in their order; none without a place.
    std::vector<Point> points() const;
    /// Whether all points are known.
    bool finished() const;
    /// Until all are known.
    void wait() const;
    /// Grows with each point that becomes known, and with each new place.
    unsigned int revision() const;
    /// What is wrong with the first step that cannot be read; empty if nothing is.
    std::string fault() const;

    /** A table for other programs, UTF-8 (RFC 4180 with lines that end in \\n): the time ("2026-01-12T06:00:00Z" if the sequence is
        dated, else seconds) and the value, or red, green, blue and alpha in bytes. A field is empty where there is no data. `name` and
        `unit` stand in the first line, "rain (mm)". */
    std::string csv(const std::string& name, const std::string& unit) const;
    /// Writes it. False, with a sentence in `error`, if it cannot; a former file stays as it was then.
    bool writeCsv(const std::string& file, const std::string& name, const std::string& unit,
                  std::string& error) const;

protected:
    ~LayerSeries() override;

private:
    class Reader;
    osg::ref_ptr<LayerSequence> _sequence;
    std::optional<osg::Vec2d> _place;
    std::unique_ptr<Reader> _reader;
};

} // namespace osgGeoFX
