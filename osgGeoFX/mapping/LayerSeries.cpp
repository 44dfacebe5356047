// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/LayerSeries.h>

#include <osgGeoFX/batch/WholeFile.h>
#include <osgGeoFX/effect/ClockTime.h>
#include <osgGeoFX/mapping/detail/LayerSample.h>

#include <array>
#include <charconv>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// As short as it can be without a loss, whatever the locale.
template<typename Number>
std::string numberText(Number number)
{
    std::array<char, 64> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
}

std::string fieldOf(const std::string& text)
{
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text)
        quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    return quoted + "\"";
}

/// "2026-01-12T06:00:00Z", to a second.
std::string dateOf(double seconds)
{
    return textOf(ClockTime{std::floor(seconds + 0.5), 0});
}

} // namespace

/// Reads the steps of a place on a thread of its own.
class LayerSeries::Reader
{
public:
    explicit Reader(LayerSequence& sequence)
        : _steps(&sequence.steps()), _how(LayerSample::How::of(*sequence.getLayer())),
          _thread([this] { work(); })
    {
    }
    ~Reader()
    {
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            _over = true;
            ++_turn;
        }
        _news.notify_all();
        _thread.join();
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    void ask(const std::optional<osg::Vec2d>& place)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        ++_turn;
        ++_revision;
        _place = place;
        _known = 0;
        _fault.clear();
        _points.assign(place ? _steps->times().size() : 0, Point());
        for (std::size_t i = 0; i < _points.size(); ++i)
            _points[i].time = _steps->times()[i];
        _news.notify_all();
    }
    std::vector<Point> points() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _points;
    }
    bool finished() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _known == _points.size();
    }
    void wait() const
    {
        std::unique_lock<std::mutex> lock(_mutex);
        _news.wait(lock, [this] { return _known == _points.size(); });
    }
    unsigned int revision() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _revision;
    }
    std::string fault() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _fault;
    }

private:
    Point read(std::size_t step, const osg::Vec2d& place, std::string& error) const
    {
        Point point;
        point.time = _steps->times()[step];
        point.known = true;
        const osg::ref_ptr<osg::Image> image = _steps->readInTurn(step, error);
        if (!image) return point;
        const std::optional<LayerSample> found = LayerSample::read(*image, _how, place);
        if (!found || found->cover <= 0.0) return point;
        if (_how.kind == DataLayer::COLOR)
            point.color = found->color;
        else
            point.value = found->value;
        return point;
    }

    void work()
    {
        std::unique_lock<std::mutex> lock(_mutex);
        for (;;)
        {
            _news.wait(lock, [this] { return _over || (_place && _known < _points.size()); });
            if (_over) return;
            const std::uint64_t turn = _turn;
            const std::size_t step = _known;
            const osg::Vec2d place = *_place;
            lock.unlock();
            std::string error;
            const Point point = read(step, place, error);
            lock.lock();
            // Somebody has asked for another place meanwhile.
            if (turn != _turn) continue;
            _points[step] = point;
            ++_known;
            ++_revision;
            if (!error.empty() && _fault.empty()) _fault = error;
            _news.notify_all();
        }
    }

    const osg::ref_ptr<SequenceSteps> _steps;
    const LayerSample::How _how;
    mutable std::mutex _mutex;
    mutable std::condition_variable _news;
    bool _over = false;
    std::uint64_t _turn = 0;
    unsigned int _revision = 0;
    std::optional<osg::Vec2d> _place;
    std::vector<Point> _points;
    std::size_t _known = 0; ///< the points before it are
    std::string _fault;
    std::thread _thread; ///< the last, since it uses the others
};

LayerSeries::LayerSeries(LayerSequence& sequence)
    : _sequence(&sequence), _reader(std::make_unique<Reader>(sequence))
{
}

LayerSeries::~LayerSeries() = default;

void LayerSeries::setPlace(const std::optional<osg::Vec2d>& raster)
{
    _place = raster;
    _reader->ask(raster);
}

std::vector<LayerSeries::Point> LayerSeries::points() const
{
    return _reader->points();
}

bool LayerSeries::finished() const
{
    return _reader->finished();
}

void LayerSeries::wait() const
{
    _reader->wait();
}

unsigned int LayerSeries::revision() const
{
    return _reader->revision();
}

std::string LayerSeries::fault() const
{
    return _reader->fault();
}

std::string LayerSeries::csv(const std::string& name, const std::string& unit) const
{
    const bool dated = _sequence->steps().dated();
    const bool colors = _sequence->steps().kind() == DataLayer::COLOR;
    std::string table = dated ? "time" : "time (s)";
    if (colors)
        table += ",red,green,blue,alpha";
    else
        table += "," + fieldOf(unit.empty() ? name : name + " (" + unit + ")");
    table += "\n";
    for (const Point& point : points())
    {
        table += dated ? dateOf(point.time) : numberText(point.time);
        if (!colors)
            // Of floats, so their digits are enough.
            table += "," + (point.value ? numberText(static_cast<float>(*point.value)) : "");
        for (unsigned int i = 0; colors && i < 4; ++i)
            table += "," + (point.color ? numberText(std::lround(255.0 * (*point.color)[i])) : "");
        table += "\n";
    }
    return table;
}

bool LayerSeries::writeCsv(const std::string& file, const std::string& name, const std::string& unit,
                           std::string& error) const
{
    const std::string table = csv(name, unit);
    const int fault = writeWholeFile(file, table.data(), table.size());
    if (fault == 0) return true;
    error = file + ": it cannot be written (" + std::strerror(fault) +
            "); name a file in a folder that is there.";
    return false;
}

} // namespace osgGeoFX
