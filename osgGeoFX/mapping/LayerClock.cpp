// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/LayerClock.h>

#include <osgGeoFX/mapping/LayerSequence.h>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr double most = 1e12; // seconds
constexpr std::int64_t secondsOfDay = 86400;

/// Days since 1970 of a date of the Gregorian calendar; of its era of 400 years, of 146,097 days each.
std::int64_t daysOf(std::int64_t year, int month, int day)
{
    // Years begin in March, so that the leap day is their last.
    if (month <= 2) --year;
    const std::int64_t era = (year >= 0 ? year : year - 399) / 400;
    const std::int64_t yearOfEra = year - era * 400;
    const std::int64_t dayOfYear = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
    return era * 146097 + yearOfEra * 365 + yearOfEra / 4 - yearOfEra / 100 + dayOfYear - 719468;
}

std::string dateOf(double seconds)
{
    const auto minutes = static_cast<std::int64_t>(std::floor(seconds / 60.0 + 0.5));
    const std::int64_t minutesOfDay = secondsOfDay / 60;
    const std::int64_t days =
        minutes >= 0 ? minutes / minutesOfDay : -((minutesOfDay - 1 - minutes) / minutesOfDay);
    const std::int64_t rest = minutes - days * minutesOfDay;
    const std::int64_t shifted = days + 719468;
    const std::int64_t era = (shifted >= 0 ? shifted : shifted - 146096) / 146097;
    const std::int64_t dayOfEra = shifted - era * 146097;
    const std::int64_t yearOfEra = (dayOfEra - dayOfEra / 1460 + dayOfEra / 36524 - dayOfEra / 146096) / 365;
    const std::int64_t dayOfYear = dayOfEra - (365 * yearOfEra + yearOfEra / 4 - yearOfEra / 100);
    const std::int64_t month = (5 * dayOfYear + 2) / 153;
    const auto day = static_cast<int>(dayOfYear - (153 * month + 2) / 5 + 1);
    const auto civil = static_cast<int>(month < 10 ? month + 3 : month - 9);
    const auto year = static_cast<long>(yearOfEra + era * 400 + (civil <= 2 ? 1 : 0));
    char text[64];
    std::snprintf(text, sizeof text, "%04ld-%02d-%02d %02d:%02d UTC", year, civil, day,
                  static_cast<int>(rest / 60), static_cast<int>(rest % 60));
    return text;
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
    const auto seconds = static_cast<long long>(std::floor(std::abs(time) + 0.5));
    constexpr double seldom = 120.0;
    if (std::abs(time) < seldom)
        std::snprintf(text, sizeof text, "%.4g s", time);
    else
        std::snprintf(text, sizeof text, "%s%lld:%02lld:%02lld", time < 0.0 ? "-" : "", seconds / 3600,
                      seconds / 60 % 60, seconds % 60);
    return text;
}

std::optional<double> LayerClock::parseDate(const std::string& text)
{
    int year = 0, month = 0, day = 0, hour = 0, minute = 0, end = 0;
    double second = 0.0;
    if (std::sscanf(text.c_str(), "%5d-%2d-%2d%n", &year, &month, &day, &end) != 3 || end == 0)
        return std::nullopt;
    std::string rest = text.substr(static_cast<std::size_t>(end));
    if (!rest.empty() && (rest[0] == 'T' || rest[0] == ' '))
    {
        const int count = std::sscanf(rest.c_str() + 1, "%2d:%2d:%lf", &hour, &minute, &second);
        if (count < 1) return std::nullopt;
        const std::size_t tail = rest.find_first_not_of("0123456789:.", 1);
        rest = tail == std::string::npos ? "" : rest.substr(tail);
    }
    if (rest != "" && rest != "Z" && rest != " UTC" && rest != "UTC") return std::nullopt;
    if (month < 1 || month > 12 || day < 1 || day > 31 || hour < 0 || hour > 24 || minute < 0 ||
        minute > 59 || !(second >= 0.0 && second < 61.0))
        return std::nullopt;
    return static_cast<double>(daysOf(year, month, day) * secondsOfDay + hour * 3600 + minute * 60) + second;
}

LayerPlayer::LayerPlayer(LayerClock* clock) : _clock(clock ? clock : new LayerClock) {}

LayerPlayer::~LayerPlayer() = default;

void LayerPlayer::add(LayerSequence* sequence)
{
    if (!sequence) return;
    sequence->setClock(_clock);
    _sequences.emplace_back(sequence);
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
