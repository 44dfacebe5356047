// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/LayerClock.h>

#include <osgGeoFX/effect/ClockTime.h>
#include <osgGeoFX/mapping/LayerSequence.h>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osg/Notify>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr double most = 1e12; // seconds

/// To the minute.
std::string dateOf(double seconds)
{
    const std::string text = textOf({60.0 * std::floor(seconds / 60.0 + 0.5), 0});
    const std::size_t middle = text.find('T');
    return text.substr(0, middle) + " " + text.substr(middle + 1, 5) + " UTC";
}

} // namespace

LayerClock::LayerClock(const LayerClock& other, const osg::CopyOp& copy) : PropertyHolder(other, copy)
{
    for (const Property& property : LayerClock::properties())
        property.put(*this, property.get(other));
}

LayerClock::~LayerClock() = default;

const Properties& LayerClock::properties() const
{
    using Self = LayerClock;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            Property::number("time", "the time, seconds; since 1970 in UTC, if dated", -most, most)
                .of<&Self::_time>(),
            Property::number("begin", "the first time, seconds", -most, most).of<&Self::_begin>(),
            Property::number("end", "the last time, seconds", -most, most).of<&Self::_end>(),
            Property::flag("playing", "whether the time goes on").of<&Self::_playing>(),
            Property::number("speed",
                             "seconds of the layers in one of the program's; less than 0 goes backwards",
                             -1e9, 1e9)
                .of<&Self::_speed>(),
            Property::flag("loop", "whether it begins again at its end").of<&Self::_loop>(),
            Property::flag("dated", "whether times are seconds since 1970 in UTC").of<&Self::_dated>(),
        });
    return all;
}

std::string LayerClock::inconsistency() const
{
    return _begin > _end ? "begin must not be more than end." : "";
}

double LayerClock::wrapped(double time) const
{
    const double length = _end - _begin;
    if (!_loop || !(length > 0.0)) return std::clamp(time, _begin, _end);
    if (time >= _begin && time <= _end) return time;
    const double rest = std::fmod(time - _begin, length);
    return _begin + (rest < 0.0 ? rest + length : rest);
}

void LayerClock::include(double begin, double end)
{
    const bool first = _begin == 0.0 && _end == 0.0;
    const double time = getTime();
    const bool atBegin = first || time == _begin;
    const double low = first ? begin : std::min(begin, _begin), high = first ? end : std::max(end, _end);
    setRange(low, high);
    setTime(atBegin ? low : time);
}

void LayerClock::advance(double programSeconds)
{
    // At first the program's time 0 is that of the time that was set, so films may begin with any frame.
    if (!_started || _known != revision())
    {
        _anchor = std::clamp(_time, _begin, _end);
        _anchorProgram = _started ? _program : 0.0;
        _known = revision();
        _started = true;
    }
    _time = _playing ? wrapped(_anchor + _speed * (programSeconds - _anchorProgram)) : _anchor;
    if (!_playing) _known = revision() - 1; // it goes on from here
    _program = programSeconds;
}

std::string LayerClock::text(double time) const
{
    if (_dated) return dateOf(time);
    char text[64];
    constexpr double seldom = 120.0, countable = 1e15;
    const bool counts = std::abs(time) < countable;
    const auto seconds = static_cast<long long>(std::floor((counts ? std::abs(time) : 0.0) + 0.5));
    if (!counts || std::abs(time) < seldom)
        std::snprintf(text, sizeof text, "%.4g s", time);
    else
        std::snprintf(text, sizeof text, "%s%lld:%02lld:%02lld", time < 0.0 ? "-" : "", seconds / 3600,
                      seconds / 60 % 60, seconds % 60);
    return text;
}

std::optional<double> LayerClock::parseDate(const std::string& text)
{
    // Data sets leave out zeros and parts of the time, and write zones in several ways. ClockTime takes one.
    int year = 0, month = 0, day = 0, hour = 0, minute = 0, end = 0;
    double second = 0.0;
    if (std::sscanf(text.c_str(), "%4d-%2d-%2d%n", &year, &month, &day, &end) != 3) return std::nullopt;
    std::string rest = text.substr(static_cast<std::size_t>(end));
    if (rest.size() > 1 && (rest[0] == 'T' || rest[0] == ' ') &&
        std::isdigit(static_cast<unsigned char>(rest[1])))
    {
        const char* const time = rest.c_str() + 1;
        int ends[3] = {};
        std::sscanf(time, "%2d%n:%2d%n:%lf%n", &hour, &ends[0], &minute, &ends[1], &second, &ends[2]);
        rest = time + std::max({ends[0], ends[1], ends[2]});
    }
    while (!rest.empty() && rest[0] == ' ')
        rest.erase(0, 1);
    int zoneHours = 0, zoneMinutes = 0, zoneEnd = 0;
    char sign = '+';
    if (rest == "UTC" || rest == "GMT" || rest == "Z") rest.clear();
    if (!rest.empty())
    {
        // +10, +1000, +10:00
        const bool colon = rest.find(':') != std::string::npos;
        const int count = std::sscanf(rest.c_str(), colon ? "%c%2d%n:%2d%n" : "%c%2d%n%2d%n", &sign,
                                      &zoneHours, &zoneEnd, &zoneMinutes, &zoneEnd);
        if (count < 2 || zoneEnd != static_cast<int>(rest.size()) || (sign != '+' && sign != '-'))
            return std::nullopt;
    }
    char whole[80];
    std::snprintf(whole, sizeof whole, "%04d-%02d-%02dT%02d:%02d:%09.6f%c%02d:%02d", year, month, day, hour,
                  minute, second, sign, zoneHours, zoneMinutes);
    const std::optional<ClockTime> time = readClockTime(whole);
    return time ? std::optional<double>(time->time) : std::nullopt;
}

LayerPlayer::LayerPlayer(LayerClock* clock) : _clock(clock ? clock : new LayerClock) {}

LayerPlayer::LayerPlayer(const LayerPlayer& other, const osg::CopyOp& copy)
    : osg::Object(other, copy), osg::Callback(other, copy), _clock(other._clock), _sequences(other._sequences)
{
}

LayerPlayer::~LayerPlayer() = default;

bool LayerPlayer::setClock(LayerClock* clock)
{
    if (!clock) return false;
    _clock = clock;
    for (const osg::ref_ptr<LayerSequence>& sequence : _sequences)
        sequence->setClock(clock);
    return true;
}

LayerPlayer* LayerPlayer::onto(osg::Node& node)
{
    if (LayerPlayer* const known = of(node)) return known;
    const osg::ref_ptr<LayerPlayer> player = new LayerPlayer(nullptr);
    node.addUpdateCallback(player);
    return player;
}

std::string LayerPlayer::faultOf(const LayerSequence& sequence) const
{
    if (_sequences.empty() || _clock->getDated() == sequence.steps().dated()) return {};
    return sequence.steps().dated() ? "its steps have dates, and those of the layers with the same clock "
                                      "have none; show them apart."
                                    : "its steps have no dates, and those of the layers with the same clock "
                                      "do; name its files by dates, "
                                      "or show them apart.";
}

bool LayerPlayer::add(LayerSequence* sequence, double wholeTime)
{
    if (!sequence) return false;
    const std::string fault = faultOf(*sequence);
    if (!fault.empty())
    {
        OSG_WARN << "osgGeoFX: LayerPlayer::add leaves a sequence out: " << fault << std::endl;
        return false;
    }
    const double before = _clock->getEnd() - _clock->getBegin();
    const bool fits = wholeTime > 0.0 && (before == 0.0 || _clock->getSpeed() == before / wholeTime);
    sequence->setClock(_clock);
    _sequences.emplace_back(sequence);
    const double length = _clock->getEnd() - _clock->getBegin();
    if (fits && length > 0.0) _clock->setSpeed(length / wholeTime);
    return true;
}

LayerPlayer* LayerPlayer::of(osg::Node& node)
{
    for (osg::Callback* each = node.getUpdateCallback(); each; each = each->getNestedCallback())
    {
        if (auto* player = dynamic_cast<LayerPlayer*>(each)) return player;
    }
    return nullptr;
}

void LayerPlayer::update(double programSeconds)
{
    _clock->advance(programSeconds);
    const double time = _clock->getTime();
    for (const osg::ref_ptr<LayerSequence>& sequence : _sequences)
        sequence->update();
    for (const Action& action : _actions)
        action(time);
}

bool LayerPlayer::run(osg::Object* object, osg::Object* data)
{
    const auto* visitor = dynamic_cast<osg::NodeVisitor*>(data);
    if (visitor && visitor->getFrameStamp()) update(visitor->getFrameStamp()->getSimulationTime());
    return traverse(object, data);
}

} // namespace osgGeoFX
