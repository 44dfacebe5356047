// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/LayerSequence.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Steps in memory: those around the time, and some that come next.
constexpr std::size_t ahead = 4;

std::string formatOf(const osg::Image& image)
{
    return std::to_string(image.s()) + " x " + std::to_string(image.t()) + " pixels of format " +
           std::to_string(image.getPixelFormat()) + " and type " + std::to_string(image.getDataType());
}

bool isAlike(const osg::Image& a, const osg::Image& b)
{
    return a.s() == b.s() && a.t() == b.t() && a.getPixelFormat() == b.getPixelFormat() &&
           a.getDataType() == b.getDataType() && a.getRowSizeInBytes() == b.getRowSizeInBytes();
}

void blendFloats(const float* a, const float* b, float share, std::size_t count, float* out)
{
    for (std::size_t i = 0; i < count; ++i)
    {
        const float mean = a[i] + (b[i] - a[i]) * share;
        // NaN where one of both is.
        out[i] = std::isfinite(mean) ? mean : share < 0.5f ? a[i] : b[i];
    }
}

void blendBytes(const unsigned char* a, const unsigned char* b, int share, std::size_t count,
                unsigned char* out)
{
    for (std::size_t i = 0; i < count; ++i)
        out[i] = static_cast<unsigned char>((a[i] * (256 - share) + b[i] * share + 128) >> 8);
}

/// A transparent color counts for nothing.
void blendColors(const unsigned char* a, const unsigned char* b, int share, std::size_t count,
                 unsigned char* out)
{
    for (std::size_t i = 0; i < count; ++i, a += 4, b += 4, out += 4)
    {
        const int first = a[3] * (256 - share), second = b[3] * share, sum = first + second;
        for (int channel = 0; channel < 3; ++channel)
            out[channel] =
                sum == 0
                    ? a[channel]
                    : static_cast<unsigned char>((a[channel] * first + b[channel] * second + sum / 2) / sum);
        out[3] = static_cast<unsigned char>((sum + 128) >> 8);
    }
}

} // namespace

struct SequenceSteps::Turns
{
    std::mutex mutex;
    std::condition_variable news;
    std::uint64_t next = 0, now = 0;
};

SequenceSteps::SequenceSteps() : _turns(std::make_unique<Turns>()) {}
SequenceSteps::~SequenceSteps() = default;

osg::ref_ptr<osg::Image> SequenceSteps::readInTurn(std::size_t step, std::string& error)
{
    {
        std::unique_lock<std::mutex> lock(_turns->mutex);
        const std::uint64_t own = _turns->next++;
        _turns->news.wait(lock, [&] { return _turns->now == own; });
    }
    osg::ref_ptr<osg::Image> image = read(step, error);
    const std::lock_guard<std::mutex> lock(_turns->mutex);
    ++_turns->now;
    _turns->news.notify_all();
    return image;
}

ImageSteps::ImageSteps(std::vector<osg::ref_ptr<osg::Image>> images, std::vector<double> times,
                       DataLayer::Kind kind, bool dated)
    : _images(std::move(images)), _times(std::move(times)), _kind(kind), _dated(dated)
{
    _images.resize(std::max<std::size_t>(_images.size(), 1));
    if (_times.size() == _images.size() && std::is_sorted(_times.begin(), _times.end())) return;
    if (!_times.empty())
        OSG_WARN << "osgGeoFX: ImageSteps got " << _times.size() << " times for " << _images.size()
                 << " images, or times that fall; the steps are 0, 1, 2 …" << std::endl;
    _times.resize(_images.size());
    for (std::size_t i = 0; i < _times.size(); ++i)
        _times[i] = static_cast<double>(i);
}

ImageSteps::~ImageSteps() = default;

osg::ref_ptr<osg::Image> ImageSteps::read(std::size_t step, std::string& error)
{
    if (step < _images.size() && _images[step]) return _images[step];
    error = "Step " + std::to_string(step) + " has no image.";
    return nullptr;
}

/// Reads steps on a thread of its own.
class LayerSequence::Reader
{
public:
    explicit Reader(SequenceSteps& steps) : _steps(steps), _thread([this] { work(); }) {}
    ~Reader()
    {
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            _over = true;
        }
        _news.notify_all();
        _thread.join();
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    /// From now on these are in memory, the first ones first, and no others.
    void want(const std::vector<std::size_t>& steps)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _wanted = std::set<std::size_t>(steps.begin(), steps.end());
        for (auto each = _images.begin(); each != _images.end();)
            each = _wanted.count(each->first) > 0 ? std::next(each) : _images.erase(each);
        _queue.clear();
        for (auto step = steps.rbegin(); step != steps.rend(); ++step)
        {
            const bool known = _images.count(*step) > 0 || _failed.count(*step) > 0 || _reading == *step;
            if (!known) _queue.push_back(*step);
        }
        _news.notify_all();
    }
    /// Null if it is not there; `known` tells whether that is for good.
    osg::ref_ptr<osg::Image> find(std::size_t step, bool waits, bool& known)
    {
        std::unique_lock<std::mutex> lock(_mutex);
        const auto isKnown = [&]
        {
            return _images.count(step) > 0 || _failed.count(step) > 0;
        };
        if (waits) _news.wait(lock, isKnown);
        known = isKnown();
        const auto found = _images.find(step);
        return found != _images.end() ? found->second : nullptr;
    }
    bool hasFailed(std::size_t step) const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _failed.count(step) > 0;
    }
    std::string fault() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _fault;
    }

private:
    void work()
    {
        std::unique_lock<std::mutex> lock(_mutex);
        for (;;)
        {
            _news.wait(lock, [this] { return _over || !_queue.empty(); });
            if (_over) return;
            const std::size_t step = _queue.back();
            _queue.pop_back();
            _reading = step;
            lock.unlock();
            std::string error;
            osg::ref_ptr<osg::Image> image = _steps.readInTurn(step, error);
            if (image && _first && !isAlike(*image, *_first))
            {
                error = "step " + std::to_string(step) + " of the sequence has " + formatOf(*image) +
                        ", and others have " + formatOf(*_first) + "; make them alike.";
                image = nullptr;
            }
            if (image && !_first) _first = new osg::Image(*image, osg::CopyOp::SHALLOW_COPY);
            lock.lock();
            _reading.reset();
            if (image && _wanted.count(step) > 0) _images[step] = image;
            if (!image)
            {
                _failed.insert(step);
                if (_fault.empty()) OSG_WARN << "osgGeoFX: LayerSequence: " << error << std::endl;
                if (_fault.empty()) _fault = error;
            }
            _news.notify_all();
        }
    }

    SequenceSteps& _steps;
    osg::ref_ptr<osg::Image> _first; ///< whose format all have; the thread's own
    mutable std::mutex _mutex;
    std::condition_variable _news;
    bool _over = false;
    std::set<std::size_t> _wanted;
    std::vector<std::size_t> _queue; ///< the next one last
    std::optional<std::size_t> _reading;
    std::map<std::size_t, osg::ref_ptr<osg::Image>> _images;
    std::set<std::size_t> _failed;
    std::string _fault;
    std::thread _thread; ///< the last, since it uses the others
};

LayerSequence::LayerSequence(SequenceSteps* steps, DataLayer* layer)
    : _steps(steps), _layer(layer ? layer : new DataLayer), _reader(std::make_unique<Reader>(*steps))
{
    _layer->setImage(new osg::Image);
    _layer->setKind(steps->kind());
    setClock(new LayerClock);
}

LayerSequence::~LayerSequence() = default;

void LayerSequence::setClock(LayerClock* clock)
{
    if (!clock)
    {
        OSG_WARN << "osgGeoFX: LayerSequence::setClock got no clock; the former one stays." << std::endl;
        return;
    }
    if (_clock == clock) return;
    _clock = clock;
    clock->setDated(_steps->dated());
    clock->include(_steps->times().front(), _steps->times().back());
}

LayerSequence::Moment LayerSequence::momentOf(double time) const
{
    const std::vector<double>& times = _steps->times();
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    if (after == times.begin()) return {};
    const auto step = static_cast<std::size_t>(after - times.begin()) - 1;
    if (after == times.end()) return {step, 0.0};
    return {step, (time - times[step]) / (times[step + 1] - times[step])};
}

std::string LayerSequence::fault() const
{
    return _reader->fault();
}

/// The moment that is shown for one, as far as it is known which steps cannot be read; nothing if none can.
std::optional<LayerSequence::Moment> LayerSequence::readable(Moment moment) const
{
    const std::size_t count = _steps->times().size();
    if (moment.share > 0.0 && _reader->hasFailed(moment.step + 1)) moment.share = 0.0;
    if (!_reader->hasFailed(moment.step)) return moment;
    for (std::size_t step = moment.step; step-- > 0;)
        if (!_reader->hasFailed(step)) return Moment{step, 0.0};
    for (std::size_t step = moment.step + 1; step < count; ++step)
        if (!_reader->hasFailed(step)) return Moment{step, 0.0};
    return std::nullopt;
}

bool LayerSequence::update()
{
    Moment asked = momentOf(_clock->getTime());
    const std::size_t count = _steps->times().size();
    const bool classes = _steps->kind() == DataLayer::CLASS;
    if (!_blending) asked.share = 0.0;
    if (classes && asked.share >= 0.5) ++asked.step;
    if (classes) asked.share = 0.0;

    // Each turn but the last one finds a step that cannot be read.
    while (const std::optional<Moment> moment = readable(asked))
    {
        std::vector<std::size_t> wanted = {moment->step};
        if (moment->share > 0.0) wanted.push_back(moment->step + 1);
        const bool backwards = _clock->getSpeed() < 0.0;
        for (std::size_t i = 1; i <= std::min(ahead, count - 1); ++i)
        {
            const std::size_t next = (asked.step + (backwards ? count - i : i)) % count;
            if (std::find(wanted.begin(), wanted.end(), next) == wanted.end()) wanted.push_back(next);
        }
        _reader->want(wanted);

        bool known = false, secondKnown = true;
        const osg::ref_ptr<osg::Image> first = _reader->find(moment->step, _waiting, known);
        osg::ref_ptr<osg::Image> second;
        if (moment->share > 0.0) second = _reader->find(moment->step + 1, _waiting, secondKnown);
        _settled = known && secondKnown;
        if (!_settled) return false;
        if (!first || (moment->share > 0.0 && !second)) continue;
        if (_shown && _shown->step == moment->step && _shown->share == moment->share) return true;
        _shown = moment;
        show(*first, second, moment->share);
        return true;
    }
    _settled = true;
    return true;
}

void LayerSequence::show(const osg::Image& first, const osg::Image* second, double share)
{
    osg::Image& image = *_layer->getImage();
    const bool fresh = !isAlike(image, first);
    if (fresh)
    {
        image.allocateImage(first.s(), first.t(), 1, first.getPixelFormat(), first.getDataType(),
                            static_cast<int>(first.getPacking()));
        image.setInternalTextureFormat(first.getInternalTextureFormat());
        image.setFileName(first.getFileName());
    }
    const std::size_t bytes = first.getTotalSizeInBytes();
    const bool floats = first.getDataType() == GL_FLOAT;
    const bool blends = second && (floats || first.getDataType() == GL_UNSIGNED_BYTE);
    if (!blends)
        std::memcpy(image.data(), (second && share >= 0.5 ? *second : first).data(), bytes);
    else if (floats)
        blendFloats(reinterpret_cast<const float*>(first.data()),
                    reinterpret_cast<const float*>(second->data()), static_cast<float>(share),
                    bytes / sizeof(float), reinterpret_cast<float*>(image.data()));
    else if (first.getPixelFormat() == GL_RGBA)
        blendColors(first.data(), second->data(), static_cast<int>(std::lround(256.0 * share)), bytes / 4,
                    image.data());
    else
        blendBytes(first.data(), second->data(), static_cast<int>(std::lround(256.0 * share)), bytes,
                   image.data());
    image.dirty();
}

} // namespace osgGeoFX
