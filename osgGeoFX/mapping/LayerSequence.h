// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/DataLayer.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/LayerSource.h>

#include <osg/Image>
#include <osg/Referenced>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The steps of a sequence: rasters of one size and format, each with its time. `geodata/SequenceRaster` makes one of files, of
    bands, or of the time of a data set of several dimensions; a program may have its own.
    @ingroup mapping */
class OSGGEOFX_EXPORT SequenceSteps : public osg::Referenced
{
public:
    SequenceSteps();

    /// Seconds, as a LayerClock has them, in rising order. Never empty, and always the same.
    virtual const std::vector<double>& times() const = 0;
    virtual bool dated() const { return false; } ///< LayerClock::getDated()
    virtual DataLayer::Kind kind() const = 0;
    /// The picture of a step. Null, with a sentence in `error`, if it cannot be read. One thread at a time calls it, any.
    virtual osg::ref_ptr<osg::Image> read(std::size_t step, std::string& error) = 0;
    /// The same for several threads at once: each one waits for its turn, in the order in which they have come.
    osg::ref_ptr<osg::Image> readInTurn(std::size_t step, std::string& error);
    /// The file that they are read from, for OSG's files; nothing for steps that no file tells, which is the default.
    virtual std::optional<LayerSource> source() const { return std::nullopt; }

protected:
    ~SequenceSteps() override;

private:
    struct Turns;
    std::unique_ptr<Turns> _turns;
};

/** Steps whose pictures are in memory.
    @ingroup mapping */
class OSGGEOFX_EXPORT ImageSteps : public SequenceSteps
{
public:
    /// `times` are as many as images, in rising order, else the steps are 0, 1, 2 … Without images there is one step, which
    /// cannot be read.
    ImageSteps(std::vector<osg::ref_ptr<osg::Image>> images, std::vector<double> times, DataLayer::Kind kind,
               bool dated = false);

    const std::vector<double>& times() const override { return _times; }
    bool dated() const override { return _dated; }
    DataLayer::Kind kind() const override { return _kind; }
    osg::ref_ptr<osg::Image> read(std::size_t step, std::string& error) override;
    /// The image of a step; may be null.
    const osg::Image* getImage(std::size_t step) const { return _images[step].get(); }

protected:
    ~ImageSteps() override;

private:
    std::vector<osg::ref_ptr<osg::Image>> _images;
    std::vector<double> _times;
    DataLayer::Kind _kind;
    bool _dated;
};

/** A layer that changes in time: a forecast, a simulation's output, satellite images. Its layer has the picture of its clock's
    time, blended between the two steps around it; mappings show it as any other layer.

    @code
    const osg::ref_ptr<osgGeoFX::LayerSequence> rain = new osgGeoFX::LayerSequence(steps);
    mapping->setLayer(rain->getLayer());
    player->add(rain); // a LayerPlayer, whose clock it follows
    @endcode

    Values are blended as numbers, and colors weighted by their alpha. Where one of the steps has no data, the nearer step
    counts. Classes change in the middle between steps. Before the first step and after the last one, these two are shown.

    A few steps are in memory: those around the time, and those that come next, which a thread of its own reads. If a step is
    not there yet, the last picture stays. A step that cannot be read, or has another size or format than the first one, is said
    once and shows the nearest one before it that can; without any, the first one that can. OSG's files have a sequence with its player,
    if its steps are ImageSteps or have a source(), which is opened again when they are read; of others they have the layer with its present picture alone.
    @ingroup mapping */
class OSGGEOFX_EXPORT LayerSequence : public osg::Referenced
{
public:
    /// `steps` must not be null. `layer`: the one that it writes, whose image it replaces; null for one of its own.
    explicit LayerSequence(SequenceSteps* steps, DataLayer* layer = nullptr);

    SequenceSteps& steps() { return *_steps; }
    const SequenceSteps& steps() const { return *_steps; }
    /// The layer that it writes. Never null; always the same.
    DataLayer* getLayer() { return _layer.get(); }
    /// The clock gets the range of the steps' times, too. Null is refused with a warning. Default: one of its own.
    void setClock(LayerClock* clock);
    LayerClock* getClock() { return _clock.get(); }
    /// Whether it blends between steps; else a step stays until the next one. Default: true.
    void setBlending(bool on) { _blending = on; }
    bool getBlending() const { return _blending; }
    /// Whether update() waits for the steps that it needs, as for films. Default: false.
    void setWaiting(bool on) { _waiting = on; }
    bool getWaiting() const { return _waiting; }

    /// Makes the layer's picture that of the clock's time; between frames. False if a step is not there yet.
    bool update();
    /// Whether the layer had all that the last update() needed.
    bool settled() const { return _settled; }
    /// Of a time: the step at or before it, and the share of the next one, 0…1.
    struct Moment
    {
        std::size_t step = 0;
        double share = 0.0;
    };
    Moment momentOf(double time) const;
    /// The most that is wrong with the steps so far; empty if nothing is.
    std::string fault() const;

protected:
    ~LayerSequence() override;

private:
    class Reader;
    std::optional<Moment> readable(Moment moment) const;
    void show(const osg::Image& first, const osg::Image* second, double share);

    osg::ref_ptr<SequenceSteps> _steps;
    osg::ref_ptr<LayerClock> _clock;
    osg::ref_ptr<DataLayer> _layer;
    std::unique_ptr<Reader> _reader;
    bool _blending = true;
    bool _waiting = false;
    bool _settled = false;
    std::optional<Moment> _shown;
};

} // namespace osgGeoFX
