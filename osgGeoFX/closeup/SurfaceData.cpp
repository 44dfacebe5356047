// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/SurfaceData.h>

#include <osgGeoFX/closeup/SurfaceDerivation.h>

#include <osg/Notify>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

namespace osgGeoFX
{

namespace
{

constexpr int mostTexels = 16384;

bool isLayer(const osg::Image* image)
{
    return image && image->data() && image->s() >= 1 && image->s() <= mostTexels && image->t() >= 1 &&
           image->t() <= mostTexels && image->r() == 1 && image->getPixelFormat() == GL_RGBA &&
           image->getDataType() == GL_FLOAT && image->getOrigin() != osg::Image::TOP_LEFT &&
           image->getRowStepInBytes() == 16u * static_cast<unsigned int>(image->s());
}

constexpr int none = -1; // a channel that the image lacks
constexpr int full = -2;

/// Where a pixel has red, green, blue and alpha.
struct Channels
{
    GLenum format;
    std::array<int, 4> at;
};

constexpr Channels knownChannels[] = {
    {GL_RGB, {0, 1, 2, full}},    {GL_RGBA, {0, 1, 2, 3}},           {GL_BGR, {2, 1, 0, full}},
    {GL_BGRA, {2, 1, 0, 3}},      {GL_LUMINANCE, {0, 0, 0, full}},   {GL_LUMINANCE_ALPHA, {0, 0, 0, 1}},
    {GL_INTENSITY, {0, 0, 0, 0}}, {GL_ALPHA, {full, full, full, 0}}, {GL_RED, {0, none, none, full}},
    {GL_RG, {0, 1, none, full}},
};

template<typename T>
float shareAt(const unsigned char* pixel, int index)
{
    constexpr double one =
        std::numeric_limits<T>::is_integer ? static_cast<double>(std::numeric_limits<T>::max()) : 1.0;
    T number;
    std::copy_n(pixel + static_cast<std::size_t>(index) * sizeof(T), sizeof(T),
                reinterpret_cast<unsigned char*>(&number));
    const double share = static_cast<double>(number) / one;
    // This way round NaN is 0.
    return share > 0.0 ? static_cast<float>(std::min(share, 1.0)) : 0.0f;
}

struct Type
{
    GLenum type;
    float (*shareAt)(const unsigned char*, int);
};

constexpr Type knownTypes[] = {
    {GL_UNSIGNED_BYTE, shareAt<GLubyte>},   {GL_BYTE, shareAt<GLbyte>},
    {GL_UNSIGNED_SHORT, shareAt<GLushort>}, {GL_SHORT, shareAt<GLshort>},
    {GL_UNSIGNED_INT, shareAt<GLuint>},     {GL_INT, shareAt<GLint>},
    {GL_FLOAT, shareAt<GLfloat>},
};

/// Neighbours in a row or column of which one texel is made, and their shares in it.
struct Mix
{
    int first;
    std::vector<float> shares;
};

std::vector<Mix> mixesOf(int source, int target)
{
    std::vector<Mix> mixes;
    mixes.reserve(static_cast<std::size_t>(target));
    const double step = static_cast<double>(source) / target;
    for (int i = 0; i < target; ++i)
    {
        // A tent as wide as a texel of the source or of the target, whichever is larger.
        const double middle = (i + 0.5) * step - 0.5;
        const double reach = std::max(1.0, step);
        Mix mix{static_cast<int>(std::ceil(middle - reach)), {}};
        double sum = 0.0;
        std::vector<double> weights;
        for (int k = mix.first; k <= middle + reach; ++k)
        {
            weights.push_back(k < 0 || k >= source ? 0.0 : std::max(0.0, reach - std::abs(k - middle)));
            sum += weights.back();
        }
        for (const double weight : weights)
            mix.shares.push_back(static_cast<float>(weight / sum));
        mixes.push_back(std::move(mix));
    }
    return mixes;
}

/// Along x; along y with the two steps exchanged. Colors are multiplied with their alpha.
void mix(const std::vector<Mix>& mixes, const float* from, std::size_t fromStep, float* to,
         std::size_t toStep)
{
    for (std::size_t i = 0; i < mixes.size(); ++i)
    {
        std::array<float, 4> sum{};
        for (std::size_t k = 0; k < mixes[i].shares.size(); ++k)
        {
            const float share = mixes[i].shares[k];
            // Those beyond the borders have no share, nor a place.
            if (share == 0.0f) continue;
            const float* texel = from + (static_cast<std::size_t>(mixes[i].first) + k) * fromStep;
            for (std::size_t channel = 0; channel < 4; ++channel)
                sum[channel] += share * texel[channel];
        }
        std::copy(sum.begin(), sum.end(), to + i * toStep);
    }
}

osg::ref_ptr<osg::Image> resampled(const osg::Image& image, int width, int height)
{
    const auto sourceWidth = static_cast<std::size_t>(image.s());
    const auto sourceHeight = static_cast<std::size_t>(image.t());
    const auto columns = static_cast<std::size_t>(width);
    const auto* data = reinterpret_cast<const float*>(image.data());
    std::vector<float> weighted(data, data + 4 * sourceWidth * sourceHeight);
    for (std::size_t i = 0; i < weighted.size(); ++i)
        if (i % 4 != 3) weighted[i] *= weighted[i / 4 * 4 + 3];

    const std::vector<Mix> alongX = mixesOf(image.s(), width);
    std::vector<float> narrowed(4 * columns * sourceHeight);
    for (std::size_t y = 0; y < sourceHeight; ++y)
        mix(alongX, &weighted[4 * sourceWidth * y], 4, &narrowed[4 * columns * y], 4);

    osg::ref_ptr<osg::Image> result = SurfaceDerivation::emptyLayer(width, height);
    auto* out = reinterpret_cast<float*>(result->data());
    const std::vector<Mix> alongY = mixesOf(image.t(), height);
    for (std::size_t x = 0; x < columns; ++x)
        mix(alongY, &narrowed[4 * x], 4 * columns, out + 4 * x, 4 * columns);
    for (std::size_t i = 0; i < columns * static_cast<std::size_t>(height); ++i)
    {
        const float alpha = out[4 * i + 3];
        for (std::size_t channel = 0; channel < 3 && alpha > 0.0f; ++channel)
            out[4 * i + channel] /= alpha;
    }
    return result;
}

} // namespace

SurfaceData::SurfaceData(const SurfaceData& other, const osg::CopyOp& copy)
    : PropertyHolder(other, copy), _origin(other._origin), _lowX(other._lowX), _lowY(other._lowY),
      _highX(other._highX), _highY(other._highY), _layers(other._layers)
{
    for (Layer& layer : _layers)
        layer.image = copy(layer.image.get());
}

SurfaceData::~SurfaceData() = default;

bool SurfaceData::setRectangle(const osg::Vec2d& low, const osg::Vec2d& high)
{
    return assign({{"lowX", low.x()}, {"lowY", low.y()}, {"highX", high.x()}, {"highY", high.y()}});
}

std::string SurfaceData::inconsistency() const
{
    if (_lowX < _highX && _lowY < _highY) return {};
    return "the rectangle's low corner must be less than its high corner in x and in y.";
}

bool SurfaceData::addLayer(const std::string& name, Kind kind, osg::Image* image)
{
    const auto refuse = [&](const std::string& why)
    {
        OSG_WARN << "osgGeoFX: SurfaceData takes no layer \"" << name << "\": " << why << std::endl;
        return false;
    };
    if (name.empty()) return refuse("it needs a name.");
    if (findLayer(name) >= 0) return refuse("there is one of that name; remove it first.");
    if (kind < COLOR || kind > VALUE) return refuse("its kind is not known.");
    if (!isLayer(image))
        return refuse("its image must be GL_RGBA and GL_FLOAT, 1 to " + std::to_string(mostTexels) +
                      " texels wide and high, in close rows from below; SurfaceData::toLayer makes such.");
    if (!_layers.empty() && (image->s() != getWidth() || image->t() != getHeight()))
        return refuse("its image has " + std::to_string(image->s()) + " × " + std::to_string(image->t()) +
                      " texels, the first layer's " + std::to_string(getWidth()) + " × " +
                      std::to_string(getHeight()) + ".");
    _layers.push_back({name, kind, image});
    touch();
    return true;
}

bool SurfaceData::addDerived(const std::string& name, Kind kind, double radius)
{
    const auto heights =
        std::find_if(_layers.begin(), _layers.end(), [](const Layer& layer) { return layer.kind == HEIGHT; });
    if (heights == _layers.end())
    {
        OSG_WARN << "osgGeoFX: SurfaceData cannot derive the layer \"" << name
                 << "\": it has no layer of heights; add one first." << std::endl;
        return false;
    }
    const osg::ref_ptr<osg::Image> image = derive(kind, *heights->image, getSpacing(), radius);
    return image && addLayer(name, kind, image);
}

bool SurfaceData::removeLayer(const std::string& name)
{
    const int layer = findLayer(name);
    if (layer < 0) return false;
    _layers.erase(_layers.begin() + layer);
    touch();
    return true;
}

int SurfaceData::findLayer(const std::string& name) const
{
    const auto found =
        std::find_if(_layers.begin(), _layers.end(), [&](const Layer& layer) { return layer.name == name; });
    return found == _layers.end() ? -1 : static_cast<int>(found - _layers.begin());
}

osg::Vec2d SurfaceData::getSpacing() const
{
    if (_layers.empty()) return {};
    return {(_highX - _lowX) / getWidth(), (_highY - _lowY) / getHeight()};
}

osg::ref_ptr<osg::Image> SurfaceData::toLayer(const osg::Image& image, int width, int height)
{
    const auto* channels =
        std::find_if(std::begin(knownChannels), std::end(knownChannels),
                     [&](const Channels& each) { return each.format == image.getPixelFormat(); });
    const auto* type = std::find_if(std::begin(knownTypes), std::end(knownTypes),
                                    [&](const Type& each) { return each.type == image.getDataType(); });
    width = width == 0 ? image.s() : width;
    height = height == 0 ? image.t() : height;
    if (!image.data() || image.r() != 1 || channels == std::end(knownChannels) ||
        type == std::end(knownTypes) || width < 1 || height < 1 || width > mostTexels || height > mostTexels)
    {
        OSG_WARN << "osgGeoFX: SurfaceData makes no layer of " << image.s() << " × " << image.t() << " × "
                 << image.r() << " pixels of format " << image.getPixelFormat() << " and type "
                 << image.getDataType() << " in " << width << " × " << height
                 << " texels; give it plain RGB or RGBA." << std::endl;
        return nullptr;
    }
    osg::ref_ptr<osg::Image> result = SurfaceDerivation::emptyLayer(image.s(), image.t());
    const std::size_t pixelBytes = image.getPixelSizeInBits() / 8;
    auto* out = reinterpret_cast<float*>(result->data());
    for (int y = 0; y < image.t(); ++y)
    {
        const int row = image.getOrigin() == osg::Image::TOP_LEFT ? image.t() - 1 - y : y;
        const unsigned char* pixel = image.data(0, static_cast<unsigned int>(row));
        for (int x = 0; x < image.s(); ++x, pixel += pixelBytes)
            for (const int at : channels->at)
                *out++ = at >= 0 ? type->shareAt(pixel, at) : at == full ? 1.0f : 0.0f;
    }
    if (width == image.s() && height == image.t()) return result;
    return resampled(*result, width, height);
}

osg::ref_ptr<osg::Image> SurfaceData::derive(Kind kind, const osg::Image& heights, const osg::Vec2d& spacing,
                                             double radius)
{
    const bool positive = spacing.x() > 0.0 && spacing.y() > 0.0 && std::isfinite(spacing.length());
    if (isLayer(&heights) && positive && radius >= 0.0)
    {
        const SurfaceDerivation derivation(heights, spacing);
        if (kind == NORMAL) return derivation.normals();
        if (kind == SLOPE) return derivation.slopes();
        if (kind == ASPECT) return derivation.aspects();
        if (kind == OCCLUSION) return derivation.occlusion(radius);
    }
    OSG_WARN
        << "osgGeoFX: SurfaceData derives normals, slope, aspect and occlusion, from heights in GL_RGBA and "
           "GL_FLOAT, with texels some metres apart and a radius of 0 metres or more; not the kind "
        << kind << " with " << spacing.x() << ", " << spacing.y() << " and " << radius << "." << std::endl;
    return nullptr;
}

const Properties& SurfaceData::properties() const
{
    using Self = SurfaceData;
    constexpr double far = 5e7;
    static const Properties all = withDefaultsOf(
        new Self, {
                      LocalOrigin::originX().of<&Self::_origin, &LocalOrigin::x>(),
                      LocalOrigin::originY().of<&Self::_origin, &LocalOrigin::y>(),
                      LocalOrigin::originLongitude().of<&Self::_origin, &LocalOrigin::longitude>(),
                      LocalOrigin::originLatitude().of<&Self::_origin, &LocalOrigin::latitude>(),
                      Property::number("lowX", "the western edge", -far, far, "m").of<&Self::_lowX>(),
                      Property::number("lowY", "the southern edge", -far, far, "m").of<&Self::_lowY>(),
                      Property::number("highX", "the eastern edge", -far, far, "m").of<&Self::_highX>(),
                      Property::number("highY", "the northern edge", -far, far, "m").of<&Self::_highY>(),
                  });
    return all;
}

} // namespace osgGeoFX
