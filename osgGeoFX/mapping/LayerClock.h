// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <osg/Callback>
#include <osg/Node>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

class LayerSequence;

/** The time of layers that change with it: it plays, pauses, goes slower, faster and backwards, and begins again at its end. Any
    number of sequences and simulations may share one.

    Times are seconds: since 1970 in UTC if `dated`, else since anything. A clock that plays goes on with the program's time,
    `speed` times as fast, from where it stood when it was changed last; at first, from the program's time 0. So the frames of a film have the same times, whichever
    of them are drawn.

    Setters refuse values out of range: they return false, warn once and keep the former value.
    @ingroup mapping */
class OSGGEOFX_EXPORT LayerClock : public PropertyHolder
{
public:
    LayerClock() = default;
    LayerClock(const LayerClock& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, LayerClock);

    /// Seconds, ±1e12. A time beyond the range becomes its nearer end in the next frame. Default: 0.
    bool setTime(double seconds) { return assign("time", seconds); }
    double getTime() const { return _time; }
    /// The range of times, seconds, ±1e12. `begin` must not be more than `end`. Default: 0 and 0, no time at all.
    bool setRange(double begin, double end) { return assign({{"begin", begin}, {"end", end}}); }
    double getBegin() const { return _begin; }
    double getEnd() const { return _end; }
    /// Makes the range larger, so that it has these times in it; the first call sets it. A time that was at the former begin
    /// goes to the new one.
    void include(double begin, double end);
    /// Whether the time goes on. Default: true.
    bool setPlaying(bool playing) { return assign("playing", playing ? 1.0 : 0.0); }
    bool getPlaying() const { return _playing; }
    /// Seconds of the layers in one of the program's, ±1e9; less than 0 goes backwards. Default: 1.
    bool setSpeed(double factor) { return assign("speed", factor); }
    double getSpeed() const { return _speed; }
    /// Whether it begins again when it comes to an end of the range; else it stays there. Default: true.
    bool setLoop(bool loop) { return assign("loop", loop ? 1.0 : 0.0); }
    bool getLoop() const { return _loop; }
    /// Whether times are seconds since 1970 in UTC. Default: false.
    bool setDated(bool dated) { return assign("dated", dated ? 1.0 : 0.0); }
    bool getDated() const { return _dated; }

    /// Goes on to a time of the program, seconds, such as osg::FrameStamp's simulation time. Once in a frame, between frames.
    void advance(double programSeconds);
    /// A time for people: "2026-01-12 06:00 UTC", or "90.5 s" and "1:30:00".
    std::string text(double time) const;
    /// Such a date as seconds since 1970: "2026-01-12", "2026-1-12 6:00", "2026-01-12T06:00:00Z", with a zone such as "+10:00" or
    /// without. Nothing for any other text.
    static std::optional<double> parseDate(const std::string& text);

    const Properties& properties() const override;

protected:
    ~LayerClock() override;
    std::string inconsistency() const override;

private:
    double wrapped(double time) const;

    double _time = 0.0;
    double _begin = 0.0;
    double _end = 0.0;
    bool _playing = true;
    double _speed = 1.0;
    bool _loop = true;
    bool _dated = false;

    // The times of both when something was changed last, and the program's now.
    double _anchor = 0.0, _anchorProgram = 0.0, _program = 0.0;
    unsigned int _known = 0; ///< revision
    bool _started = false;
};

/** Drives clocks and what follows them, once in each frame: an update callback of a node, such as the EffectScene.

    @code
    const osg::ref_ptr<osgGeoFX::LayerPlayer> player = new osgGeoFX::LayerPlayer(clock);
    player->add(sequence);
    player->add([&](double time) { flood.setLevel(time); });
    scene->addUpdateCallback(player);
    @endcode
    OSG's files have it with its node: the clock, and the sequences whose steps they can have (LayerSequence), but no actions.
    @ingroup mapping */
class OSGGEOFX_EXPORT LayerPlayer : public osg::Callback
{
public:
    static constexpr double usualTime =
        20.0; ///< seconds that the kit's programs and scene files take for all of a range
    LayerPlayer() : LayerPlayer(nullptr) {}
    /// Null: a clock of its own.
    explicit LayerPlayer(LayerClock* clock);
    /// With the same clock and sequences, and without the actions.
    LayerPlayer(const LayerPlayer& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, LayerPlayer);

    LayerClock* getClock() { return _clock.get(); }
    /// All sequences get it, too. Null is refused: the result is false then.
    bool setClock(LayerClock* clock);
    /** A sequence gets the player's clock. `wholeTime`: the seconds of the program that all of the clock's range takes then,
        unless somebody has set another speed; 0 leaves the speed as it is. False, with a warning, if faultOf() says why. */
    bool add(LayerSequence* sequence, double wholeTime = 0.0);
    /// Why a sequence cannot have the player's clock: times with dates and times without any are no common ones. Empty if it can.
    std::string faultOf(const LayerSequence& sequence) const;
    /// What is done in each frame, with the clock's time.
    using Action = std::function<void(double time)>;
    void add(Action action) { _actions.push_back(std::move(action)); }
    unsigned int getNumSequences() const { return static_cast<unsigned int>(_sequences.size()); }
    LayerSequence* getSequence(unsigned int i) { return _sequences[i].get(); }
    const LayerSequence* getSequence(unsigned int i) const { return _sequences[i].get(); }
    /// The first player among a node's update callbacks; null if there is none.
    static LayerPlayer* of(osg::Node& node);
    /// The same; a new one where there is none.
    static LayerPlayer* onto(osg::Node& node);

    /// Goes on to a time of the program, seconds. The callback does it with the simulation time.
    void update(double programSeconds);
    bool run(osg::Object* object, osg::Object* data) override;

protected:
    ~LayerPlayer() override;

private:
    osg::ref_ptr<LayerClock> _clock;
    std::vector<osg::ref_ptr<LayerSequence>> _sequences;
    std::vector<Action> _actions;
};

} // namespace osgGeoFX
