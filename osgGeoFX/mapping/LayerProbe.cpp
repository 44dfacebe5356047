// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/LayerProbe.h>

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/LayerWords.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/detail/LayerSample.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace osgGeoFX
{

namespace
{

double grey(const osg::Vec4d& color)
{
    return color.x() * 0.2126 + color.y() * 0.7152 + color.z() * 0.0722;
}

std::string nameOf(const ProjectiveMapping& mapping)
{
    if (!mapping.getName().empty()) return mapping.getName();
    const DataLayer* const layer = mapping.getLayer();
    if (layer && !layer->getName().empty()) return layer->getName();
    if (layer && layer->getImage() && !layer->getImage()->getFileName().empty())
        return osgDB::getSimpleFileName(layer->getImage()->getFileName());
    return "mapping";
}

/// What the mask's share is, before the ramp.
std::optional<double> shareOf(const DataLayer* mask, const osg::Vec2d& raster, double& cover)
{
    if (!mask || !mask->getImage()) return std::nullopt;
    const auto found = LayerSample::read(*mask->getImage(), LayerSample::How::of(*mask), raster);
    if (!found) return std::nullopt;
    cover = found->cover;
    return mask->getKind() == DataLayer::COLOR ? grey(found->color) * found->color.w() : found->value;
}

/// The color that a mapping brings, as SLOT_apply of shaders/stages/mappings.frag.glsl has it.
std::optional<osg::Vec4d> colorOf(const ProjectiveMapping& mapping, const LayerSample& found, bool colors,
                                  bool hasLayer, const osg::Vec2d& raster)
{
    const ColorTransfer& transfer = *mapping.getTransfer();
    const double low = transfer.getLowValue(), high = transfer.getHighValue();
    const double number = colors ? grey(found.color) : found.value;
    osg::Vec4d source = colors ? found.color : osg::Vec4d(1.0, 1.0, 1.0, 1.0);
    switch (transfer.getSource())
    {
    case ColorTransfer::LAYER:
        if (hasLayer && !colors)
        {
            const double share = std::clamp((number - low) / (high - low), 0.0, 1.0);
            source.set(share, share, share, 1.0);
        }
        break;
    case ColorTransfer::TABLE:
    {
        const ColorTable* const table = mapping.getTable();
        if (!table) break;
        const bool exact = table->getMode() == ColorTable::EXACT;
        if (exact && (number < low || number > high)) return std::nullopt;
        const osg::Vec4d entry(table->at(std::clamp(number, low, high)));
        source.set(entry.x(), entry.y(), entry.z(), entry.w() * (colors ? source.w() : 1.0));
        break;
    }
    case ColorTransfer::SCENE:
        return std::nullopt;
    case ColorTransfer::CONSTANT:
    {
        const osg::Vec4d constant = transfer.getConstant();
        source.set(constant.x(), constant.y(), constant.z(), source.w());
        break;
    }
    }
    const ColorTransfer::Matrix matrix = transfer.effectiveMatrix();
    const osg::Vec4d rgb(source.x(), source.y(), source.z(), 1.0);
    for (std::size_t i = 0; i < matrix.size(); ++i)
        source[static_cast<unsigned int>(i)] = std::clamp(matrix[i] * rgb, 0.0, 1.0);
    const auto ramp = [&](double value)
    {
        return glsl::geofx_ramp(value, transfer.getRampLow(), transfer.getRampHigh());
    };
    double cover = 1.0;
    if (transfer.getAlpha() == ColorTransfer::OPAQUE) source.w() = 1.0;
    if (transfer.getAlpha() == ColorTransfer::FROM_RAMP) source.w() = ramp(number);
    if (transfer.getAlpha() == ColorTransfer::FROM_MASK)
    {
        const std::optional<double> share = shareOf(mapping.getMask(), raster, cover);
        source.w() = share ? cover * ramp(*share) : 0.0;
    }
    return source;
}

/// Where a mapping's pixels at a place are.
struct Picture
{
    const osg::Image* image = nullptr;
    LayerSample::How how;
    osg::Vec2d raster; ///< in the image
    osg::Vec2d size;   ///< of the image on the ground, metres
    osg::ref_ptr<DataLayer> held;
};

Picture pictureOf(ProjectiveMapping& mapping, PagedRaster* raster, const osg::Vec2d& place,
                  const osg::Vec2d& at)
{
    Picture picture;
    const DataLayer* const layer = mapping.getLayer();
    if (!layer) return picture;
    picture.how = LayerSample::How::of(*layer);
    picture.image = layer->getImage();
    picture.raster = at;
    picture.size.set(2.0 * mapping.getU().length(), 2.0 * mapping.getV().length());
    if (!raster) return picture;
    const PagedRaster::Tile tile = raster->tileAt(place);
    if (!tile.layer) return picture;
    picture.held = tile.layer;
    picture.image = tile.layer->getImage();
    picture.size = tile.high - tile.low;
    picture.raster.set((place.x() - tile.low.x()) / picture.size.x(),
                       (place.y() - tile.low.y()) / picture.size.y());
    return picture;
}

PagedRaster* rasterOf(const ProjectiveMappings& mappings, const ProjectiveMapping* mapping)
{
    for (unsigned int i = 0; i < mappings.getNumRasters(); ++i)
    {
        auto* const raster = const_cast<PagedRaster*>(mappings.getRaster(i));
        if (raster->getMapping() == mapping) return raster;
    }
    return nullptr;
}

bool saysNothing(const LayerReading& reading)
{
    return reading.kind == DataLayer::COLOR ? !reading.color : !reading.value;
}

/// Whether two frames are those of two of the six parts that a raster of the world is cut into.
bool arePartsOfTheWorld(const LocalOrigin& a, const LocalOrigin& b)
{
    const auto isPart = [](const LocalOrigin& origin)
    {
        return std::remainder(origin.longitude, osg::PI_2) == 0.0 &&
               std::remainder(origin.latitude, osg::PI_2) == 0.0;
    };
    return isPart(a) && isPart(b) && (a.longitude != b.longitude || a.latitude != b.latitude);
}

/// Of a raster in several frames, as one of the world, the part that has the place counts; where two have it, the one on top. Two rasters of
/// one frame may have the same name. `frames`: the effect that has each reading.
void dropOtherParts(std::vector<LayerReading>& readings, const std::vector<const ProjectiveMappings*>& frames)
{
    std::vector<LayerReading> kept;
    for (std::size_t i = 0; i < readings.size(); ++i)
    {
        bool isOtherPart = false;
        for (std::size_t k = 0; k < readings.size(); ++k)
        {
            if (frames[k] == frames[i] || readings[k].name != readings[i].name) continue;
            if (saysNothing(readings[i]))
                isOtherPart = isOtherPart || k < i || !saysNothing(readings[k]);
            else
                isOtherPart = isOtherPart ||
                              (k < i && !saysNothing(readings[k]) &&
                               arePartsOfTheWorld(frames[k]->getLocalOrigin(), frames[i]->getLocalOrigin()));
        }
        if (!isOtherPart) kept.push_back(readings[i]);
    }
    readings = std::move(kept);
}

/// The other side of the globe has the same places once more.
bool isBehind(const ProjectiveMappings& mappings, const osg::Vec3d& world,
              const osg::EllipsoidModel* ellipsoid)
{
    if (!ellipsoid) return false;
    const osg::Vec3d position = world * osg::Matrixd::inverse(mappings.frameToWorld(ellipsoid));
    return position.z() < -ellipsoid->getRadiusPolar();
}

} // namespace

std::vector<LayerReading> LayerProbe::read(const ProjectiveMappings& mappings, const osg::Vec3d& place)
{
    std::vector<LayerReading> readings;
    const osg::Vec2d plane(place.x(), place.y());
    for (ProjectiveMapping* const mapping : mappings.mappingsAt(plane))
    {
        if (place.z() < mapping->getLowest() || place.z() > mapping->getHighest()) continue;
        if (mapping->getSizeInPixels() > 0.0 || mapping->getTurned()) continue;
        const DataLayer* const layer = mapping->getLayer();
        if (layer && layer->getTexture()) continue;
        LayerReading reading;
        reading.mapping = mapping;
        reading.name = nameOf(*mapping);
        const glm::dvec3 raster = mapping->placeToRaster() * glm::dvec3(place.x(), place.y(), 1.0);
        reading.raster.set(raster.x / raster.z, raster.y / raster.z);
        const Picture picture = pictureOf(*mapping, rasterOf(mappings, mapping), plane, reading.raster);
        LayerSample found;
        found.color.set(1.0, 1.0, 1.0, 1.0);
        found.cover = 1.0;
        if (layer)
        {
            reading.kind = layer->getKind();
            reading.unit = LayerWords::unitOf(*layer);
            const auto sample =
                picture.image ? LayerSample::read(*picture.image, picture.how, picture.raster) : std::nullopt;
            // A layer without a picture shows nothing.
            if (!sample) continue;
            found = *sample;
            reading.texel =
                std::max(picture.size.x() / picture.image->s(), picture.size.y() / picture.image->t());
        }
        const bool colors = !layer || reading.kind == DataLayer::COLOR;
        if (found.cover > 0.0)
        {
            if (!colors) reading.value = found.value;
            if (reading.kind == DataLayer::CLASS) reading.className = LayerWords::nameOf(*layer, found.value);
            reading.color = colorOf(*mapping, found, colors, layer != nullptr, reading.raster);
        }
        readings.push_back(std::move(reading));
    }
    return readings;
}

LayerProbe LayerProbe::at(EffectScene& scene, const osg::Vec3d& world)
{
    LayerProbe probe;
    probe.world = world;
    const osg::ref_ptr<const osg::EllipsoidModel> ellipsoid = scene.ground().ellipsoid;
    LayerPlayer* const player = LayerPlayer::of(scene);
    std::vector<const ProjectiveMappings*> frames;
    // What is drawn last lies on top.
    for (unsigned int i = scene.getNumEffects(); i-- > 0;)
    {
        const auto* const mappings = dynamic_cast<const ProjectiveMappings*>(scene.getEffect(i));
        if (!mappings || !mappings->getEnabled() || isBehind(*mappings, world, ellipsoid)) continue;
        for (LayerReading& reading : read(*mappings, mappings->placeOf(world, ellipsoid)))
        {
            for (unsigned int k = 0; player && k < player->getNumSequences(); ++k)
            {
                LayerSequence* const sequence = player->getSequence(k);
                if (sequence->getLayer() == reading.mapping->getLayer()) reading.sequence = sequence;
            }
            probe.readings.push_back(std::move(reading));
            frames.push_back(mappings);
        }
    }
    dropOtherParts(probe.readings, frames);
    return probe;
}

std::optional<LayerProbe> LayerProbe::under(EffectScene& scene, const osg::Camera& camera, double x, double y)
{
    const auto hit = DeformedView(scene, camera).pick(x, y);
    if (!hit) return std::nullopt;
    return at(scene, hit->world);
}

std::string LayerReading::text() const
{
    char words[64];
    if (kind == DataLayer::COLOR)
    {
        if (!color) return name;
        const auto byte = [](double share)
        {
            return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * 255.0));
        };
        std::snprintf(words, sizeof words, "#%02x%02x%02x", byte(color->x()), byte(color->y()),
                      byte(color->z()));
        std::string result = name + ": " + words;
        if (color->w() < 1.0) result += ", " + std::to_string(std::lround(100.0 * color->w())) + " %";
        return result;
    }
    if (!value) return name + ": no data";
    std::snprintf(words, sizeof words, "%.6g", *value);
    if (!className.empty()) return name + ": " + className + " (" + words + ")";
    return name + ": " + words + (unit.empty() ? "" : " " + unit);
}

} // namespace osgGeoFX
