// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/RegionOfInterest.h>

#include <osgGeoFX/closeup/detail/RegionMask.h>
#include <osgGeoFX/effect/GlslFunctions.h>

#include <osg/Math>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

namespace osgGeoFX
{

using region::Line;
using region::Picture;

struct RegionOfInterest::Cache
{
    /// All that the mask follows from.
    struct Key
    {
        osg::Vec2d half;
        int shape, points, side;
        double rounding, innerRadius, softness;
        std::vector<osg::Vec2d> outline;
        osg::ref_ptr<const osg::Image> image; ///< held, lest a new one takes its address
        unsigned int imageCount;

        bool operator==(const Key& other) const
        {
            return half == other.half && shape == other.shape && points == other.points &&
                   side == other.side && rounding == other.rounding && innerRadius == other.innerRadius &&
                   softness == other.softness && outline == other.outline && image == other.image &&
                   imageCount == other.imageCount;
        }
    };

    std::mutex mutex;
    unsigned int revision = 0, imageCount = 0; ///< with which the key was compared last
    std::optional<Key> key;
    osg::ref_ptr<const osg::Image> mask;
    bool empty = true;
    std::string complaint; ///< about the image, so that it comes once

    static Key keyOf(const RegionOfInterest& region);
    /// The mask as it is now; under the mutex.
    void refresh(const RegionOfInterest& region);
    /// Mask and distances.
    std::pair<Picture, Picture> draw(const RegionOfInterest& region);
    std::optional<Picture> greys(const RegionOfInterest& region);
};

RegionOfInterest::Cache::Key RegionOfInterest::Cache::keyOf(const RegionOfInterest& region)
{
    const double smaller = std::min(region._width, region._depth);
    return {{region._width / smaller, region._depth / smaller},
            region._shape,
            region._points,
            region._maskSide,
            region._rounding,
            region._innerRadius,
            region._softness,
            region._outline,
            region._image.get(),
            region._image ? region._image->getModifiedCount() : 0};
}

void RegionOfInterest::Cache::refresh(const RegionOfInterest& region)
{
    const unsigned int count = region._image ? region._image->getModifiedCount() : 0;
    if (key && revision == region.revision() && imageCount == count) return;
    revision = region.revision();
    imageCount = count;
    Key now = keyOf(region);
    if (key && *key == now) return;
    key = std::move(now);
    const auto [shares, distances] = draw(region);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(key->side, key->side, 1, GL_RG, GL_FLOAT);
    image->setInternalTextureFormat(GL_RG32F);
    auto* texel = reinterpret_cast<float*>(image->data());
    empty = true;
    for (std::size_t i = 0; i < shares.values.size(); ++i)
    {
        empty = empty && shares.values[i] < 0.5f;
        *texel++ = shares.values[i];
        *texel++ = std::max(distances.values[i], -2.0f);
    }
    mask = image;
}

std::optional<Picture> RegionOfInterest::Cache::greys(const RegionOfInterest& region)
{
    std::string error = "it has no image.";
    std::optional<Picture> found;
    if (region._image) found = region::greys(*region._image, key->side, key->half, error);
    if (found) error.clear();
    if (!error.empty() && error != complaint)
        OSG_WARN << "osgGeoFX: RegionOfInterest cannot show its image: " << error << " It is empty."
                 << std::endl;
    complaint = error;
    return found;
}

std::pair<Picture, Picture> RegionOfInterest::Cache::draw(const RegionOfInterest& region)
{
    const int side = key->side;
    const osg::Vec2d& half = key->half;
    Picture distances(side, half);
    switch (key->shape)
    {
    case RECTANGLE:
        distances = region::rectangleDistances(side, half, 0.0);
        break;
    case ROUNDED:
        distances = region::rectangleDistances(side, half, key->rounding);
        break;
    case POLYGON:
        distances = region::outlineDistances(side, half, key->outline);
        break;
    case STAR:
        distances = region::outlineDistances(side, half, region::starCorners(key->points, key->innerRadius));
        break;
    case IMAGE:
    {
        const Picture grey = greys(region).value_or(Picture(side, half));
        return {key->softness > 0.0 ? region::blurred(grey, key->softness) : grey,
                region::greyDistances(grey)};
    }
    default:
        distances = region::ellipseDistances(side, half);
        break;
    }
    if (key->softness > 0.0) return {region::softMask(distances, key->softness), distances};
    if (key->shape != RECTANGLE) return {region::sharpMask(distances), distances};
    Picture full(side, half);
    std::fill(full.values.begin(), full.values.end(), 1.0f);
    return {full, distances};
}

RegionOfInterest::RegionOfInterest() : _cache(new Cache) {}

RegionOfInterest::RegionOfInterest(const RegionOfInterest& other, const osg::CopyOp& copy)
    : PropertyHolder(other, copy), _outline(other._outline), _image(copy(other._image.get())),
      _cache(new Cache)
{
    for (const Property& property : RegionOfInterest::properties())
        property.put(*this, property.get(other));
}

RegionOfInterest::~RegionOfInterest() = default;

const Properties& RegionOfInterest::properties() const
{
    using Self = RegionOfInterest;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            Property::number("centerX", "the center on a projected terrain, to the east", -5e7, 5e7, "m")
                .of<&Self::_center, &LocalOrigin::x>(),
            Property::number("centerY", "the center on a projected terrain, to the north", -5e7, 5e7, "m")
                .of<&Self::_center, &LocalOrigin::y>(),
            Property::angle("longitude", "the longitude of the center on a globe, to the east", -osg::PI,
                            osg::PI)
                .of<&Self::_center, &LocalOrigin::longitude>(),
            Property::angle("latitude", "the latitude of the center on a globe, to the north", -osg::PI_2,
                            osg::PI_2)
                .of<&Self::_center, &LocalOrigin::latitude>(),
            Property::number("baseHeight", "the height that heights are scaled about", -12000.0, 1e7, "m")
                .of<&Self::_baseHeight>(),
            Property::number("width", "the whole width of the region", 1.0, 2e6, "m").of<&Self::_width>(),
            Property::number("depth", "the whole depth of the region", 1.0, 2e6, "m").of<&Self::_depth>(),
            Property::angle("heading", "the turn of the region's y axis, clockwise from north",
                            -2.0 * osg::PI, 2.0 * osg::PI)
                .of<&Self::_heading>(),
            Property::choice("shape",
                             "the shape of the region; in a scene file, polygon where there are corners and "
                             "image where there is one",
                             {{"ellipse", ""},
                              {"rectangle", ""},
                              {"rounded", "a rectangle with round corners"},
                              {"polygon", "its corners"},
                              {"star", ""},
                              {"image", "the grey values of an image"}})
                .of<&Self::_shape>(),
            Property::number("rounding", "the radius of round corners, as a share of the smaller half side",
                             0.0, 1.0)
                .of<&Self::_rounding>(),
            Property::integer("points", "the number of points of a star", 3, 64).of<&Self::_points>(),
            Property::number("innerRadius", "a star's inner radius, as a share of the outer one", 0.05, 1.0)
                .of<&Self::_innerRadius>(),
            Property::number("softness",
                             "how far inside of the border it fades, as a share of the smaller half side",
                             0.0, 1.0)
                .of<&Self::_softness>(),
            Property::integer("maskSide", "the side of the region's mask", 16, 1024, "texel")
                .of<&Self::_maskSide>(),
        });
    return all;
}

bool RegionOfInterest::setOutline(const std::vector<osg::Vec2d>& corners)
{
    // This way round NaN is outside.
    const bool within = std::all_of(corners.begin(), corners.end(),
                                    [](const osg::Vec2d& corner)
                                    { return std::abs(corner.x()) <= 1.0 && std::abs(corner.y()) <= 1.0; });
    const char* fault = corners.size() < 3          ? "an outline needs at least three corners."
                        : !within                   ? "an outline's corners must lie within -1 to 1."
                        : !region::hasArea(corners) ? "an outline needs an area."
                                                    : nullptr;
    if (fault)
    {
        OSG_WARN << "osgGeoFX: RegionOfInterest: " << fault << " The former one stays." << std::endl;
        return false;
    }
    if (corners == _outline) return true;
    _outline = corners;
    touch();
    return true;
}

bool RegionOfInterest::setImage(osg::Image* image)
{
    if (image == _image) return true;
    const std::string fault = image ? region::refusal(*image) : std::string();
    if (!fault.empty())
    {
        OSG_WARN << "osgGeoFX: RegionOfInterest: " << fault << " The former image stays." << std::endl;
        return false;
    }
    _image = image;
    touch();
    return true;
}

osg::ref_ptr<const osg::Image> RegionOfInterest::mask() const
{
    const std::lock_guard<std::mutex> lock(_cache->mutex);
    _cache->refresh(*this);
    return _cache->mask;
}

bool RegionOfInterest::isEmpty() const
{
    const std::lock_guard<std::mutex> lock(_cache->mutex);
    _cache->refresh(*this);
    return _cache->empty;
}

osg::Vec2d RegionOfInterest::maskAt(const osg::Vec2d& place) const
{
    // This way round NaN is outside.
    if (!(std::abs(place.x()) <= 1.0) || !(std::abs(place.y()) <= 1.0)) return {0.0, -2.0};
    const osg::ref_ptr<const osg::Image> picture = mask();
    const int last = picture->s() - 1;
    const auto texel = [&](int column, int row)
    {
        const auto* values = reinterpret_cast<const float*>(
            picture->data(std::clamp(column, 0, last), std::clamp(row, 0, last)));
        return osg::Vec2d(static_cast<double>(values[0]), static_cast<double>(values[1]));
    };
    const double s = (place.x() + 1.0) / 2.0 * picture->s() - 0.5;
    const double t = (place.y() + 1.0) / 2.0 * picture->t() - 0.5;
    const int column = static_cast<int>(std::floor(s));
    const int row = static_cast<int>(std::floor(t));
    const double right = s - column;
    const double up = t - row;
    const osg::Vec2d value =
        (texel(column, row) * (1.0 - right) + texel(column + 1, row) * right) * (1.0 - up) +
        (texel(column, row + 1) * (1.0 - right) + texel(column + 1, row + 1) * right) * up;
    const double smaller = std::min(_width, _depth);
    return {value.x(), glsl::geofx_border(value.y(), {place.x(), place.y()}, picture->s(),
                                          {_width / smaller, _depth / smaller})};
}

std::vector<std::vector<osg::Vec2d>> RegionOfInterest::contours(double step) const
{
    const double smaller = std::min(_width, _depth);
    Picture distances(_maskSide, {_width / smaller, _depth / smaller});
    const osg::ref_ptr<const osg::Image> picture = mask();
    const auto* texel = reinterpret_cast<const float*>(picture->data());
    for (float& distance : distances.values)
    {
        distance = texel[1];
        texel += 2;
    }
    std::vector<Line> lines = region::borders(distances);
    const double longest = step > 0.001 ? std::min(step, 1.0) : 0.001;
    for (Line& line : lines)
    {
        Line parted;
        for (std::size_t i = 0; i < line.size(); ++i)
        {
            const osg::Vec2d from = line[i];
            const osg::Vec2d way = line[(i + 1) % line.size()] - from;
            const double length = osg::componentMultiply(way, distances.half).length();
            const int parts = std::max(1, static_cast<int>(std::ceil(length / longest)));
            for (int k = 0; k < parts; ++k)
                parted.push_back(from + way * (static_cast<double>(k) / parts));
        }
        line = std::move(parted);
    }
    return lines;
}

osg::Matrixd RegionOfInterest::frameToWorld(const osg::EllipsoidModel* ellipsoid) const
{
    // A heading is clockwise.
    return osg::Matrixd::rotate(-_heading, osg::Vec3d(0.0, 0.0, 1.0)) *
           _center.toWorld(ellipsoid, _baseHeight);
}

osg::Matrixd RegionOfInterest::worldToRegion(const osg::EllipsoidModel* ellipsoid) const
{
    return osg::Matrixd::inverse(frameToWorld(ellipsoid)) *
           osg::Matrixd::scale(2.0 / _width, 2.0 / _depth, 1.0);
}

} // namespace osgGeoFX
